// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The surface as all techniques see it: ids, normals, material. Textures are bound a draw.
//
// One rule for sides, the path tracer's too: every surface is seen from both sides. The geometric normal
// faces the eye; where the interpolated normal lies on the other side of the surface, the shading normal (its
// normal map applied) is turned round.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "math/brdf.glsl"

layout(constant_id = 0) const bool textured = true;
layout(constant_id = 1) const bool alpha_mask = false;
layout(constant_id = 2) const bool vertex_colors = false;

layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 1, binding = 0) uniform sampler2D base_color_map;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_map;
layout(set = 1, binding = 2) uniform sampler2D normal_map;
layout(set = 1, binding = 3) uniform sampler2D emission_map;
layout(scalar, set = 1, binding = 4) uniform MaterialBlock { MaterialRow row; } material;

layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uv_base_color_and_roughness;
layout(location = 4) in vec4 uv_normal_and_emission;
layout(location = 5) in vec4 color;
layout(location = 6) flat in uint instance_row;

layout(location = 0) out uvec2 ids;
layout(location = 1) out uvec2 normals;
layout(location = 2) out vec4 diffuse;   // k_d, roughness
layout(location = 3) out vec4 specular;  // k_s
layout(location = 4) out vec4 emission;

vec3 faceNormal(vec3 fallback) {
  vec3 n = cross(dFdx(from_eye), dFdy(from_eye));
  float squared = dot(n, n);
  n = squared > 1e-30 ? n * inversesqrt(squared) : fallback;
  vec3 away = frame_view.view.depth_range > 0.0 ? frame_view.view.forward : from_eye;
  return dot(n, away) > 0.0 ? -n : n;
}

/// Normal in tangent space from a map's texel, scaled as glTF says.
vec3 mappedNormal(vec3 n, vec3 texel, float scale) {
  vec3 along = tangent.xyz - n * dot(n, tangent.xyz);
  float squared = dot(along, along);
  if (squared < 1e-12) return n;  // no texture coordinates: no direction to tilt into
  vec3 t = along * inversesqrt(squared);
  vec3 b = cross(n, t) * (tangent.w < 0.0 ? -1.0 : 1.0);
  vec3 m = (texel * 2.0 - 1.0) * vec3(scale, scale, 1.0);
  return normalize(m.x * t + m.y * b + m.z * n);
}

void main() {
  vec4 base = material.row.base_color;
  if (vertex_colors) base *= color;
  float roughness = material.row.roughness, metallic = material.row.metallic;
  vec3 glow = material.row.emission;
  vec3 smooth_normal = normalize(normal);
  vec3 shading = smooth_normal;
  if (textured) {
    base *= texture(base_color_map, uv_base_color_and_roughness.xy);
    vec2 factors = texture(metallic_roughness_map, uv_base_color_and_roughness.zw).gb;
    roughness *= factors.x;
    metallic *= factors.y;
    glow *= texture(emission_map, uv_normal_and_emission.zw).rgb;
    vec3 texel = texture(normal_map, uv_normal_and_emission.xy).xyz;
    if ((material.row.flags & kMaterialNormalMap) != 0u)
      shading = mappedNormal(smooth_normal, texel, material.row.normal_scale);
  }
  vec3 geometric = faceNormal(smooth_normal);
  if (alpha_mask && base.a < material.row.alpha_cutoff) discard;

  if (dot(smooth_normal, geometric) < 0.0) shading = -shading;
  roughness = clamp(roughness, 0.0, 1.0);
  Lobes lobes = makeLobes(base.rgb, clamp(metallic, 0.0, 1.0), roughness, material.row.specular);
  ids = uvec2(instance_row + 1u, gl_PrimitiveID);
  normals = uvec2(packNormal(shading), packNormal(geometric));
  diffuse = vec4(lobes.diffuse, roughness);
  specular = vec4(lobes.specular, 0.0);
  emission = vec4(min(glow, vec3(65504.0)), 0.0);
}
