/* From a polygon to edges, from edges to spans, from spans to pixels. */
#include "raster.h"

#include "span.h"

/* ---- Which pixels: integers ---- */

enum { ONE_PIXEL = 1 << SUBPIXEL_BITS, HALF_PIXEL = ONE_PIXEL / 2 };

/* A vertex on the screen, in 1/256 pixel from the picture's lower left corner. Clipping keeps these below
 * 2^29, so the products of two differences, below, fit into 64 bits. */
typedef struct {
    int64_t x, y;
} SnappedVertex;

static double screen_x(const Raster *raster, const ClipVertex *v) {
    return (v->x / v->w + 1) * 0.5 * raster->width;
}
static double screen_y(const Raster *raster, const ClipVertex *v) {
    return (v->y / v->w + 1) * 0.5 * raster->height;
}

static int64_t snap(double pixels, int dropped_bits) {
    double grid = ldexp(1, SUBPIXEL_BITS - dropped_bits); /* steps a pixel */
    return (int64_t)floor(pixels * grid + 0.5) * (1 << dropped_bits);
}

static SnappedVertex vertex_snap(const Raster *raster, const ClipVertex *v) {
    return (SnappedVertex){snap(screen_x(raster, v), raster->dropped_bits),
                           snap(screen_y(raster, v), raster->dropped_bits)};
}

/* Whether an edge crosses the line through the pixel centres of a row. An end exactly on the line counts as
 * above it: so a row that only touches a polygon's top belongs to it, and one that touches its bottom not. */
static bool edge_crosses(SnappedVertex a, SnappedVertex b, int64_t centre) {
    return (a.y < centre) != (b.y < centre);
}

/* The first pixel whose centre is on the edge or right of it, exactly: with x where the edge crosses the
 * line, ceil((x - HALF_PIXEL) / ONE_PIXEL). It does not depend on the direction of the edge. */
static int64_t edge_pixel(SnappedVertex a, SnappedVertex b, int64_t centre) {
    SnappedVertex low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
    int64_t dx = high.x - low.x, dy = high.y - low.y;
    int64_t numerator = (low.x - HALF_PIXEL) * dy + (centre - low.y) * dx, denominator = dy * ONE_PIXEL;
    return numerator / denominator + (numerator % denominator > 0); /* the ceiling: C rounds toward 0 */
}

/* Where a row enters and leaves the polygon, from left to right: pixels crossings[0] .. crossings[1] - 1 are
 * inside, and so on. Two crossings, but for the dents that snapping can make in a polygon of four corners or
 * more. Returns how many. */
static int row_crossings(const SnappedVertex *corner, int corners, int row, int width, int *crossings) {
    int64_t centre = (int64_t)row * ONE_PIXEL + HALF_PIXEL;
    int count = 0;
    for (int i = 0; i < corners; i++) {
        SnappedVertex a = corner[i], b = corner[(i + 1) % corners];
        if (!edge_crosses(a, b, centre)) continue;
        int64_t x = edge_pixel(a, b, centre);
        int pixel = x < 0 ? 0 : x > width ? width : (int)x;
        int place = count++;
        for (; place > 0 && crossings[place - 1] > pixel; place--) crossings[place] = crossings[place - 1];
        crossings[place] = pixel;
    }
    return count;
}

/* The first row whose centre is above y, kept within 0..height. */
static int row_above(int64_t y, int height) {
    int64_t row = (y + HALF_PIXEL) >> SUBPIXEL_BITS;
    return row < 0 ? 0 : row > height ? height : (int)row;
}

/* ---- What they show: planes ---- */

/* A plane over the picture: its value at (x, y) is the dot product of slope and (x, y, 1). */
typedef struct {
    Vec3 slope;
    double low, high; /* as in Ramp */
} Plane;

/* The polygon as it appears on the screen: the planes of 1/w and, with perspective, s/w and so on; else s. */
typedef struct {
    Plane one_over_w, values[VALUES];
} Surface;

static bool with_perspective(const Raster *raster) { return raster->filling >= FILL_SPANS; }

static int value_count(const Raster *raster) { return raster->filling == FILL_COLOUR ? VALUES : VALUE_T + 1; }

/* A vertex in homogeneous pixel coordinates: divided by the last they are the place on the screen. */
static Vec3 homogeneous(const Raster *raster, const ClipVertex *v) {
    return v3((v->x + v->w) * 0.5 * raster->width, (v->y + v->w) * 0.5 * raster->height, v->w);
}

static double determinant(Vec3 a, Vec3 b, Vec3 c) { return vec3_dot(a, vec3_cross(b, c)); }

/* Olano and Greer 1997: what is linear over the triangle, with the values a0, a1, a2 at its vertices, is a =
 * A.x x' + A.y y' + A.z w in its homogeneous pixel coordinates (x', y', w), for three such equations at the
 * vertices determine A. Divided by w it says a/w = A.x x + A.y y + A.z: A is the plane of a/w. It is a0
 * basis[0] + a1 basis[1] + a2 basis[2], without a division by w: the vertices may be behind the eye.
 * False if the triangle is seen as a line or a point. */
static bool plane_basis(const Vec3 p[3], Vec3 basis[3]) {
    double d = determinant(p[0], p[1], p[2]);
    if (!(fabs(d) > 1e-15 * vec3_length(p[0]) * vec3_length(p[1]) * vec3_length(p[2]))) return false;
    for (int i = 0; i < 3; i++) basis[i] = vec3_scale(vec3_cross(p[(i + 1) % 3], p[(i + 2) % 3]), 1 / d);
    return true;
}

static Vec3 plane_through(const Vec3 basis[3], double a0, double a1, double a2) {
    return vec3_add(vec3_add(vec3_scale(basis[0], a0), vec3_scale(basis[1], a1)), vec3_scale(basis[2], a2));
}

/* Of the triangles that fan out from a polygon's first corner, the one whose plane is best determined: with a
 * corner on the straight line between its neighbours, as at a mended T-joint, one of them is no triangle. */
static int best_triangle(const Raster *raster, const ClipVertex *polygon, int corners) {
    Vec3 p0 = homogeneous(raster, &polygon[0]);
    double most = -1;
    int best = 1;
    for (int i = 1; i + 1 < corners; i++) {
        Vec3 p1 = homogeneous(raster, &polygon[i]), p2 = homogeneous(raster, &polygon[i + 1]);
        double d = fabs(determinant(p0, p1, p2));
        if (d > most) most = d, best = i;
    }
    return best;
}

static double most_distant(const ClipVertex *corner, int corners) {
    double w = 0;
    for (int i = 0; i < corners; i++) w = fmax(w, corner[i].w);
    return w;
}

static double vertex_value(const ClipVertex *v, int value) {
    return (double[VALUES]){v->s, v->t, v->r, v->g, v->b}[value];
}

/* The range of a value over a polygon, as far beyond itself on either side as it is wide. */
static void value_range(const ClipVertex *corner, int corners, int value, double *low, double *high) {
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < corners; i++) {
        least = fmin(least, vertex_value(&corner[i], value));
        most = fmax(most, vertex_value(&corner[i], value));
    }
    *low = least - (most - least);
    *high = most + (most - least);
}

/* The planes of a polygon, from its corners before clipping; clipped is what is left of it. */
static Surface surface_create(const Raster *raster, const ClipVertex *polygon, int corners,
                              const ClipVertex *clipped, int clipped_corners) {
    int best = best_triangle(raster, polygon, corners);
    const ClipVertex *v[3] = {&polygon[0], &polygon[best], &polygon[best + 1]};
    Vec3 p[3], basis[3];
    for (int i = 0; i < 3; i++) p[i] = homogeneous(raster, v[i]);
    if (!plane_basis(p, basis)) /* level planes, through the mean of what is left of it */
        for (int i = 0; i < 3; i++) {
            v[i] = &clipped[i];
            basis[i] = v3(0, 0, 1 / (3 * v[i]->w));
        }
    Surface surface = {0};
    surface.one_over_w.slope = plane_through(basis, 1, 1, 1);
    surface.one_over_w.low = 0.5 / most_distant(clipped, clipped_corners);
    surface.one_over_w.high = INFINITY;
    for (int i = 0; i < value_count(raster); i++) {
        Plane *plane = &surface.values[i];
        double a[3];
        /* Without perspective a itself is linear on the screen, and so is a w over w. */
        for (int j = 0; j < 3; j++) a[j] = vertex_value(v[j], i) * (with_perspective(raster) ? 1 : v[j]->w);
        plane->slope = plane_through(basis, a[0], a[1], a[2]);
        value_range(clipped, clipped_corners, i, &plane->low, &plane->high);
    }
    return surface;
}

/* ---- Spans ---- */

/* x, y: the centre of the span's far pixel; next: 1 or -1, the way on from there. */
static Ramp plane_ramp(const Plane *plane, double x, double y, int next) {
    return (Ramp){vec3_dot(plane->slope, v3(x, y, 1)), plane->slope.x * next, plane->low, plane->high};
}

static Span span_create(const Surface *surface, int row, int begin, int end) {
    bool from_right = surface->one_over_w.slope.x < 0;
    double x = from_right ? end - 0.5 : begin + 0.5, y = row + 0.5;
    int next = from_right ? -1 : 1;
    Span span = {.x = begin, .y = row, .count = end - begin, .from_right = from_right};
    span.one_over_w = plane_ramp(&surface->one_over_w, x, y, next);
    for (int i = 0; i < VALUES; i++) span.values[i] = plane_ramp(&surface->values[i], x, y, next);
    return span;
}

/* x without its whole part, 0..1. */
static float fraction(float x) {
    if (!(fabsf(x) < 8388608.0f)) return 0; /* 2^23: no float so large has a fraction, nor fits into an int */
    float part = x - (float)(int)x;
    return part < 0 ? part + 1 : part;
}

void texture_read(const Image *texture, float s, float t, float colour[3]) {
    float x = fraction(s) * (float)texture->width - 0.5f, y = fraction(t) * (float)texture->height - 0.5f;
    int x0 = (int)(x + 1) - 1, y0 = (int)(y + 1) - 1; /* floor: x and y are at least -0.5 */
    float right = x - (float)x0, up = y - (float)y0;
    int x1 = x0 + 1 < texture->width ? x0 + 1 : 0, y1 = y0 + 1 < texture->height ? y0 + 1 : 0;
    if (x0 < 0) x0 = texture->width - 1;
    if (y0 < 0) y0 = texture->height - 1;
    const float *a = image_at(texture, x0, y0), *b = image_at(texture, x1, y0);
    const float *c = image_at(texture, x0, y1), *d = image_at(texture, x1, y1);
    for (int i = 0; i < 3; i++) {
        float low = a[i] + (b[i] - a[i]) * right, high = c[i] + (d[i] - c[i]) * right;
        colour[i] = low + (high - low) * up;
    }
}

static void write_colours(const Raster *raster, const Span *span, const float *s, const float *t) {
    float *pixel = image_at(raster->colour, span->x, span->y);
    for (int i = 0; i < span->count; i++) texture_read(raster->texture, s[i], t[i], pixel + 3 * i);
}

static void write_vertex_colours(const Raster *raster, const Span *span, float *scratch) {
    float *pixel = image_at(raster->colour, span->x, span->y);
    for (int channel = 0; channel < 3; channel++) {
        span_affine(span, VALUE_R + channel, scratch);
        for (int i = 0; i < span->count; i++) pixel[3 * i + channel] = scratch[i];
    }
}

static void write_lookup(const Raster *raster, const Span *span, const float *s, const float *t, float *w) {
    float *pixel = image_at(raster->lookup, span->x, span->y);
    double up = (2 * (span->y + 0.5) / raster->height - 1) * raster->eye_y;
    span_depth(span, w);
    for (int i = 0; i < span->count; i++) {
        double right = (2 * (span->x + i + 0.5) / raster->width - 1) * raster->eye_x;
        pixel[4 * i] = s[i];
        pixel[4 * i + 1] = t[i];
        pixel[4 * i + 2] = (float)(w[i] * sqrt(1 + right * right + up * up)); /* from w to along the ray */
        pixel[4 * i + 3] = 1;
    }
}

static void span_fill(const Raster *raster, const Surface *surface, int row, int begin, int end) {
    float s[IMAGE_SIDE_MAX], t[IMAGE_SIDE_MAX], scratch[IMAGE_SIDE_MAX];
    Span span = span_create(surface, row, begin, end);
    if (raster->filling == FILL_PERSPECTIVE) {
        span_perspective(&span, s, t);
    } else if (raster->filling == FILL_SPANS) {
        span_perspective_every(&span, raster->every, s, t);
    } else if (raster->filling == FILL_AFFINE || raster->lookup) {
        span_affine(&span, VALUE_S, s);
        span_affine(&span, VALUE_T, t);
    }
    if (raster->colour && raster->filling == FILL_COLOUR) write_vertex_colours(raster, &span, scratch);
    if (raster->colour && raster->filling != FILL_COLOUR) write_colours(raster, &span, s, t);
    if (raster->lookup) write_lookup(raster, &span, s, t, scratch);
    if (raster->bound && with_perspective(raster))
        span_bound(&span, raster->filling == FILL_SPANS ? raster->every : 0, raster->texture->width,
                   raster->texture->height, raster->bound + (size_t)row * raster->width + begin);
}

static void span_draw(const Raster *raster, const Surface *surface, int row, int begin, int end) {
    uint16_t *drawn = raster->drawn ? raster->drawn + (size_t)row * raster->width : NULL;
    for (int x = begin; drawn && x < end; x++) drawn[x]++;
    if (raster->colour || raster->lookup || raster->bound) span_fill(raster, surface, row, begin, end);
}

/* ---- Polygons ---- */

static void polygon_scan(const Raster *raster, const Surface *surface, const ClipVertex *clipped,
                         int corners) {
    SnappedVertex corner[CLIPPED_CORNERS_MAX];
    int64_t low = INT64_MAX, high = INT64_MIN;
    for (int i = 0; i < corners; i++) {
        corner[i] = vertex_snap(raster, &clipped[i]);
        if (corner[i].y < low) low = corner[i].y;
        if (corner[i].y > high) high = corner[i].y;
    }
    int end = row_above(high, raster->height);
    for (int row = row_above(low, raster->height); row < end; row++) {
        int crossings[CLIPPED_CORNERS_MAX];
        int count = row_crossings(corner, corners, row, raster->width, crossings);
        for (int i = 0; i + 1 < count; i += 2)
            if (crossings[i] < crossings[i + 1])
                span_draw(raster, surface, row, crossings[i], crossings[i + 1]);
    }
}

void raster_polygon(const Raster *raster, const ClipVertex *polygon, int corners) {
    ClipVertex clipped[CLIPPED_CORNERS_MAX];
    int left = polygon_clip(polygon, corners, raster->width, raster->height, clipped);
    if (left == 0) return;
    if (with_perspective(raster)) {
        Surface surface = surface_create(raster, polygon, corners, clipped, left);
        polygon_scan(raster, &surface, clipped, left);
        return;
    }
    for (int i = 1; i + 1 < left; i++) {
        ClipVertex triangle[3] = {clipped[0], clipped[i], clipped[i + 1]};
        Surface surface = surface_create(raster, triangle, 3, triangle, 3);
        polygon_scan(raster, &surface, triangle, 3);
    }
}

/* Vertex i of 0..splits of a row of the split parallelogram, from its ends. */
static ClipVertex split_vertex(const Raster *raster, const ClipVertex *left, const ClipVertex *right, int i,
                               int splits) {
    ClipVertex v = clip_vertex_mix(left, right, (double)i / splits);
    if (raster->filling == FILL_COLOUR) {
        float colour[3];
        texture_read(raster->texture, (float)v.s, (float)v.t, colour);
        v.r = colour[0], v.g = colour[1], v.b = colour[2];
    }
    return v;
}

void raster_parallelogram(const Raster *raster, const ClipVertex corner[4], int splits) {
    splits = splits < 1 ? 1 : splits > SPLITS_MAX ? SPLITS_MAX : splits;
    ClipVertex rows[2][SPLITS_MAX + 1]; /* the vertices below and above a row of cells, each made only once */
    for (int j = 0; j <= splits; j++) {
        ClipVertex left = clip_vertex_mix(&corner[0], &corner[3], (double)j / splits);
        ClipVertex right = clip_vertex_mix(&corner[1], &corner[2], (double)j / splits);
        ClipVertex *below = rows[(j + 1) % 2], *above = rows[j % 2];
        for (int i = 0; i <= splits; i++) above[i] = split_vertex(raster, &left, &right, i, splits);
        for (int i = 0; i < splits && j > 0; i++) {
            raster_polygon(raster, (ClipVertex[]){below[i], below[i + 1], above[i + 1]}, 3);
            raster_polygon(raster, (ClipVertex[]){below[i], above[i + 1], above[i]}, 3);
        }
    }
}
