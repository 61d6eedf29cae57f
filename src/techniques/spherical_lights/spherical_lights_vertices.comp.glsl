// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where the vertices of the scene stand, as points of a picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 1) readonly buffer Normals { vec3 at[]; } normals;
layout(scalar, set = 0, binding = 2) readonly buffer Instances { InstanceRow at[]; } instances;
layout(scalar, set = 0, binding = 3) readonly buffer FirstPoints { uint at[]; } first_points;
layout(set = 0, binding = 4) uniform writeonly image2D point_position;
layout(set = 0, binding = 5) uniform writeonly image2D point_normal;
layout(scalar, push_constant) uniform Push { VertexParams params; } push;

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(place, imageSize(point_position)))) return;
  uint p = uint(place.y) * kVertexColumns + uint(place.x);
  vec4 position = vec4(0.0);
  vec3 normal = vec3(0.0);
  if (p < push.params.vertices) {
    uint low = 0u, high = push.params.instances;  // the last one that begins at p or before
    while (high - low > 1u) {
      uint middle = (low + high) / 2u;
      if (first_points.at[middle] <= p) low = middle; else high = middle;
    }
    uint vertex = instances.at[low].first_vertex + p - first_points.at[low];
    position = vec4(instances.at[low].world_from_object * vec4(positions.at[vertex], 1.0), 1.0);
    normal = normalize(instances.at[low].world_from_normal * normals.at[vertex]);
  }
  imageStore(point_position, place, position);
  imageStore(point_normal, place, vec4(normal, 1.0));
}
