// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance that a probe sees, texel by texel of its cubes' G-buffer: the sky behind and what surfaces emit in one
// picture, what they reflect in the other. Surfaces are taken as diffuse, of albedo k_d + k_s. They are lit by the lamps
// with their shadow maps and by what a technique found at their vertices, or by all of the sky where it found nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/gbuffer.glsl"
#include "frame/lamp.glsl"
#include "frame/probe_shared.h"
#include "frame/sh_value.glsl"
#include "frame/shadow.glsl"
#define GLOAM_TRIANGLE_SET 1
#include "frame/triangle.glsl"
#include "frame/view.glsl"

const float kPi = 3.14159265;
const float kLargestHalf = 65504.0;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer ProbeViews { ProbeView at[]; } probe_views;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D diffuse;
layout(set = 0, binding = 5) uniform sampler2D specular;
layout(set = 0, binding = 6) uniform sampler2D emission;
layout(scalar, set = 0, binding = 7) readonly buffer Lamps { LightRow at[]; } lamps;
layout(scalar, set = 0, binding = 8) readonly buffer ShadowViews { ShadowView at[]; } shadow_views;
layout(set = 0, binding = 9) uniform sampler2DArray shadow_maps;
layout(scalar, set = 0, binding = 10) readonly buffer LitRows { LitRow at[]; } lit_rows;  // by instance
layout(scalar, set = 0, binding = 11) readonly buffer SurfaceLights { SurfaceLight at[]; } surface_light;
layout(scalar, set = 0, binding = 12) uniform UnlitBlock { vec3 sh[36]; } unlit;
layout(scalar, set = 0, binding = 13) readonly buffer Sky { vec3 at[]; } sky;
layout(scalar, set = 0, binding = 14) readonly buffer VertexNormals { vec3 at[]; } vertex_normals;
layout(scalar, set = 0, binding = 17) readonly buffer LightmapUvs { vec2 at[]; } lightmap_uvs;
layout(set = 0, binding = 15) uniform writeonly image2D emitted;    // A: 0 where the sky is seen
layout(set = 0, binding = 16) uniform writeonly image2D reflected;  // A: 1 where a surface is seen from behind
layout(scalar, push_constant) uniform Push { ProbeLightParams params; } push;

vec3 lightAt(uint point) {
  return max(surface_light.at[point].direct, vec3(0.0)) + max(surface_light.at[point].indirect, vec3(0.0));
}

/// Irradiance that the technique found, between three vertices or at a texel of a lightmap.
vec3 litIrradiance(LitRow row, uvec3 v, vec3 weights) {
  if (row.texel_width == 0u)
    return weights.x * lightAt(row.first + v.x) + weights.y * lightAt(row.first + v.y) + weights.z * lightAt(row.first + v.z);
  uvec3 at = row.first_uv + v;
  vec2 uv = weights.x * lightmap_uvs.at[at.x] + weights.y * lightmap_uvs.at[at.y] + weights.z * lightmap_uvs.at[at.z];
  uvec2 size = uvec2(row.texel_width, row.texel_height);
  uvec2 texel = min(uvec2(max(uv, vec2(0.0)) * vec2(size)), size - 1u);
  return lightAt(row.first + texel.y * size.x + texel.x);
}

vec3 lampsAt(vec3 position, vec3 shading, vec3 geometric) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < push.params.lamp_count; ++i) {
    LightRow lamp = lamps.at[i];
    vec3 to_light;
    vec3 irradiance = lampIrradiance(lamp, position, to_light);
    if (dot(geometric, to_light) <= 0.0) continue;
    uint face = lamp.map_count == 6u ? cubeFace(position - lamp.position) : 0u;
    float lit = 1.0;
    if (lamp.map_count > 0u) {
      uint map = lamp.first_map + face;
      lit = shadowFactor(shadow_views.at[map], shadow_maps, int(map), position, geometric);
    }
    sum += irradiance * max(dot(shading, to_light), 0.0) * lit;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(emitted)))) return;
  int size = int(push.params.size);
  ivec2 cell = pixel / size, within = pixel - cell * size;
  vec4 first = vec4(sky.at[(cell.x * size + within.y) * size + within.x], 0.0), further = vec4(0.0);
  float d = texelFetch(depth, pixel, 0).x;
  if (d > 0.0) {
    FrameView view = probe_views.at[cell.y * 6 + cell.x].view;
    Ray ray = pixelRay(view, vec2(within) + 0.5);
    vec3 position = ray.origin + ray.direction * eyeDepth(view, d);
    uvec2 packed_normals = texelFetch(normals, pixel, 0).xy;
    vec3 shading = shadingNormal(packed_normals), geometric = geometricNormal(packed_normals);
    uvec2 id = texelFetch(ids, pixel, 0).xy;
    uint instance = id.x - 1u;
    LitRow row = lit_rows.at[instance];
    uvec3 v = triangleVertices(instance, id.y);
    uint base = instances.at[instance].first_vertex;
    vec3 outside = instances.at[instance].world_from_normal *
                   (vertex_normals.at[base + v.x] + vertex_normals.at[base + v.y] + vertex_normals.at[base + v.z]);
    vec3 irradiance = vec3(0.0);
    if (row.first == kAbsent) {
      irradiance = max(shValue(6, unlit.sh, shading), vec3(0.0));
    } else {
      irradiance = litIrradiance(row, v, barycentrics(triangleCorners(instance, v), ray.origin, ray.direction));
    }
    if (row.first == kAbsent || push.params.lamps_on_lit != 0u) irradiance += lampsAt(position, shading, geometric);
    vec3 albedo = min(texelFetch(diffuse, pixel, 0).rgb + texelFetch(specular, pixel, 0).rgb, vec3(1.0));
    first = vec4(texelFetch(emission, pixel, 0).rgb, 1.0);
    further = vec4(albedo / kPi * irradiance, dot(outside, ray.direction) > 0.0 ? 1.0 : 0.0);
  }
  imageStore(emitted, pixel, min(first, vec4(kLargestHalf)));
  imageStore(reflected, pixel, min(further, vec4(kLargestHalf)));
}
