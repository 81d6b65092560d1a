/* Rays against a triangle mesh: Embree finds the triangles whose boxes a ray meets, and which of them it
 * meets itself is computed in doubles. For truths and for making textures.
 *
 * Embree has triangles of its own, but in floats, and at some corners they let a ray by. */
#ifndef TEXEL_MESH_RAYS_H
#define TEXEL_MESH_RAYS_H

#include "mesh.h"
#include "vec.h"

#include <stdbool.h>

typedef struct MeshRays MeshRays;

typedef struct {
    double depth; /* along the ray, from its origin */
    Vec3 normal;  /* unit: the corners' normals mixed, as a shader would */
    int triangle;
} MeshHit;

/* Prepares a mesh for rays; it must outlive what is returned, which mesh_rays_destroy frees. */
MeshRays *mesh_rays_create(const Mesh *mesh);
void mesh_rays_destroy(MeshRays *rays);

/* The first triangle that the ray meets, from either side; an edge or a corner belongs to all its triangles,
 * so that a closed mesh lets no ray by. False, and hit as it was, where there is none. May be called from
 * many threads. */
bool mesh_rays_hit(const MeshRays *rays, Ray ray, MeshHit *hit);

#endif
