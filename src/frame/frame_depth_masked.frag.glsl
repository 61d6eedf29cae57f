// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The holes of an alpha mask let light through.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"

layout(set = 1, binding = 0) uniform sampler2D base_color_map;
layout(scalar, set = 1, binding = 1) uniform MaterialBlock { MaterialRow row; } material;

layout(location = 0) in vec2 uv;
layout(location = 1) in float vertex_alpha;

void main() {
  float alpha = material.row.base_color.a * vertex_alpha * texture(base_color_map, uv).a;
  if (alpha < material.row.alpha_cutoff) discard;
}
