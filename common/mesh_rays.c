#include "mesh_rays.h"

#include "fail.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

struct MeshRays {
    const Mesh *mesh;
    RTCDevice device;
    RTCScene scene;
    Vec3 centre; /* of a sphere around the mesh */
    double radius;
};

static void embree_failed(void *context, enum RTCError error, const char *message) {
    (void)context, (void)error;
    fail("Embree: %s", message);
}

MeshRays *mesh_rays_create(const Mesh *mesh) {
    MeshRays *rays = allocate(1, sizeof *rays);
    rays->mesh = mesh;
    rays->device = rtcNewDevice("threads=1"); /* which prepare the mesh; ours ask the rays */
    if (!rays->device) fail("Embree: no device (error %d)", (int)rtcGetDeviceError(NULL));
    rtcSetDeviceErrorFunction(rays->device, embree_failed, NULL);
    rays->scene = rtcNewScene(rays->device);
    rtcSetSceneFlags(rays->scene, RTC_SCENE_FLAG_ROBUST); /* no ray slips through between two triangles */

    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh->vertices->position, 0, sizeof(Vertex), (size_t)mesh->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->indices, 0,
                               3 * sizeof(uint32_t), (size_t)mesh->index_count / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(rays->scene, geometry);
    rtcReleaseGeometry(geometry); /* the scene keeps it */
    rtcCommitScene(rays->scene);

    struct RTCBounds bounds;
    rtcGetSceneBounds(rays->scene, &bounds);
    Vec3 low = v3(bounds.lower_x, bounds.lower_y, bounds.lower_z);
    Vec3 high = v3(bounds.upper_x, bounds.upper_y, bounds.upper_z);
    rays->centre = vec3_mix(low, high, 0.5);
    rays->radius = 0.500001 * vec3_length(vec3_sub(high, low)); /* and some room for rounding */
    return rays;
}

void mesh_rays_destroy(MeshRays *rays) {
    rtcReleaseScene(rays->scene);
    rtcReleaseDevice(rays->device);
    free(rays);
}

static const Vertex *corner(const Mesh *mesh, int triangle, int k) {
    return &mesh->vertices[mesh->indices[3 * (size_t)triangle + k % 3]];
}

static Vec3 vector(const float *v) { return v3(v[0], v[1], v[2]); }

/* Where the ray crosses the plane of a triangle that it is known to meet. What Embree's rounding lets by, and
 * a plane that is seen edge-on, can put that point outside the triangle: it is kept between the depths of the
 * corners, and the weights of the corners, which are areas, at least 0. */
static MeshHit crossing(const Mesh *mesh, int triangle, Ray ray) {
    Vec3 p[3], plane;
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        p[k] = vec3_sub(vector(corner(mesh, triangle, k)->position), ray.origin);
        double depth = vec3_dot(p[k], ray.direction);
        low = fmin(low, depth), high = fmax(high, depth);
    }
    plane = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    double depth = vec3_dot(plane, p[0]) / vec3_dot(plane, ray.direction);
    MeshHit hit = {.depth = fmax(fmin(fmax(depth, low), high), 0.0), .triangle = triangle};

    Vec3 at = vec3_scale(ray.direction, hit.depth), normal = {0};
    for (int k = 0; k < 3; k++) {
        Vec3 next = vec3_sub(p[(k + 1) % 3], at), last = vec3_sub(p[(k + 2) % 3], at);
        double weight = fmax(vec3_dot(plane, vec3_cross(next, last)), 0.0);
        normal = vec3_add(normal, vec3_scale(vector(corner(mesh, triangle, k)->normal), weight));
    }
    hit.normal = vec3_normalize(normal);
    return hit;
}

bool mesh_rays_hit(const MeshRays *rays, Ray ray, MeshHit *hit) {
    /* Embree computes in floats: it gets the ray from where it enters the sphere around the mesh. */
    Vec3 toward = vec3_sub(rays->centre, ray.origin);
    double passing = vec3_dot(toward, ray.direction);
    double distance = vec3_length(vec3_sub(vec3_scale(ray.direction, passing), toward));
    if (distance > rays->radius || passing < -rays->radius) return false;
    Vec3 start = ray_at(ray, fmax(passing - rays->radius, 0.0));

    struct RTCRayHit query = {.ray = {.org_x = (float)start.x,
                                      .org_y = (float)start.y,
                                      .org_z = (float)start.z,
                                      .dir_x = (float)ray.direction.x,
                                      .dir_y = (float)ray.direction.y,
                                      .dir_z = (float)ray.direction.z,
                                      .tfar = INFINITY,
                                      .mask = UINT32_MAX},
                              .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(rays->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *hit = crossing(rays->mesh, (int)query.hit.primID, ray);
    return true;
}
