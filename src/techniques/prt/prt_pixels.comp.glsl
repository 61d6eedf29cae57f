// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Interpolates the irradiance of the three vertices around each pixel, or of the four texels of its lightmap; what
// carries no transfer gets the unshadowed irradiance at its shading normal. Ringing of the light may leave negative
// sums: they count as 0.
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
layout(scalar, set = 0, binding = 3) readonly buffer OutputRows { OutputRow at[]; } output_rows;
layout(scalar, set = 0, binding = 4) readonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, set = 0, binding = 5) uniform UnbakedBlock { UnbakedRow row; } unbaked;
layout(set = 0, binding = 6) uniform writeonly image2D direct;
layout(set = 0, binding = 7) uniform writeonly image2D indirect;
layout(scalar, set = 0, binding = 8) readonly buffer LightmapUvs { vec2 at[]; } lightmap_uvs;

/// Bilinear between the four texels around a place of the lightmap; beyond its edge the last ones go on.
VertexLight lightAtTexels(OutputRow row, vec2 uv) {
  vec2 size = vec2(row.texel_width, row.texel_height);
  vec2 place = clamp(uv * size - 0.5, vec2(0.0), size - 1.0);
  uvec2 low = uvec2(place), high = min(low + 1u, uvec2(row.texel_width, row.texel_height) - 1u);
  vec2 f = place - vec2(low);
  vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  uint above = row.first + low.y * row.texel_width, below = row.first + high.y * row.texel_width;
  uint texels[4] = {above + low.x, above + high.x, below + low.x, below + high.x};
  VertexLight light = VertexLight(vec3(0.0), vec3(0.0));
  for (int k = 0; k < 4; ++k) {
    light.direct += weights[k] * vertex_light.at[texels[k]].direct;
    light.indirect += weights[k] * vertex_light.at[texels[k]].indirect;
  }
  return light;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  VertexLight light = VertexLight(vec3(0.0), vec3(0.0));
  if (isCovered(id)) {
    uint instance = id.x - 1u;
    OutputRow row = output_rows.at[instance];
    if (row.first == kUnbaked) {
      light.direct = shValue(order, unbaked.row.sh, shadingNormal(texelFetch(normals, pixel, 0).xy));
    } else {
      uvec3 v = triangleVertices(instance, id.y);
      Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
      vec3 weights = barycentrics(triangleCorners(instance, v), ray.origin, ray.direction);
      if (row.texel_width > 0u) {
        uvec3 at = row.first_uv + v;
        light = lightAtTexels(row, weights.x * lightmap_uvs.at[at.x] + weights.y * lightmap_uvs.at[at.y] +
                                       weights.z * lightmap_uvs.at[at.z]);
      } else {
        for (int k = 0; k < 3; ++k) {
          light.direct += weights[k] * vertex_light.at[row.first + v[k]].direct;
          light.indirect += weights[k] * vertex_light.at[row.first + v[k]].indirect;
        }
      }
    }
  }
  imageStore(direct, pixel, vec4(max(light.direct, vec3(0.0)), 1.0));
  imageStore(indirect, pixel, vec4(max(light.indirect, vec3(0.0)), 1.0));
}
