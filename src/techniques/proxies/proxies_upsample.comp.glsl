// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8: O_p, or irradiance with its change by the normal, and indirect irradiance brought to every pixel along surfaces; direct
// light is shaded there, at the pixel's own normal. Pixels that the four receivers around them fit badly go on a list (proxies_extend).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const bool whole_field = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;  // w: depth along the axis, 0: background
layout(set = 0, binding = 4) uniform sampler2DArray field;  // O_p, or planes: red, green, blue
layout(set = 0, binding = 5) uniform sampler2D indirect;  // A: what is left of the peak
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;
layout(scalar, set = 0, binding = 7) buffer Misfits { QuadList list; uint at[]; } misfits;
layout(set = 0, binding = 8) uniform writeonly image2D direct_full;
layout(set = 0, binding = 9) uniform writeonly image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

#include "frame/four_receivers.glsl"
#include "techniques/proxies/proxies_shade.glsl"

// Pixels between the same four receivers go through one invocation, which reads these once.
void main() {
  int divisor = int(push.divisor);
  ivec2 size = imageSize(direct_full), first = ivec2(gl_GlobalInvocationID.xy) * divisor - divisor / 2;
  if (any(greaterThanEqual(first, size))) return;
  FourReceivers four = fourReceivers(ivec2(gl_GlobalInvocationID.xy));
  vec4 s00 = texelFetch(indirect, four.p00, 0), s10 = texelFetch(indirect, four.p10, 0);
  vec4 s01 = texelFetch(indirect, four.p01, 0), s11 = texelFetch(indirect, four.p11, 0);
#define GLOAM_FIELD(layer)                                                                                  \
  mat4(texelFetch(field, ivec3(four.p00, layer), 0), texelFetch(field, ivec3(four.p10, layer), 0),                    \
       texelFetch(field, ivec3(four.p01, layer), 0), texelFetch(field, ivec3(four.p11, layer), 0))
  mat4 f0 = GLOAM_FIELD(0), f1 = GLOAM_FIELD(1), f2 = GLOAM_FIELD(2), f3 = whole_field ? GLOAM_FIELD(3) : mat4(0.0);
  uint bad = 0u;  // of a square of 2 x 2 pixels
  for (int i = 0; i < divisor * divisor; ++i) {
    ivec2 quad = quadOf(i, divisor);
    BlockPixel pixel = blockPixel(four, pixelOf(first + 2 * quad, uint(i & 3)), push.divisor, size);
    vec4 w = pixel.parts;
    float total = w.x + w.y + w.z + w.w;
    float kept = 1.0;  // of what receivers say
    if (pixel.inside && pixel.covered && total < kGoodFit) {
      bad |= 1u << (i & 3);
      kept = smoothstep(kScratchFit, kGoodFit, total);
    }
    if ((i & 3) == 3 && bad != 0u) {
      uint free = atomicAdd(misfits.list.count_and_one, 1u) - 1u;
      if (free < push.capacity) misfits.at[free] = packQuad(ivec2(gl_GlobalInvocationID.xy) * (divisor / 2) + quad, bad);
      if (free > 0u && free < push.capacity && free % kRepairGroup == 0u) atomicAdd(misfits.list.groups_x, 1u);
      bad = 0u;
    }
    w = total > 1e-20 ? w / total : vec4(0.25);
    vec4 a = f0 * w, b = f1 * w, c = f2 * w;
    vec4 sent = w.x * s00 + w.y * s10 + w.z * s01 + w.w * s11;
    vec3 lit;
    if (whole_field) {
      vec4 e = f3 * w;
      lit = litThrough(
          float[16](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, e.x, e.y, e.z, e.w), pixel.normal);
    } else {
      lit = litByPlanes(a, b, c, sent.a, pixel.normal);
    }
    float shown = pixel.covered ? 1.0 : 0.0;
    if (pixel.inside) {
      imageStore(direct_full, pixel.at, vec4(lit * shown, kept));
      imageStore(indirect_full, pixel.at, vec4(sent.rgb * shown, 1.0));
    }
  }
}
