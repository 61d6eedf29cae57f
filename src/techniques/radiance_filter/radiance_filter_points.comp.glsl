// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where each pixel's rays begin, points of one set together (RF-2). Rays leave the geometric surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/radiance_filter/radiance_filter_interleaving.glsl"
#include "visibility/visibility_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) writeonly buffer Points { SightPoint at[]; } points;
layout(scalar, push_constant) uniform Push { Interleaving interleaving; } push;

void main() {
  if (isBeyondTile(push.interleaving, gl_GlobalInvocationID)) return;
  uint index = pointIndex(push.interleaving, gl_GlobalInvocationID);
  ivec2 pixel = pixelOfPoint(push.interleaving, gl_GlobalInvocationID);
  SightPoint point = SightPoint(vec3(0.0), 0.0, vec3(0.0), setOfPoint(push.interleaving, gl_GlobalInvocationID));
  float d = isInPicture(push.interleaving, pixel) ? texelFetch(depth, pixel, 0).x : 0.0;
  if (d > 0.0) {
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    float along = eyeDepth(frame_view.view, d);
    point.position = ray.origin + ray.direction * along;
    point.normal = geometricNormal(texelFetch(normals, pixel, 0).xy);
    point.offset = push.interleaving.offset + 1e-4 * along;
  }
  points.at[index] = point;
}
