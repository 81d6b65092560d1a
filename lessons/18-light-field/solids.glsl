// Solids met by a ray in GLSL: what a light field is made of, drawn without one. A row of the texture is a solid: half
// its size, its centre, its three own axes in the world, its colour.

struct Struck {
    float depth; // along the ray; negative: nothing is met
    vec3 normal, colour;
};

vec3 solid_number(sampler2D solids, int x, int row) { return texelFetch(solids, ivec2(x, row), 0).rgb; }

// The nearer of two. Only what lies ahead of the ray's origin counts.
Struck nearer(Struck a, float depth, vec3 normal, vec3 colour) {
    bool takes = depth >= 0.0 && (a.depth < 0.0 || depth < a.depth);
    if (takes) return Struck(depth, normal, colour);
    return a;
}

Struck strike_sphere(Struck so_far, sampler2D solids, int row, vec3 origin, vec3 way) {
    float radius = solid_number(solids, 0, row).x;
    vec3 from = origin - solid_number(solids, 1, row);
    float passing = -dot(from, way);
    vec3 off = from + passing * way;
    float inside = radius * radius - dot(off, off);
    if (inside < 0.0) return so_far;
    float depth = passing - sqrt(inside);
    return nearer(so_far, depth, (from + depth * way) / radius, solid_number(solids, 5, row));
}

// Where a line enters the layer between two planes across an axis, and where it leaves. Along the planes way is 0 or
// -0, and within the layer these are -infinity and infinity, in this order only if they are sorted.
vec2 layer(float at, float way, float half_size) {
    vec2 planes = vec2(-half_size - at, half_size - at) / way;
    return vec2(min(planes.x, planes.y), max(planes.x, planes.y));
}

Struck strike_cylinder(Struck so_far, sampler2D solids, int row, vec3 origin, vec3 way) {
    vec3 half_size = solid_number(solids, 0, row), axis = solid_number(solids, 3, row);
    vec3 from = origin - solid_number(solids, 1, row);
    float at = dot(from, axis), along = dot(way, axis);
    vec3 level = from - at * axis, across = way - along * axis;
    float a = dot(across, across), b = dot(level, across), c = dot(axis, cross(level, across));
    float inside = a * half_size.x * half_size.x - c * c;
    bool parallel = a < 1e-12; // to the axis: then only the ends count, if the ray is between the sides at all
    if (parallel) inside = half_size.x * half_size.x - dot(level, level);
    if (inside < 0.0) return so_far;
    vec2 sides = parallel ? vec2(-1e30, 1e30) : vec2(-b - sqrt(inside), -b + sqrt(inside)) / a;
    vec2 ends = layer(at, along, half_size.y);
    float enter = max(sides.x, ends.x), leave = min(sides.y, ends.y);
    if (!(enter <= leave)) return so_far;
    vec3 normal = ends.x > sides.x ? -sign(along) * axis : (level + enter * across) / half_size.x;
    return nearer(so_far, enter, normal, solid_number(solids, 5, row));
}

Struck strike_box(Struck so_far, sampler2D solids, int row, vec3 origin, vec3 way) {
    vec3 half_size = solid_number(solids, 0, row), from = origin - solid_number(solids, 1, row);
    vec3 x = solid_number(solids, 2, row), y = solid_number(solids, 3, row), z = solid_number(solids, 4, row);
    vec3 along = vec3(dot(way, x), dot(way, y), dot(way, z));
    vec2 width = layer(dot(from, x), along.x, half_size.x), height = layer(dot(from, y), along.y, half_size.y);
    vec2 depth = layer(dot(from, z), along.z, half_size.z);
    float enter = max(max(width.x, height.x), depth.x), leave = min(min(width.y, height.y), depth.y);
    if (!(enter <= leave)) return so_far;
    vec3 normal = -sign(along.z) * z;
    if (enter == width.x) normal = -sign(along.x) * x;
    else if (enter == height.x) normal = -sign(along.y) * y;
    return nearer(so_far, enter, normal, solid_number(solids, 5, row));
}

// The first solid on a ray; kinds: where the rows of spheres, of cylinders and of boxes end.
Struck strike(sampler2D solids, ivec3 kinds, vec3 origin, vec3 way) {
    Struck first = Struck(-1.0, vec3(0.0), vec3(0.0));
    for (int i = 0; i < kinds.x; i++) first = strike_sphere(first, solids, i, origin, way);
    for (int i = kinds.x; i < kinds.y; i++) first = strike_cylinder(first, solids, i, origin, way);
    for (int i = kinds.y; i < kinds.z; i++) first = strike_box(first, solids, i, origin, way);
    return first;
}

// Ambient 0.15, diffuse 0.55, specular 0.3 with exponent 32 (Phong 1975): common/light_scene.h.
vec3 phong(vec3 albedo, vec3 normal, vec3 light, vec3 way) {
    float facing = dot(normal, light);
    if (facing <= 0.0) return 0.15 * albedo;
    float shine = max(-dot(2.0 * facing * normal - light, way), 0.0);
    return albedo * (0.15 + 0.55 * facing) + 0.3 * pow(shine, 32.0);
}
