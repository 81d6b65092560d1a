#include "prism.h"

#include "fail.h"
#include "table.h"
#include "parallax.h"

#include <stdlib.h>

/* A part of the scene: sides faces between two heights. */
typedef struct {
    int sides;
    double turn; /* by which the corner that mesh_prism puts at -z is turned toward +x */
    Shape faces[SIDES_MAX];
    Texture depth;
} Prism;

typedef struct {
    Image colour_image;
    Texture colour;
    bool joint;                   /* the scene `cylinder`: two prisms, one above the other */
    Prism *prisms[SIDES_MAX + 1]; /* by their number of sides; made when first drawn */
} Round;

/* ---- Geometry of one face: a chord of the circle of radius 1 ---- */

static double half_angle(int sides) { return PI / sides; }
static double girth(int sides) { return 2.0 * sides * sin(half_angle(sides)); }

double prism_scale(int sides) { return (1.0 - cos(half_angle(sides))) / girth(sides); }

Image prism_depth_map(int sides, double corner) {
    Image map = image_create(DEPTH_TEXELS, 1, 1);
    double chord = cos(half_angle(sides)), half = sin(half_angle(sides));
    for (int i = 0; i < map.width; i++) {
        double faces = ((i + 0.5) / map.width - corner) * sides;
        double along = (2.0 * (faces - floor(faces)) - 1.0) * half; /* from the face's middle */
        *image_at(&map, i, 0) = (float)((sqrt(1.0 - along * along) - chord) / (1.0 - chord));
    }
    return map;
}

/* ---- Loading ---- */

/* mesh_prism's vertices, turned about y and moved up; the same for all that share a place, so nothing opens.
 */
static void place(Mesh *mesh, double turn, double up) {
    double c = cos(turn), s = sin(turn);
    for (int i = 0; i < mesh->vertex_count; i++) {
        Vertex *vertex = &mesh->vertices[i];
        float *turned[] = {vertex->position, vertex->normal, vertex->tangent};
        for (int k = 0; k < 3; k++) {
            double x = turned[k][0], z = turned[k][2];
            turned[k][0] = (float)(c * x + s * z);
            turned[k][2] = (float)(c * z - s * x);
        }
        vertex->position[1] += (float)up;
        vertex->uv[0] += (float)(turn / (2.0 * PI));
        vertex->uv[1] = (float)((vertex->position[1] + CYLINDER_HEIGHT / 2.0) / (2.0 * PI));
    }
}

static Prism *prism_create(int sides, double bottom, double top, double turn) {
    enum { CORNERS = 4, INDICES = 6 }; /* of a face */
    Prism *prism = allocate(1, sizeof *prism);
    prism->sides = sides;
    prism->turn = turn;
    Mesh mesh = mesh_prism(1.0, top - bottom, sides);
    place(&mesh, turn, (top + bottom) / 2.0);
    for (int i = 0; i < sides; i++) {
        uint32_t indices[INDICES];
        for (int k = 0; k < INDICES; k++)
            indices[k] = mesh.indices[INDICES * i + k] - (uint32_t)(CORNERS * i);
        Mesh face = {CORNERS, INDICES, mesh.vertices + CORNERS * i, indices};
        prism->faces[i] = shape_create(&face);
    }
    mesh_destroy(&mesh);
    Image depth = prism_depth_map(sides, turn / (2.0 * PI));
    prism->depth = texture_create(&depth, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    image_destroy(&depth);
    return prism;
}

static Round *load(const Options *options, bool joint) {
    Round *round = allocate(1, sizeof *round);
    round->colour_image = image_load(options->colour, IMAGE_COLOUR);
    round->colour = texture_of(&round->colour_image, IMAGE_COLOUR);
    round->joint = joint;
    return round;
}

void *prism_load_cylinder(const Options *options) {
    Round *round = load(options, true);
    round->prisms[CYLINDER_SIDES] = prism_create(CYLINDER_SIDES, -CYLINDER_HEIGHT / 2.0, 0.0, 0.0);
    round->prisms[SMOOTH_SIDES] = prism_create(SMOOTH_SIDES, 0.0, CYLINDER_HEIGHT / 2.0, 0.0);
    return round;
}

void *prism_load_sides(const Options *options) { return load(options, false); }

void prism_unload(void *data) {
    Round *round = data;
    for (int n = 0; n <= SIDES_MAX; n++) {
        Prism *prism = round->prisms[n];
        if (!prism) continue;
        for (int i = 0; i < prism->sides; i++) shape_destroy(&prism->faces[i]);
        texture_destroy(&prism->depth);
        free(prism);
    }
    image_destroy(&round->colour_image);
    texture_destroy(&round->colour);
    free(round);
}

/* ---- Drawing ---- */

/* The angle from +z toward +x of face i's normal. */
static double face_angle(const Prism *prism, int i) {
    return (2 * i + 1) * half_angle(prism->sides) - PI + prism->turn;
}

/* The tangents of the view's angles from a face's normal, at the face's middle, along u and along v. */
static Vec2 face_tangents(const Camera *camera, double angle, Vec3 middle) {
    Vec3 view = vec3_sub(camera->eye, camera->fov_y_degrees > 0.0 ? middle : camera->target);
    Vec3 normal = v3(sin(angle), 0, cos(angle)), tangent = v3(cos(angle), 0, -sin(angle));
    return parallax_tangents(v3(vec3_dot(view, tangent), view.y, vec3_dot(view, normal)));
}

static void draw_prism(const Frame *frame, const Prism *prism, double middle_y, double scale) {
    program_texture(frame->program, "height_map", &prism->depth);
    program_number(frame->program, "scale", scale);
    program_number(frame->program, "base", 0.0);
    program_number(frame->program, "aspect", 2.0 * PI / girth(prism->sides)); /* v is not on the chord */
    double distance = cos(half_angle(prism->sides));
    for (int i = 0; i < prism->sides; i++) {
        double angle = face_angle(prism, i);
        Vec3 middle = v3(distance * sin(angle), middle_y, distance * cos(angle));
        Vec2 tangents = face_tangents(&frame->camera, angle, middle);
        program_vector(frame->program, "tangents", tangents.x, tangents.y, 0, 0);
        shape_draw(&prism->faces[i]);
    }
}

static int knob_sides(const Frame *frame) { return (int)clamp(round(frame->knob), SIDES_MIN, SIDES_MAX); }

static const Prism *prism_with(Round *round, int sides) {
    if (!round->prisms[sides]) /* an odd one has a face toward +z already */
        round->prisms[sides] = prism_create(sides, -CYLINDER_HEIGHT / 2.0, CYLINDER_HEIGHT / 2.0,
                                            sides % 2 ? 0.0 : half_angle(sides));
    return round->prisms[sides];
}

void prism_draw(const Frame *frame) {
    Round *round = frame->data;
    int sides = round->joint ? CYLINDER_SIDES : knob_sides(frame);
    const Prism *prism = prism_with(round, sides); /* before binding, for making a texture binds it */
    program_texture(frame->program, "colour_map", &round->colour);
    if (round->joint) {
        double quarter = CYLINDER_HEIGHT / 4.0;
        draw_prism(frame, prism, -quarter, prism_scale(sides));
        draw_prism(frame, round->prisms[SMOOTH_SIDES], quarter, 0.0); /* no depth: plain */
    } else {
        draw_prism(frame, prism, 0.0, prism_scale(sides));
    }
}

/* ---- The truth ---- */

Sample prism_truth(const void *data, Ray ray) {
    const Round *round = data;
    Sample sample = truth_cylinder(ray, 1.0, CYLINDER_HEIGHT);
    if (sample.hit) {
        sample.v *= CYLINDER_HEIGHT / (2.0 * PI);
        sample.colour = truth_colour(&round->colour_image, sample.u, sample.v);
    }
    return sample;
}

Vec2 prism_texels(const void *data) {
    const Round *round = data;
    return v2(round->colour_image.width, round->colour_image.height);
}

/* ---- Metrics ---- */

typedef struct {
    double sum, max;
    int count;
} Errors;

static void errors_add(Errors *errors, double error) {
    errors->sum += error * error;
    errors->max = fmax(errors->max, fabs(error));
    errors->count++;
}

static double errors_rms(const Errors *errors) { return sqrt(errors->sum / fmax(errors->count, 1)); }

/* The error of u at a pixel, in texels; false where the picture or the truth has nothing. */
static bool u_error(const Shots *shots, const Shot *shot, int x, int y, double *error) {
    const float *lookup = image_at(&shot->picture.lookup, x, y);
    const Sample *exact = &shot->centres[(size_t)y * shots->frame->width + x];
    *error = (lookup[0] - exact->u) * prism_texels(shots->frame->data).x;
    return exact->hit && lookup[3] > 0.5f;
}

/* The last row of pixel centres below the joint and the first above it. In an orthographic view from the side
 * the exact u is the same in both, for each column; a perspective view shows the joint as an arc, and is
 * passed over. */
void prism_measure_joint(const Shots *shots, Table *table) {
    int width = shots->frame->width, height = shots->frame->height;
    int below = (int)ceil(height / 2.0 - 0.5) - 1, above = (int)floor(height / 2.0 + 0.5);
    bool plain = shots->frame->technique == shots->frame->scene->techniques;
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        const Camera *camera = &shot->view->camera;
        if (camera->fov_y_degrees > 0.0 || camera->eye.y != 0.0 || camera->target.y != 0.0 || below < 0)
            continue;
        Errors mismatch = {0}, chord = {0};
        Vec3 toward = vec3_normalize(vec3_sub(camera->eye, camera->target));
        bool face = fabs(atan2(toward.x, toward.z) - half_angle(CYLINDER_SIDES)) < 1e-6;
        for (int x = 0; x < width; x++) {
            double low, high, across = ((x + 0.5) / width - 0.5) * camera->height * width / height;
            if (!u_error(shots, shot, x, below, &low) || !u_error(shots, shot, x, above, &high)) continue;
            errors_add(&mismatch, low - high);
            if (face && fabs(across) < sin(half_angle(CYLINDER_SIDES))) errors_add(&chord, low);
            table_point(table, shots, shot->view, "joint-mismatch", "position across the width", across,
                        "mismatch (texels)", low - high);
        }
        table_add(table, shots, shot->view, "joint_mismatch_texels_rms", errors_rms(&mismatch), "texels");
        table_add(table, shots, shot->view, "joint_mismatch_texels_max", mismatch.max, "texels");
        if (plain && chord.count) /* seen along its normal a face is not shifted: only the chord errs */
            table_add(table, shots, shot->view, "chord_error_texels_rms", errors_rms(&chord), "texels");
    }
}

/* Whether a pixel's ray crosses the chord that faces +z, at least an eighth of a pixel from its ends: nearer
 * than that OpenGL's rounding of vertices decides which face is drawn. */
static bool on_face(const Ray *ray, int sides, double pixel) {
    double t = (cos(half_angle(sides)) - ray->origin.z) / ray->direction.z;
    double x = ray->origin.x + t * ray->direction.x;
    return ray->direction.z < 0.0 &&
           fabs(x) < sin(half_angle(sides)) - 0.125 * pixel / fabs(ray->direction.z);
}

void prism_measure_sides(const Shots *shots, Table *table) {
    const Frame *frame = shots->frame;
    int sides = knob_sides(frame);
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        const Camera *camera = &shot->view->camera;
        Vec3 toward = vec3_sub(camera->eye, camera->target);
        double degrees = atan2(toward.x, toward.z) * 180.0 / PI;
        Errors errors = {0};
        for (int y = 0; y < frame->height; y++)
            for (int x = 0; x < frame->width; x++) {
                Ray ray = camera_ray(camera, frame->width, frame->height, x + 0.5, y + 0.5);
                double error;
                if (on_face(&ray, sides, camera->height / frame->height) &&
                    u_error(shots, shot, x, y, &error))
                    errors_add(&errors, error);
            }
        if (!errors.count) continue; /* a picture too small to show the face */
        double rms = errors_rms(&errors);
        table_add(table, shots, shot->view, "distortion_texels_rms", rms, "texels");
        table_add(table, shots, shot->view, "distortion_texels_max", errors.max, "texels");
        table_point(table, shots, NULL, "angle-rms", "angle (degrees)", degrees, "rms distortion (texels)",
                    rms);
        table_point(table, shots, NULL, "angle-max", "angle (degrees)", degrees,
                    "largest distortion (texels)", errors.max);
        table_set(table, frame->scene->name, frame->technique->name, 0); /* one line through all knobs */
        table_point(table, shots, shot->view, "sides-rms", "sides", sides, "rms distortion (texels)", rms);
        table_point(table, shots, shot->view, "sides-max", "sides", sides, "largest distortion (texels)",
                    errors.max);
        table_set(table, frame->scene->name, frame->technique->name, frame->knob);
    }
}
