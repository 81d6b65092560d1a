#include "light_field.h"

#include <stdio.h>
#include <stdlib.h>

const char *field_refused(const Field *field) {
    const int sides[] = {field->u, field->v, field->s, field->t};
    for (int i = 0; i < 4; i++) {
        if (sides[i] < FIELD_LEAST) return "fewer than 8 texels along an axis";
        if (sides[i] > (i < 2 ? FIELD_MOST : FIELD_MOST_ANGLES))
            return "more than 1024 texels along u or v, or 256 along s or t";
    }
    if (field->u % 2) return "an odd number of texels along u, of which half a turn must be whole ones";
    return NULL;
}

const char *field_size(Field *field, const char *text) {
    int *const sides[] = {&field->u, &field->v, &field->s, &field->t};
    for (int i = 0; i < 4; i++) {
        char *end;
        long side = *text >= '0' && *text <= '9' ? strtol(text, &end, 10) : -1;
        if (side < 0 || side > 1000000 || *end != (i < 3 ? 'x' : '\0'))
            return "expected UxVxSxT, such as 512x256x32x32";
        *sides[i] = (int)side;
        text = end + 1;
    }
    return field_refused(field);
}

void field_list(const Field *field) {
    static const char *const models[] = {"sphere", "cylinder", "room"}, *const scales[] = {"linear", "sine",
                                                                                           "stereographic"};
    printf("  model %s radius %.17g", models[field->model], field->radius);
    if (field->model == FIELD_CYLINDER) printf(" height %.17g", field->height);
    printf("\n  light_field %dx%dx%dx%d texels of u, v, s, t, %s angles\n", field->u, field->v, field->s,
           field->t, scales[field->angles]);
}

FieldFrame field_frame(const Field *field, double u, double v) {
    double theta = radians(360.0 * u - 180.0), phi = radians(180.0 * v - 90.0);
    bool round = field->model != FIELD_CYLINDER;
    double sine = sin(theta), cosine = cos(theta), up = round ? sin(phi) : 0.0, out = round ? cos(phi) : 1.0;
    Vec3 outward = v3(out * sine, up, out * cosine);
    FieldFrame frame = {
        .at = vec3_scale(outward, field->radius), .e_z = outward, .e_x = v3(cosine, 0, -sine)};
    if (field->model == FIELD_CYLINDER) frame.at.y = field->height * (v - 0.5);
    if (field->model == FIELD_ROOM) {
        frame.e_z = vec3_scale(frame.e_z, -1.0);
        frame.e_x = vec3_scale(frame.e_x, -1.0);
    }
    frame.e_y = vec3_cross(frame.e_z, frame.e_x);
    return frame;
}

Vec2 field_place(const Field *field, Vec3 p) {
    double u = 0.5 + atan2(p.x, p.z) / (2.0 * PI);
    if (field->model == FIELD_CYLINDER) return v2(u, 0.5 + p.y / field->height);
    return v2(u, 0.5 + atan2(p.y, hypot(p.x, p.z)) / PI);
}

/* From an angle to 0..1, and back. */
static double angle_stored(FieldAngles angles, double a) {
    if (angles == ANGLES_SINE) return 0.5 + 0.5 * sin(a);
    if (angles == ANGLES_STEREOGRAPHIC) return 0.5 + 0.5 * tan(0.5 * a);
    return 0.5 + a / PI;
}

static double angle_of(FieldAngles angles, double x) {
    if (angles == ANGLES_SINE) return asin(clamp(2.0 * x - 1.0, -1.0, 1.0));
    if (angles == ANGLES_STEREOGRAPHIC) return 2.0 * atan(2.0 * x - 1.0);
    return PI * (x - 0.5);
}

Vec3 field_direction(const Field *field, const FieldFrame *frame, double s, double t) {
    double alpha = angle_of(field->angles, s), beta = angle_of(field->angles, t);
    Vec3 level = vec3_add(vec3_scale(frame->e_x, sin(alpha)), vec3_scale(frame->e_z, cos(alpha)));
    return vec3_add(vec3_scale(level, cos(beta)), vec3_scale(frame->e_y, sin(beta)));
}

Vec2 field_angles(const Field *field, const FieldFrame *frame, Vec3 d) {
    double x = vec3_dot(d, frame->e_x), y = vec3_dot(d, frame->e_y), z = vec3_dot(d, frame->e_z);
    double alpha = atan2(x, z), beta = atan2(y, hypot(x, z));
    if (field->angles != ANGLES_LINEAR)
        alpha = clamp(alpha, -0.5 * PI, 0.5 * PI); /* which all scales end at */
    return v2(angle_stored(field->angles, alpha), angle_stored(field->angles, beta));
}

FieldCell field_cell(const Field *field, double u, double v) {
    double x = u * field->u - 0.5, y = v * field->v - 0.5, column = floor(x), row = floor(y);
    FieldCell cell;
    for (int i = 0; i < 4; i++) {
        int across = i & 1, up = i >> 1, at_u = (int)column + across, at_v = (int)row + up;
        cell.weight[i] = (across ? x - column : 1.0 - (x - column)) * (up ? y - row : 1.0 - (y - row));
        if (at_v < 0 || at_v >= field->v) {
            if (field->model != FIELD_CYLINDER) at_u += field->u / 2;
            at_v = at_v < 0 ? 0 : field->v - 1;
        }
        cell.u[i] = ((at_u % field->u) + field->u) % field->u;
        cell.v[i] = at_v;
    }
    return cell;
}
