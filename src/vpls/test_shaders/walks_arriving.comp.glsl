// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What each virtual light throws on a plane that faces it, at each of some points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/walks.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Rows { WalkVpl at[]; } rows;
layout(scalar, set = 0, binding = 1) readonly buffer Places { vec3 at[]; } places;
layout(scalar, set = 0, binding = 2) writeonly buffer Arriving { vec3 at[]; } arriving;  // irradiance, direction

void main() {
  uvec2 i = gl_GlobalInvocationID.xy;
  if (i.x >= rows.at.length() || i.y >= places.at.length()) return;
  vec3 to_light;
  vec3 irradiance = walkIrradiance(rows.at[i.x], places.at[i.y], to_light);
  uint k = i.y * uint(rows.at.length()) + i.x;
  arriving.at[2u * k] = irradiance;
  arriving.at[2u * k + 1u] = to_light;
}
