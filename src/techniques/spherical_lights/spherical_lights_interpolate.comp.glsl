// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Each pixel's light between that of its triangle's vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#define GLOAM_TRIANGLE_SET 1
#include "frame/triangle.glsl"
#include "frame/view.glsl"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform usampler2D ids;
layout(scalar, set = 0, binding = 2) readonly buffer FirstPoints { uint at[]; } first_points;
layout(set = 0, binding = 3) uniform sampler2D vertex_direct;
layout(set = 0, binding = 4) uniform sampler2D vertex_indirect;
layout(set = 0, binding = 5) uniform writeonly image2D direct;
layout(set = 0, binding = 6) uniform writeonly image2D indirect;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  vec3 lit = vec3(0.0), sent = vec3(0.0);
  if (isCovered(id)) {
    uvec3 v = triangleVertices(id.x - 1u, id.y);
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    vec3 weights = barycentrics(triangleCorners(id.x - 1u, v), ray.origin, ray.direction);
    for (int k = 0; k < 3; ++k) {
      uint p = first_points.at[id.x - 1u] + v[k];
      ivec2 place = ivec2(p % kVertexColumns, p / kVertexColumns);
      lit += weights[k] * texelFetch(vertex_direct, place, 0).rgb;
      sent += weights[k] * texelFetch(vertex_indirect, place, 0).rgb;
    }
  }
  imageStore(direct, pixel, vec4(lit, 1.0));
  imageStore(indirect, pixel, vec4(sent, 1.0));
}
