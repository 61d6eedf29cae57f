// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Depth of surfaces with holes, for shadow maps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"

layout(scalar, set = 0, binding = 0) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 1) readonly buffer Instances { InstanceRow at[]; } instances;
layout(scalar, set = 0, binding = 2) readonly buffer DrawOrder { uint at[]; } draw_order;
layout(scalar, set = 0, binding = 3) readonly buffer Uvs { vec2 at[]; } uvs;
layout(scalar, set = 0, binding = 4) readonly buffer Meshes { MeshRow at[]; } meshes;
layout(scalar, set = 0, binding = 6) readonly buffer Colors { uvec2 at[]; } colors;
layout(scalar, set = 1, binding = 1) uniform MaterialBlock { MaterialRow row; } material;
layout(scalar, push_constant) uniform Push { mat4 clip_from_world; } push;

layout(location = 0) out vec2 uv;
layout(location = 1) out float vertex_alpha;

void main() {
  uint row = draw_order.at[gl_InstanceIndex];
  vec3 p = positions.at[instances.at[row].first_vertex + gl_VertexIndex];
  gl_Position = push.clip_from_world * vec4(instances.at[row].world_from_object * vec4(p, 1.0), 1.0);
  MeshRow mesh = meshes.at[instances.at[row].mesh];
  vec2 raw = mesh.first_uv.x == kAbsent ? vec2(0.0) : uvs.at[mesh.first_uv.x + gl_VertexIndex];
  vec4 m = material.row.texture_from_uv[0];
  uv = m.xy * raw.x + m.zw * raw.y + material.row.texture_offset[0];
  vertex_alpha =
      mesh.first_color == kAbsent ? 1.0 : unpackUnorm2x16(colors.at[mesh.first_color + gl_VertexIndex].y).y;
}
