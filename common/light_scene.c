#include "light_scene.h"

#include <stdio.h>
#include <string.h>

/* ---- The scenes ---- */

/* clang-format off */
#define SPHERE(colour_, x, y, z) {SOLID_SPHERE, {1, 1, 1}, {x, y, z}, {0, 0, 0}, colour_}
#define CYLINDER(colour_, x, y, z, about_x) {SOLID_CYLINDER, {1, 2, 1}, {x, y, z}, {about_x, 0, 0}, colour_}
#define CUBE(colour_, x, y, z) {SOLID_BOX, {1, 1, 1}, {x, y, z}, {0, 0, 0}, colour_}
#define WHITE {1, 1, 1}
#define RED {1, 0, 0}
#define PURPLE {0.5, 0, 0.5}
#define BLUE {0, 0, 1}
#define BLACK {0, 0, 0}
#define GREEN {0, 1, 0}
#define YELLOW {1, 1, 0}
#define LIT .toward_light = {1, 0, 0}

#define COMPOSED .count = 7, LIT, .solids = { \
    SPHERE(WHITE, 0, 0, 0), SPHERE(RED, 0, 0, -1.87), CYLINDER(PURPLE, 2.62, 0, 0, 0), \
    CYLINDER(BLUE, -1.07, -0.41, 1.81, 90), CYLINDER(BLACK, 0.87, 0.76, 2.06, 0), \
    CUBE(GREEN, -1.2, 0.71, -0.68), CUBE(YELLOW, 1.47, -1.05, 0.93)}

const LightScene light_composed = {.name = "composed", COMPOSED};
const LightScene light_effects = {.name = "effects", COMPOSED, .effects = true,
                                  .mirror = {[0] = 0.6}, .clear = {[6] = 0.5}};
const LightScene light_aliasing = {.name = "aliasing", .count = 1, LIT, .solids = {CYLINDER(WHITE, 0, 0, 2.5, 0)}};
const LightScene light_placements = {.name = "placements", .count = 3, LIT, .solids = {
    SPHERE(RED, -1.4, 0, 2), SPHERE(GREEN, 0, 0, 3.5), SPHERE(YELLOW, 2.4, 0, 4.2)}};
const LightScene light_around = {.name = "around", .count = 6, LIT, .solids = {
    SPHERE(RED, 0, 0, -5.61), CYLINDER(PURPLE, 7.86, 0, 0, 0), CYLINDER(BLUE, -3.21, -1.23, 5.43, 90),
    CYLINDER(WHITE, 2.61, 2.28, 6.18, 0), CUBE(GREEN, -3.6, 2.13, -2.04), CUBE(YELLOW, 4.41, -3.15, 2.79)}};
/* clang-format on */

const LightScene *light_scene_named(const char *name) {
    static const LightScene *const all[] = {&light_composed, &light_effects, &light_aliasing,
                                            &light_placements, &light_around};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (strcmp(all[i]->name, name) == 0) return all[i];
    return NULL;
}

static void list_vector(const char *name, Vec3 v) { printf(" %s %.17g %.17g %.17g", name, v.x, v.y, v.z); }

void light_scene_list(const LightScene *scene) {
    static const char *const kinds[] = {"sphere", "cylinder", "box"};
    printf("  light toward %.17g %.17g %.17g ambient %g diffuse %g specular %g exponent %d: Phong, linear\n",
           scene->toward_light.x, scene->toward_light.y, scene->toward_light.z, LIGHT_AMBIENT, LIGHT_DIFFUSE,
           LIGHT_SPECULAR, LIGHT_EXPONENT);
    for (int i = 0; i < scene->count; i++) {
        const Solid *solid = &scene->solids[i];
        printf("  solid %s", kinds[solid->kind]);
        list_vector("size", solid->size);
        list_vector("centre", solid->centre);
        list_vector("turn_degrees", solid->turn_degrees);
        list_vector("colour", solid->colour);
        if (scene->effects) printf(" mirror %g clear %g", scene->mirror[i], scene->clear[i]);
        putchar('\n');
    }
    if (scene->effects)
        printf("  effects shadows, one mirroring, straight transparency: common/light_scene.h\n");
}

/* ---- The truth ---- */

/* The first of the solids but one that a ray meets. What starts on a solid leaves that one out, for all are
 * convex; -1 leaves out none. */
static bool hit_others(const LightScene *scene, int but, Ray ray, SolidHit *hit) {
    SolidHit before, behind;
    if (but < 0) return solids_hit(scene->solids, scene->count, ray, hit);
    bool any_before = solids_hit(scene->solids, but, ray, &before);
    bool any_behind = solids_hit(scene->solids + but + 1, scene->count - but - 1, ray, &behind);
    behind.index += but + 1;
    *hit = any_before && (!any_behind || before.depth <= behind.depth) ? before : behind;
    return any_before || any_behind;
}

/* The share of the light that reaches a point of a solid. */
static double light_reaching(const LightScene *scene, int on, Vec3 at) {
    double share = 1.0;
    for (int i = 0; i < scene->count; i++) {
        SolidHit hit;
        if (i != on && solids_hit(&scene->solids[i], 1, (Ray){at, scene->toward_light}, &hit))
            share *= scene->clear[i];
    }
    return share;
}

/* What the surface of a solid sends back by itself. */
static Vec3 surface_light(const LightScene *scene, const SolidHit *hit, Ray ray) {
    Vec3 colour = scene->solids[hit->index].colour, light = vec3_scale(colour, LIGHT_AMBIENT);
    Vec3 normal = hit->normal, toward = scene->toward_light;
    double facing = vec3_dot(normal, toward);
    if (facing <= 0.0) return light;
    double lit = scene->effects ? light_reaching(scene, hit->index, ray_at(ray, hit->depth)) : 1.0;
    Vec3 mirrored = vec3_sub(vec3_scale(normal, 2.0 * facing), toward);
    double highlight =
        LIGHT_SPECULAR * pow(fmax(-vec3_dot(mirrored, ray.direction), 0.0), LIGHT_EXPONENT) * lit;
    light = vec3_add(light, vec3_scale(colour, LIGHT_DIFFUSE * facing * lit));
    return vec3_add(light, v3(highlight, highlight, highlight));
}

static Vec3 radiance(const LightScene *scene, int but, Ray ray, bool mirrors, SolidHit *hit, bool *met) {
    *met = hit_others(scene, but, ray, hit);
    if (!*met) return v3(0, 0, 0);
    Vec3 own = surface_light(scene, hit, ray);
    double mirror = scene->effects && mirrors ? scene->mirror[hit->index] : 0.0;
    double clear = scene->effects ? scene->clear[hit->index] : 0.0;
    Vec3 sum = vec3_scale(own, 1.0 - mirror - clear), at = ray_at(ray, hit->depth);
    SolidHit next;
    bool any;
    if (mirror > 0.0) {
        Vec3 away = vec3_scale(hit->normal, 2.0 * vec3_dot(hit->normal, ray.direction));
        Ray reflected = {at, vec3_normalize(vec3_sub(ray.direction, away))};
        sum = vec3_add(sum, vec3_scale(radiance(scene, hit->index, reflected, false, &next, &any), mirror));
    }
    if (clear > 0.0) {
        Ray onward = {at, ray.direction};
        sum = vec3_add(sum, vec3_scale(radiance(scene, hit->index, onward, mirrors, &next, &any), clear));
    }
    return sum;
}

Vec3 light_along(const LightScene *scene, Ray ray, SolidHit *hit, bool *met) {
    return radiance(scene, -1, ray, true, hit, met);
}
