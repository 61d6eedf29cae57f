// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Points that the camera sees, spread over the picture by the R2 sequence (Roberts 2018); where one falls on the background, it tries
// again further on in the sequence.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "visibility/visibility_shared.h"

const uint kTries = 16u;

layout(local_size_x = 32) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) writeonly buffer Seen { SightPoint at[]; } seen;

void main() {
  uint i = gl_GlobalInvocationID.x, count = uint(seen.at.length());
  if (i >= count) return;
  SightPoint point = SightPoint(vec3(0.0), 0.0, vec3(0.0), 0u);
  ivec2 size = textureSize(depth, 0);
  for (uint k = 0u; k < kTries && point.normal == vec3(0.0); ++k) {
    vec2 at = vec2(uvec2(2147483648u) + (i + k * count) * uvec2(3242174889u, 2447445414u)) / 4294967296.0;
    ivec2 pixel = min(ivec2(at * vec2(size)), size - 1);
    float d = texelFetch(depth, pixel, 0).x;
    if (d <= 0.0) continue;
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    float along = eyeDepth(frame_view.view, d);
    point.position = ray.origin + ray.direction * along;
    point.normal = geometricNormal(texelFetch(normals, pixel, 0).xy);
    point.offset = 1e-4 * along;
  }
  seen.at[i] = point;
}
