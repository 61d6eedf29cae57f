// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One receiver a block of pixels: the pixel in the middle, else the first that shows a surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform writeonly image2D receiver_position;
layout(set = 0, binding = 4) uniform writeonly image2D receiver_normal;
layout(scalar, push_constant) uniform Push { uint divisor; } push;

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(place, imageSize(receiver_position)))) return;
  int divisor = int(push.divisor);
  ivec2 size = textureSize(depth, 0);
  ivec2 first = place * divisor;
  ivec2 pixel = min(first + divisor / 2, size - 1);
  float d = texelFetch(depth, pixel, 0).x;
  for (int i = 0; d <= 0.0 && i < divisor * divisor; ++i) {
    pixel = min(first + ivec2(i % divisor, i / divisor), size - 1);
    d = texelFetch(depth, pixel, 0).x;
  }
  vec4 position = vec4(0.0), normal = vec4(0.0);
  if (d > 0.0) {
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    float along = eyeDepth(frame_view.view, d);
    position = vec4(ray.origin + ray.direction * along, 1.0);
    normal = vec4(shadingNormal(texelFetch(normals, pixel, 0).xy), along);
  }
  imageStore(receiver_position, place, position);
  imageStore(receiver_normal, place, normal);
}
