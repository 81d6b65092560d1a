#include "mesh_rays.h"

#include "fail.h"

#include <embree3/rtcore.h>
#include <float.h>
#include <stdlib.h>

struct MeshRays {
    const Mesh *mesh;
    RTCDevice device;
    RTCScene scene;
    Vec3 centre; /* of a sphere around the mesh */
    double radius;
    double room; /* what Embree's floats may be wrong by, with plenty to spare */
};

/* One ray's question. Embree hands its context on to the triangles, and with it all that follows. */
typedef struct {
    struct RTCIntersectContext context;
    const MeshRays *rays;
    Ray ray; /* from where it enters the sphere */
    MeshHit hit;
} Query;

static const Vertex *corner(const Mesh *mesh, unsigned triangle, int k) {
    return &mesh->vertices[mesh->indices[3 * (size_t)triangle + k]];
}

static Vec3 vector(const float *v) { return v3(v[0], v[1], v[2]); }

static void grow(Vec3 *low, Vec3 *high, Vec3 p) {
    *low = v3(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
    *high = v3(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
}

/* ---- What Embree calls ---- */

static void embree_failed(void *context, enum RTCError error, const char *message) {
    (void)context, (void)error;
    fail("Embree: %s", message);
}

/* The box of a triangle. */
static void triangle_bounds(const struct RTCBoundsFunctionArguments *arguments) {
    const MeshRays *rays = arguments->geometryUserPtr;
    Vec3 low = v3(INFINITY, INFINITY, INFINITY), high = vec3_scale(low, -1.0);
    for (int k = 0; k < 3; k++) grow(&low, &high, vector(corner(rays->mesh, arguments->primID, k)->position));
    struct RTCBounds *box = arguments->bounds_o;
    box->lower_x = (float)(low.x - rays->room), box->upper_x = (float)(high.x + rays->room);
    box->lower_y = (float)(low.y - rays->room), box->upper_y = (float)(high.y + rays->room);
    box->lower_z = (float)(low.z - rays->room), box->upper_z = (float)(high.z + rays->room);
}

/* The ray met the box of a triangle. It meets the triangle itself if it passes all three sides on one side:
 * the volumes of the direction with each pair of corners have one sign, and are the corners' weights in the
 * point. What is negative by no more than rounding counts as 0, so that nothing slips through between two
 * triangles, and the point never lies outside its own. */
static void triangle_meet(const struct RTCIntersectFunctionNArguments *arguments) {
    Query *query = (Query *)arguments->context;
    const MeshRays *rays = query->rays;
    Vec3 p[3];
    double weights[3], sum = 0.0, depth = 0.0;
    for (int k = 0; k < 3; k++)
        p[k] = vec3_sub(vector(corner(rays->mesh, arguments->primID, k)->position), query->ray.origin);
    for (int k = 0; k < 3; k++) {
        weights[k] = vec3_dot(query->ray.direction, vec3_cross(p[(k + 1) % 3], p[(k + 2) % 3]));
        sum += weights[k];
    }
    double side = copysign(1.0, sum), rounding = 64.0 * DBL_EPSILON * rays->radius * rays->radius;
    sum = 0.0;
    for (int k = 0; k < 3; k++) {
        if (weights[k] * side < -rounding) return;
        weights[k] = fmax(weights[k] * side, 0.0);
        sum += weights[k];
        depth += weights[k] * vec3_dot(p[k], query->ray.direction);
    }
    depth /= sum;
    if (!(depth >= 0.0 && depth < query->hit.depth)) return; /* nor if it is seen edge-on: 0 / 0 */

    struct RTCRayHit *found = (struct RTCRayHit *)arguments->rayhit;
    found->ray.tfar = (float)(depth + rays->room);
    Vec3 normal = {0};
    for (int k = 0; k < 3; k++)
        normal = vec3_add(normal,
                          vec3_scale(vector(corner(rays->mesh, arguments->primID, k)->normal), weights[k]));
    query->hit = (MeshHit){depth, vec3_normalize(normal), (int)arguments->primID};
}

/* ---- */

MeshRays *mesh_rays_create(const Mesh *mesh) {
    MeshRays *rays = allocate(1, sizeof *rays);
    rays->mesh = mesh;
    Vec3 low = v3(INFINITY, INFINITY, INFINITY), high = vec3_scale(low, -1.0);
    for (int i = 0; i < mesh->vertex_count; i++) grow(&low, &high, vector(mesh->vertices[i].position));
    rays->centre = vec3_mix(low, high, 0.5);
    rays->radius = vec3_length(vec3_sub(high, rays->centre)) * (1.0 + 1e-12);
    rays->room = 32.0 * FLT_EPSILON * (vec3_length(rays->centre) + rays->radius);

    rays->device = rtcNewDevice("threads=1"); /* which prepare the boxes; ours ask the rays */
    if (!rays->device) fail("Embree: no device (error %d)", (int)rtcGetDeviceError(NULL));
    rtcSetDeviceErrorFunction(rays->device, embree_failed, NULL);
    rays->scene = rtcNewScene(rays->device);
    rtcSetSceneFlags(rays->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)mesh->index_count / 3);
    rtcSetGeometryUserData(geometry, rays);
    rtcSetGeometryBoundsFunction(geometry, triangle_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, triangle_meet);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(rays->scene, geometry);
    rtcReleaseGeometry(geometry); /* the scene keeps it */
    rtcCommitScene(rays->scene);
    return rays;
}

void mesh_rays_destroy(MeshRays *rays) {
    rtcReleaseScene(rays->scene);
    rtcReleaseDevice(rays->device);
    free(rays);
}

bool mesh_rays_hit(const MeshRays *rays, Ray ray, MeshHit *hit) {
    Vec3 toward = vec3_sub(rays->centre, ray.origin);
    double passing = vec3_dot(toward, ray.direction);
    double distance = vec3_length(vec3_sub(vec3_scale(ray.direction, passing), toward));
    if (distance > rays->radius) return false;
    double skipped = fmax(passing - rays->radius, 0.0); /* floats are too coarse far away */
    Query query = {.rays = rays, .ray = {ray_at(ray, skipped), ray.direction}, .hit = {.depth = INFINITY}};
    rtcInitIntersectContext(&query.context);

    Vec3 o = query.ray.origin, d = ray.direction;
    struct RTCRayHit boxes = {.ray = {.org_x = (float)o.x,
                                      .org_y = (float)o.y,
                                      .org_z = (float)o.z,
                                      .dir_x = (float)d.x,
                                      .dir_y = (float)d.y,
                                      .dir_z = (float)d.z,
                                      .tfar = INFINITY,
                                      .mask = UINT32_MAX},
                              .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(rays->scene, &query.context, &boxes);
    if (query.hit.depth == INFINITY) return false;
    query.hit.depth += skipped;
    *hit = query.hit;
    return true;
}
