#include "solids.h"

static void put(Image *image, int x, int y, Vec3 v) {
    float *texel = image_at(image, x, y);
    texel[0] = (float)v.x, texel[1] = (float)v.y, texel[2] = (float)v.z;
}

/* Turned by degrees about x, about y, about z in that order. */
static Vec3 turned(Vec3 p, Vec3 degrees) {
    double x = radians(degrees.x), y = radians(degrees.y), z = radians(degrees.z);
    p = v3(p.x, cos(x) * p.y - sin(x) * p.z, sin(x) * p.y + cos(x) * p.z);
    p = v3(cos(y) * p.x + sin(y) * p.z, p.y, cos(y) * p.z - sin(y) * p.x);
    return v3(cos(z) * p.x - sin(z) * p.y, sin(z) * p.x + cos(z) * p.y, p.z);
}

Texture solids_texture(const LightScene *scene, SolidKinds *kinds) {
    Image image = image_create(6, scene->count, 4);
    int row = 0, ends[3];
    for (int kind = 0; kind < 3; kind++) {
        for (int i = 0; i < scene->count; i++) {
            const Solid *solid = &scene->solids[i];
            if ((int)solid->kind != kind) continue;
            put(&image, 0, row, vec3_scale(solid->size, 0.5));
            put(&image, 1, row, solid->centre);
            for (int k = 0; k < 3; k++)
                put(&image, 2 + k, row, turned(v3(k == 0, k == 1, k == 2), solid->turn_degrees));
            put(&image, 5, row, solid->colour);
            row++;
        }
        ends[kind] = row;
    }
    *kinds = (SolidKinds){ends[SOLID_SPHERE], ends[SOLID_CYLINDER], ends[SOLID_BOX]};
    Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    image_destroy(&image);
    return texture;
}
