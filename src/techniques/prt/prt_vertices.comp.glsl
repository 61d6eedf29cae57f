// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A vertex's irradiance: its transfer vectors times its object's light. One row of invocations a block of vertices, four
// neighbours each: what is loaded together is one wide load, and light is loaded once for four (Mesa's software driver takes
// a load lane by lane, and as long for four words as for one).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int coefficients = 25;
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool half_float = false;
layout(constant_id = 3) const bool in_parts = false;  // the lights' sharpest peaks follow, which the first ones lack

layout(local_size_x = kBlockVertices / 4, local_size_y = kBlocksTogether) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uvec4 at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uvec4 at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { vec3 at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, push_constant) uniform Push { VerticesParams params; } push;

const uint kTogether = 4u;
const uint kRow = kBlockVertices / kTogether;

/// Irradiance of four vertices, a colour each row.
struct Four {
  vec4 r, g, b;
};
Four none() { return Four(vec4(0.0), vec4(0.0), vec4(0.0)); }
void add(inout Four sum, vec3 light, vec4 r, vec4 g, vec4 b) {
  sum.r += light.r * r;
  sum.g += light.g * g;
  sum.b += light.b * b;
}
vec3 of(Four sum, int k) { return vec3(sum.r[k], sum.g[k], sum.b[k]); }

/// Word w of four vertices; halves stand two a word.
vec4 lowHalves(uvec4 w) { return vec4(unpackHalf2x16(w.x).x, unpackHalf2x16(w.y).x, unpackHalf2x16(w.z).x, unpackHalf2x16(w.w).x); }
vec4 highHalves(uvec4 w) { return lowHalves(w >> 16u); }

void main() {
  uint number = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.y + gl_LocalInvocationID.y;
  if (number >= push.params.block_count) return;
  VertexBlock block = blocks.at[number];
  uint row = gl_LocalInvocationID.x;
  const uint n = uint(coefficients);
  uint words = half_float ? (n + 1u) / 2u : n, colored_words = half_float ? (3u * n + 1u) / 2u : 3u * n;
  uint at = block.transfer * words * kRow + row, colored_at = block.transfer * colored_words * kRow + row;

  Four direct = none(), indirect = none(), peak_direct = none(), peak_indirect = none();
  const uint step = half_float ? 2u : 1u;
  for (uint i = 0u; i < n; i += step) {
    vec3 light = lights.at[block.light + i], next = vec3(0.0), peak = vec3(0.0), peak_next = vec3(0.0);
    if (in_parts) peak = lights.at[push.params.first_peak + block.light + i];
    bool pair = half_float && i + 1u < n;  // the last of an odd number stands alone
    if (pair) next = lights.at[block.light + i + 1u];
    if (pair && in_parts) peak_next = lights.at[push.params.first_peak + block.light + i + 1u];
    uvec4 bits = transfer_direct.at[at + i / step * kRow];
    vec4 m = half_float ? lowHalves(bits) : uintBitsToFloat(bits);
    add(direct, light, m, m, m);
    if (in_parts) add(peak_direct, peak, m, m, m);
    if (half_float) {
      m = highHalves(bits);
      add(direct, next, m, m, m);
      if (in_parts) add(peak_direct, peak_next, m, m, m);
    }
    if (has_indirect) {
      uint w = colored_at + 3u * i / step * kRow;
      uvec4 first = transfer_indirect.at[w], second = transfer_indirect.at[w + kRow], third = uvec4(0u);
      // Of halves, a last coefficient that stands alone has two words.
      if (!half_float || pair) third = transfer_indirect.at[w + 2u * kRow];
      if (half_float) {
        vec4 r = lowHalves(first), g = highHalves(first), b = lowHalves(second);
        add(indirect, light, r, g, b);
        if (in_parts) add(peak_indirect, peak, r, g, b);
        r = highHalves(second), g = lowHalves(third), b = highHalves(third);
        add(indirect, next, r, g, b);
        if (in_parts) add(peak_indirect, peak_next, r, g, b);
      } else {
        vec4 r = uintBitsToFloat(first), g = uintBitsToFloat(second), b = uintBitsToFloat(third);
        add(indirect, light, r, g, b);
        if (in_parts) add(peak_indirect, peak, r, g, b);
      }
    }
  }
  for (int k = 0; k < int(kTogether); ++k) {
    uint vertex = row * kTogether + uint(k);
    VertexLight sum = VertexLight(of(direct, k), of(indirect, k));
    if (in_parts) sum = VertexLight(bothParts(sum.direct, of(peak_direct, k)), bothParts(sum.indirect, of(peak_indirect, k)));
    if (vertex < block.count) vertex_light.at[block.output_ + vertex] = sum;
  }
}
