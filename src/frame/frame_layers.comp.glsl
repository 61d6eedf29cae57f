// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What programs read besides light (docs/images.md): normals and albedo averaged over the covered samples of
// a pixel, depth and object of the sample in its middle.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D diffuse;
layout(set = 0, binding = 5) uniform writeonly image2D normal_layer;
layout(set = 0, binding = 6) uniform writeonly image2D depth_layer;
layout(set = 0, binding = 7) uniform writeonly image2D albedo_layer;
layout(set = 0, binding = 8) uniform writeonly uimage2D object_layer;
layout(scalar, push_constant) uniform Push { uint supersample; } push;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(normal_layer)))) return;
  int side = int(push.supersample);
  vec3 normal = vec3(0.0), albedo = vec3(0.0);
  float covered = 0.0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      ivec2 at = pixel * side + ivec2(x, y);
      if (texelFetch(depth, at, 0).x <= 0.0) continue;
      covered += 1.0;
      normal += shadingNormal(texelFetch(normals, at, 0).xy);
      albedo += texelFetch(diffuse, at, 0).rgb;
    }
  }
  float len = length(normal);
  ivec2 middle = pixel * side + side / 2;
  float d = texelFetch(depth, middle, 0).x;
  imageStore(normal_layer, pixel, vec4(len > 0.0 ? normal / len : vec3(0.0), 1.0));
  imageStore(albedo_layer, pixel, vec4(albedo / max(covered, 1.0), 1.0));
  imageStore(depth_layer, pixel, vec4(d > 0.0 ? eyeDepth(frame_view.view, d) : 0.0));
  imageStore(object_layer, pixel, uvec4(texelFetch(ids, middle, 0).x));
}
