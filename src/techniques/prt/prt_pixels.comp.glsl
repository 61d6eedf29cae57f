// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Interpolates the irradiance of the three vertices around each pixel; what carries no transfer gets the
// unshadowed irradiance at its shading normal. Ringing of the light may leave negative sums: they count as 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/sh_value.glsl"
#define GLOAM_TRIANGLE_SET 1
#include "frame/triangle.glsl"
#include "frame/view.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int order = 5;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform usampler2D ids;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) readonly buffer FirstOutputs { uint at[]; } first_outputs;
layout(scalar, set = 0, binding = 4) readonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, set = 0, binding = 5) uniform UnbakedBlock { UnbakedRow row; } unbaked;
layout(set = 0, binding = 6) uniform writeonly image2D direct;
layout(set = 0, binding = 7) uniform writeonly image2D indirect;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  VertexLight light = VertexLight(vec3(0.0), vec3(0.0));
  if (isCovered(id)) {
    uint instance = id.x - 1u;
    uint first = first_outputs.at[instance];
    if (first == kUnbaked) {
      light.direct = shValue(order, unbaked.row.sh, shadingNormal(texelFetch(normals, pixel, 0).xy));
    } else {
      uvec3 v = triangleVertices(instance, id.y);
      Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
      vec3 weights = barycentrics(triangleCorners(instance, v), ray.origin, ray.direction);
      for (int k = 0; k < 3; ++k) {
        light.direct += weights[k] * vertex_light.at[first + v[k]].direct;
        light.indirect += weights[k] * vertex_light.at[first + v[k]].indirect;
      }
    }
  }
  imageStore(direct, pixel, vec4(max(light.direct, vec3(0.0)), 1.0));
  imageStore(indirect, pixel, vec4(max(light.indirect, vec3(0.0)), 1.0));
}
