// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The holes of an alpha mask let light through.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"

layout(scalar, set = 0, binding = 5) readonly buffer Materials { MaterialRow at[]; } materials;
layout(set = 1, binding = 0) uniform sampler2D base_color_map;

layout(location = 0) in vec2 uv;
layout(location = 1) in float vertex_alpha;
layout(location = 2) flat in uint material_row;

void main() {
  float alpha = materials.at[material_row].base_color.a * vertex_alpha * texture(base_color_map, uv).a;
  if (alpha < materials.at[material_row].alpha_cutoff) discard;
}
