// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What receivers get: visibility, direct and indirect irradiance, how direct irradiance changes with the normal, and the
// pictures of the steps between.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const int exponential = 3;
layout(constant_id = 1) const bool normalise = true;
layout(constant_id = 2) const bool has_indirect = true;
layout(constant_id = 3) const bool by_lanes = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_normal;  // w: 0 is background
layout(set = 0, binding = 1) uniform sampler2DArray log_visibility;
layout(set = 0, binding = 2) uniform sampler2D indirect_sum;
layout(scalar, set = 0, binding = 3) uniform LightBlock { ProxyLight row; } light;
layout(set = 0, binding = 11) uniform sampler2D receiver_position;
layout(scalar, set = 0, binding = 12) readonly buffer Flats { uint at[]; } flats;  // of PatchRows
layout(scalar, set = 0, binding = 13) readonly buffer LogTable { vec4 at[]; } log_table;
layout(set = 0, binding = 4) uniform writeonly image2DArray field;
layout(set = 0, binding = 10) uniform writeonly image2DArray planes;
layout(set = 0, binding = 5) uniform writeonly image2D direct;
layout(set = 0, binding = 6) uniform writeonly image2D indirect;  // A: what is left of the peak
layout(set = 0, binding = 7) uniform writeonly image2D optical_depth;
layout(set = 0, binding = 8) uniform writeonly image2D visibility;
layout(set = 0, binding = 9) uniform writeonly image2D normalisation;
layout(scalar, push_constant) uniform Push { ShadeParams params; } push;

#include "techniques/proxies/proxies_flats.glsl"
#include "techniques/proxies/proxies_shade.glsl"

void main() {
  ivec2 here = ivec2(gl_GlobalInvocationID.xy), place = min(here, imageSize(direct) - 1);  // all lanes run
  vec4 normal = texelFetch(receiver_normal, place, 0);
  vec4 log0 = texelFetch(log_visibility, ivec3(place, 0), 0), log1 = texelFetch(log_visibility, ivec3(place, 1), 0);
  vec4 log2 = texelFetch(log_visibility, ivec3(place, 2), 0), log3 = texelFetch(log_visibility, ivec3(place, 3), 0);
  vec4 sent = has_indirect ? texelFetch(indirect_sum, place, 0) : vec4(0.0);
  float o[16];
  expOfLog(exponential, log0, log1, log2, log3, o);
  float share = overlapShare(o[0], sent.w);
  float covered = normal.w > 0.0 ? 1.0 : 0.0;
  if (push.params.flats > 0u) {
    addFlats(push.params.flats, texelFetch(receiver_position, place, 0).xyz, normal.xyz, log0, log1, log2, log3);
    expOfLog(exponential, log0, log1, log2, log3, o);
  }
  if (here != place) return;
  imageStore(field, ivec3(place, 0), vec4(o[0], o[1], o[2], o[3]));
  imageStore(field, ivec3(place, 1), vec4(o[4], o[5], o[6], o[7]));
  imageStore(field, ivec3(place, 2), vec4(o[8], o[9], o[10], o[11]));
  imageStore(field, ivec3(place, 3), vec4(o[12], o[13], o[14], o[15]));
  vec3 n = normal.xyz, t[9];
  shadeTerms(o, t);
  vec3 lit = irradianceOf(t, n);
  float peak = peakLeft(light.row.peak, o);
  vec3 peak_lit = peak * max(0.0, dot(n, light.row.peak.direction)) * light.row.peak.irradiance;
  imageStore(direct, place, vec4((max(lit, vec3(0.0)) + peak_lit) * covered, 1.0));
  // How the rest changes with the normal, to first order: E(n) = dx n.x + dy n.y + dz n.z + rest.
  const float kA = 0.488602512, kB = 1.09254843;
  vec3 dx = kA * t[3] + kB * (n.y * t[4] + n.z * t[7] + n.x * t[8]);
  vec3 dy = kA * t[1] + kB * (n.x * t[4] + n.z * t[5] - n.y * t[8]);
  vec3 dz = kA * t[2] + kB * (n.y * t[5] + n.x * t[7]) + 1.89234939 * n.z * t[6];
  vec3 rest = lit - (dx * n.x + dy * n.y + dz * n.z);
  imageStore(planes, ivec3(place, 0), vec4(dx.r, dy.r, dz.r, rest.r));
  imageStore(planes, ivec3(place, 1), vec4(dx.g, dy.g, dz.g, rest.g));
  imageStore(planes, ivec3(place, 2), vec4(dx.b, dy.b, dz.b, rest.b));
  imageStore(indirect, place, vec4(max(sent.rgb, vec3(0.0)) * (normalise ? share : 1.0) * covered, peak * covered));
  imageStore(optical_depth, place, vec4(-log0.x / kShZonal0 * covered));
  imageStore(visibility, place, vec4(o[0] / kShZonal0 * covered));
  imageStore(normalisation, place, vec4(share * covered));
}
