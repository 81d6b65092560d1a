// A mesh in the world: what most lessons' fragments start from.
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 mesh_tangent;
layout(location = 3) in vec2 mesh_uv;

uniform mat4 view_projection, model;

out vec3 position, normal; // in the world
out vec4 tangent;          // xyz in the world; w: the bitangent is w * cross(normal, tangent.xyz)
out vec2 uv;

void main() {
    vec4 world = model * vec4(mesh_position, 1.0);
    position = world.xyz;
    normal = mat3(model) * mesh_normal; // right for rotations and one scale for all axes
    tangent = vec4(mat3(model) * mesh_tangent.xyz, mesh_tangent.w);
    uv = mesh_uv;
    gl_Position = view_projection * world;
}
