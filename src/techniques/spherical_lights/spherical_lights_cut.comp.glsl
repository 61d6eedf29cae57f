// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SL-8: which spheres stand for each object before a cluster of receivers, and by how much what they send and block is to be scaled so
// that it is that of those they stand for, at the cluster's middle. A group a cluster.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_position;
layout(scalar, set = 0, binding = 1) readonly buffer Spheres { SphereRow at[]; } spheres;
layout(scalar, set = 0, binding = 2) readonly buffer Objects { ObjectRow at[]; } objects;
layout(scalar, set = 0, binding = 3) readonly buffer Levels { LevelRow at[]; } levels;
layout(scalar, set = 0, binding = 4) readonly buffer Coarse { CoarseRow at[]; } coarse;
layout(scalar, set = 0, binding = 5) readonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 6) readonly buffer Listed { uint at[]; } listed;
layout(scalar, set = 0, binding = 7) readonly buffer Sent { SentRow at[]; } sent;
layout(scalar, set = 0, binding = 8) uniform LightBlock { LightRows row; } light;
layout(scalar, set = 0, binding = 9) writeonly buffer Cuts { LevelRow at[]; } cuts;
layout(scalar, set = 0, binding = 10) writeonly buffer Ratios { vec4 at[]; } ratios;
layout(set = 0, binding = 11) uniform writeonly image2D ratio;
layout(scalar, push_constant) uniform Push { CutParams params; } push;

#include "techniques/spherical_lights/spherical_lights_blockers.glsl"
Ball ballAt(uint i) { return ballOf(spheres.at[i]); }
#include "techniques/spherical_lights/spherical_lights_within.glsl"
#include "techniques/spherical_lights/spherical_lights_radiance.glsl"

const uint kLanes = kClusterSide * kClusterSide;
const float kMostRatio = 8.0;
shared vec4 places[kLanes];
shared vec4 scaled_by[kLanes];  // sum, number

/// Light that a receiver which faces them would have of sphere i, next to what its own object's spheres leave; w: its log.
vec4 lightOf(vec3 position, vec3 normal, uint i) {
  Ball ball = ballAt(i);
  SeenSphere seen = seenSphere(position, normal, ball.center, ball.radius, ball.bulge);
  vec4 disc = discWeights(seen.sin_half_angle);
  float within = logListed(position, normal, i, ball, seen.direction, disc / max(disc.x, 1e-12));
  Sh4 f = averageAt(seen.sin_half_angle, basisAt(seen.direction));
  vec3 radiance = GLOAM_RADIANCE(sent.at[i]);
  return vec4(radiance * (irradianceOfDisc(seen, normal) * exp(min(within, 0.0))),
              logWeights(seen.sin_half_angle).x * ball.blocks);
}

/// By how much light and logs of coarse sphere c are to be scaled.
vec4 ratioOf(vec3 position, uint c) {
  uint parent = push.params.params.spheres + c;
  vec3 facing = normalize(spheres.at[parent].center - position);
  vec4 sum = vec4(0.0);
  for (uint k = 0u; k < coarse.at[c].leaves; ++k) sum += lightOf(position, facing, leaves.at[coarse.at[c].first_leaf + k]);
  vec4 own = lightOf(position, facing, parent);
  return vec4(clamp(sum.rgb / max(own.rgb, vec3(1e-12)), vec3(0.0), vec3(kMostRatio)),
              own.w < -1e-12 ? clamp(sum.w / own.w, 0.0, kMostRatio) : 1.0);
}

/// All of a level's spheres look small enough from anywhere in the cluster.
bool farEnough(LevelRow level, vec3 middle, float radius) {
  for (uint i = level.first; i < level.first + level.count; ++i) {
    float far = distance(spheres.at[i].center, middle) - radius;
    if (spheres.at[i].radius > push.params.limit * far) return false;
  }
  return true;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint cluster = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  ivec2 place = ivec2(gl_GlobalInvocationID.xy), size = textureSize(receiver_position, 0);
  vec4 own = texelFetch(receiver_position, min(place, size - 1), 0);
  places[lane] = own.w > 0.0 ? vec4(own.xyz, 1.0) : vec4(0.0);
  scaled_by[lane] = vec4(0.0);
  barrier();
  vec4 sum = vec4(0.0);
  for (uint k = 0u; k < kLanes; ++k) sum += places[k];
  vec3 middle = sum.xyz / max(sum.w, 1.0);
  float radius = 0.0;
  for (uint k = 0u; k < kLanes; ++k) radius = max(radius, places[k].w * distance(places[k].xyz, middle));
  for (uint o = lane; o < push.params.params.objects; o += kLanes) {
    LevelRow cut = LevelRow(objects.at[o].first, objects.at[o].count);
    uint first = objects.at[o].first_level, end = first + (sum.w > 0.0 ? objects.at[o].levels : 0u);
    for (uint l = first; l < end; ++l) {
      if (!farEnough(levels.at[l], middle, radius)) continue;
      cut = levels.at[l];
      for (uint i = cut.first; i < cut.first + cut.count; ++i) {
        uint c = i - push.params.params.spheres;
        vec4 by = ratioOf(middle, c);
        ratios.at[cluster * push.params.params.coarse + c] = by;
        scaled_by[lane] += vec4(by.rgb, 1.0);
      }
      break;
    }
    cuts.at[cluster * push.params.params.objects + o] = cut;
  }
  barrier();
  vec4 shown = vec4(0.0);
  for (uint k = 0u; k < kLanes; ++k) shown += scaled_by[k];
  if (all(lessThan(place, size))) imageStore(ratio, place, vec4(shown.rgb / max(shown.w, 1.0), 1.0));
}
