// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Depth alone, for shadow maps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"

layout(scalar, set = 0, binding = 0) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 1) readonly buffer Instances { InstanceRow at[]; } instances;
layout(scalar, set = 0, binding = 2) readonly buffer DrawOrder { uint at[]; } draw_order;
layout(scalar, push_constant) uniform Push { mat4 clip_from_world; } push;

void main() {
  uint row = draw_order.at[gl_InstanceIndex];
  vec3 p = positions.at[instances.at[row].first_vertex + gl_VertexIndex];
  gl_Position = push.clip_from_world * vec4(instances.at[row].world_from_object * vec4(p, 1.0), 1.0);
}
