// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-3, level 1: least and greatest linear depth and components of the geometric normal in 2 x 2 pixels, background left out; with
// them the mean position and shading normal, at which a texel receives.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"

layout(constant_id = 0) const bool by_shading_normal = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform writeonly image2D least;      // normal, depth
layout(set = 0, binding = 4) uniform writeonly image2D greatest;   // the same; depth -1: nothing there
layout(set = 0, binding = 5) uniform writeonly image2D positions;  // mean; w: pixels
layout(set = 0, binding = 6) uniform writeonly image2D shadings;   // mean

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(least)))) return;
  ivec2 size = textureSize(depth, 0);
  FrameView view = frame_view.view;
  vec4 low = vec4(2.0, 2.0, 2.0, 65504.0), high = vec4(-2.0, -2.0, -2.0, -1.0);
  vec4 position = vec4(0.0);
  vec3 shading = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * at + ivec2(i & 1, i >> 1);
    ivec2 inside = min(pixel, size - 1);
    float d = texelFetch(depth, inside, 0).x;
    uvec2 packed_normals = texelFetch(normals, inside, 0).xy;
    bool covered = d > 0.0 && inside == pixel;
    Ray ray = pixelRay(view, vec2(pixel) + 0.5);
    float along = eyeDepth(view, covered ? d : 1.0);
    vec3 shaded = shadingNormal(packed_normals);
    vec4 seen = vec4(by_shading_normal ? shaded : geometricNormal(packed_normals), min(along, 65000.0));
    low = covered ? min(low, seen) : low;
    high = covered ? max(high, seen) : high;
    position += covered ? vec4(ray.origin + ray.direction * along, 1.0) : vec4(0.0);
    shading += covered ? shaded : vec3(0.0);
  }
  float scale = 1.0 / max(position.w, 1.0);
  imageStore(least, at, low);
  imageStore(greatest, at, high);
  imageStore(positions, at, vec4(position.xyz * scale, position.w));
  imageStore(shadings, at, vec4(shading * scale, 0.0));
}
