// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A triangle of the scene from the ids of the G-buffer, and where on it a ray lands. GLOAM_TRIANGLE_SET, the
// descriptor set of the buffers, is defined by the includer; GpuScene::bindTriangles binds them.
#ifndef GLOAM_FRAME_TRIANGLE_GLSL
#define GLOAM_FRAME_TRIANGLE_GLSL
#include "frame/frame_shared.h"

layout(scalar, set = GLOAM_TRIANGLE_SET, binding = 0) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = GLOAM_TRIANGLE_SET, binding = 1) readonly buffer Indices { uint at[]; } indices;
layout(scalar, set = GLOAM_TRIANGLE_SET, binding = 2) readonly buffer Instances { InstanceRow at[]; } instances;
layout(scalar, set = GLOAM_TRIANGLE_SET, binding = 3) readonly buffer Meshes { MeshRow at[]; } meshes;

/// Vertices of a triangle, counted within its mesh.
uvec3 triangleVertices(uint instance, uint triangle) {
  uint first = meshes.at[instances.at[instance].mesh].first_index + 3u * triangle;
  return uvec3(indices.at[first], indices.at[first + 1u], indices.at[first + 2u]);
}

/// Its corners in the world.
mat3 triangleCorners(uint instance, uvec3 vertices) {
  uint first = instances.at[instance].first_vertex;
  mat4x3 world_from_object = instances.at[instance].world_from_object;
  return mat3(world_from_object * vec4(positions.at[first + vertices.x], 1.0),
              world_from_object * vec4(positions.at[first + vertices.y], 1.0),
              world_from_object * vec4(positions.at[first + vertices.z], 1.0));
}

/// Barycentric coordinates of the point in which a ray meets the plane of a triangle, clamped to the
/// triangle: pixel centres of the G-buffer lie inside up to rounding. Moeller and Trumbore 1997.
vec3 barycentrics(mat3 corners, vec3 origin, vec3 direction) {
  vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  vec3 s = origin - corners[0];
  vec3 p = cross(direction, e2);
  float determinant = dot(e1, p);
  if (abs(determinant) < 1e-30) return vec3(1.0 / 3.0);
  float u = dot(s, p) / determinant;
  float v = dot(direction, cross(s, e1)) / determinant;
  vec3 b = max(vec3(1.0 - u - v, u, v), vec3(0.0));
  return b / (b.x + b.y + b.z);
}

#endif
