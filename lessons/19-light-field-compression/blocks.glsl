// Where a texel (u, v, s, t) is in what a codec has made of it. Blocks lie in a picture: those of one u and v side by
// side along s, and above one another along t; `across` is their number along s and t.

ivec2 block_at(ivec2 uv, ivec2 st, ivec2 across) { return uv * across + st; }

// Number i of rows of 2^bits texels, one row going on in the next.
ivec2 in_rows(int i, int bits) { return ivec2(i & ((1 << bits) - 1), i >> bits); }
