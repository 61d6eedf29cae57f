// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SL-3: L_S = sum of L_pj Y_j, times the albedo (an SH product), turned to the world. A group a sphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "math/sh_product.glsl"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 16) in;
layout(scalar, set = 0, binding = 0) readonly buffer Arriving { vec3 at[]; } arriving;
layout(scalar, set = 0, binding = 1) readonly buffer Cells { float at[]; } cells;  // Y_j, 16 a direction
layout(scalar, set = 0, binding = 2) readonly buffer Senders { SenderRow at[]; } senders;
layout(scalar, set = 0, binding = 3) writeonly buffer Sent { SentRow at[]; } sent;

shared vec3 lit[16], coloured[16];

void main() {
  uint s = gl_WorkGroupID.x, i = gl_LocalInvocationID.x;
  vec3 sum = vec3(0.0);
  for (uint j = 0u; j < kDirections; ++j) sum += arriving.at[s * kDirections + j] * cells.at[16u * j + i];
  lit[i] = sum;
  barrier();
  if (i < 3u) {
    float f[16], g[16], h[16];
    for (int c = 0; c < 16; ++c) {
      f[c] = lit[c][i];
      g[c] = senders.at[s].albedo[c][i];
    }
    shProduct4(f, g, h);
    for (int c = 0; c < 16; ++c) coloured[c][i] = h[c];
  }
  barrier();
  uint band = i == 0u ? 0u : i < 4u ? 1u : i < 9u ? 2u : 3u;
  vec3 turned = vec3(0.0);
  if (band == 0u) {
    turned = coloured[0];
  } else {
    uint size = 2u * band + 1u, first = band * band, before = band == 1u ? 0u : band == 2u ? 9u : 34u;
    for (uint c = 0u; c < size; ++c) turned += senders.at[s].turn[before + (i - first) * size + c] * coloured[first + c];
  }
  sent.at[s].at[i] = turned;
}
