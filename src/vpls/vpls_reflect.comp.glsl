// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One texel of a reflective shadow map (MS-1). Its flux: the lamp's power through the texel's solid angle (some points of it
// ask for the cone), times albedo, times what the shading normal makes of the surface's own cosine.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/lamp.glsl"
#include "frame/view.glsl"
#include "vpls/vpls_shared.h"

/// Least cosine to the surface: what a texel at grazing incidence covers stays bounded.
const float kLeastCosine = 0.02;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) uniform LightBlock { LightRow row; } light;
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D diffuse;
layout(set = 0, binding = 5) uniform sampler2D specular;
layout(set = 0, binding = 6) uniform writeonly image2D position_map;
layout(set = 0, binding = 7) uniform writeonly image2D normal_map;
layout(set = 0, binding = 8) uniform writeonly image2D flux_map;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

/// (solid angle of a texel, the same times the cone's factor).
vec2 texelSolidAngles(FrameView view, vec2 texel) {
  int points = push.place.size < 128 ? 4 : 2;  // a side
  float area = length(view.step_x) * length(view.step_y) / float(points * points);
  vec2 sum = vec2(0.0);
  for (int i = 0; i < points * points; ++i) {
    vec2 at = texel + (vec2(i % points, i / points) + 0.5) / float(points);
    vec3 way = pixelRay(view, at).direction;
    float squared = dot(way, way);
    float solid_angle = area / (squared * sqrt(squared));
    float cosine = dot(way, light.row.direction) * inversesqrt(squared);
    float cone = light.row.kind == kLightSpot ? coneFactor(cosine, light.row.cos_inner, light.row.cos_outer) : 1.0;
    sum += solid_angle * vec2(1.0, cone);
  }
  return sum;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(push.place.size)))) return;
  ivec2 at = push.place.corner + texel;
  vec4 position = vec4(0.0), normal = vec4(0.0), flux = vec4(0.0);
  float d = texelFetch(depth, at, 0).x;
  if (d > 0.0) {
    FrameView view = frame_view.view;
    Ray ray = pixelRay(view, vec2(texel) + 0.5);
    position.xyz = ray.origin + ray.direction * eyeDepth(view, d);
    uvec2 packed_normals = texelFetch(normals, at, 0).xy;
    vec3 geometric = geometricNormal(packed_normals);
    vec3 to_light = -light.row.direction;
    float distance = eyeDepth(view, d);
    float across = length(view.step_x) * length(view.step_y);  // square metres that face the lamp
    vec3 power = light.row.intensity * across;
    if (light.row.kind != kLightDirectional) {
      vec3 between = light.row.position - position.xyz;
      distance = sqrt(max(dot(between, between), kLeastSquaredDistance));
      to_light = between / distance;
      vec2 angles = texelSolidAngles(view, vec2(texel));
      across = angles.x * distance * distance;
      power = light.row.intensity * (angles.y * rangeFactor(distance, light.row.range));
    }
    float cosine = max(dot(geometric, to_light), kLeastCosine);
    float shaded = max(dot(shadingNormal(packed_normals), to_light), 0.0) / cosine;
    vec3 albedo = min(texelFetch(diffuse, at, 0).rgb + texelFetch(specular, at, 0).rgb, vec3(1.0));
    position.w = across / cosine;
    normal = vec4(geometric, distance);
    flux.rgb = power * albedo * shaded;
  }
  imageStore(position_map, at, position);
  imageStore(normal_map, at, normal);
  imageStore(flux_map, at, flux);
}
