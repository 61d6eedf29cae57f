// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A probe's light in someone's axes: its faces together, what its picture leaves out of the sky as far as the sky is seen,
// and the lamps, each a direction (KHR_lights_punctual) that counts where no surface stands before it in the cube. A work
// group is a job, a lane a coefficient.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/probe_shared.h"
#include "frame/shadow.glsl"

layout(local_size_x = 40) in;
layout(scalar, set = 0, binding = 0) readonly buffer Jobs { ProbeJob at[]; } jobs;
layout(scalar, set = 0, binding = 1) readonly buffer Sums { ProbeSums at[]; } sums;
layout(scalar, set = 0, binding = 2) readonly buffer Turns { float at[]; } turns;  // [turn][row][column of its band, of 11]
layout(scalar, set = 0, binding = 3) readonly buffer Sky { ProbeSky row; } sky;
layout(scalar, set = 0, binding = 4) readonly buffer Lamps { ProbeLamp at[]; } lamps;  // [probe][lamp]
layout(scalar, set = 0, binding = 5) readonly buffer ProbeViews { ProbeView at[]; } probe_views;
layout(set = 0, binding = 6) uniform sampler2D depth;
layout(scalar, set = 0, binding = 7) writeonly buffer Lights { ProbeLight at[]; } lights;  // [job][coefficient]
layout(scalar, set = 0, binding = 8) writeonly buffer Trust { float at[]; } trust;         // [probe]
layout(scalar, set = 0, binding = 9) writeonly buffer LampLights { vec3 at[]; } lamp_lights;   // [job][coefficient]
layout(scalar, set = 0, binding = 10) writeonly buffer LampsSeen { float at[]; } lamps_seen;  // [probe][lamp]
layout(scalar, push_constant) uniform Push { ProbeGatherParams params; } push;

struct World {
  vec3 direct, reflected, lamps;
};
shared World world[40];

/// Place on a face (sh::cubeDirection), -1 to 1, from the direction over its greatest part.
vec2 facePlace(uint face, vec3 d) {
  if (face == 0u) return vec2(-d.z, -d.y);
  if (face == 1u) return vec2(d.z, -d.y);
  if (face == 2u) return vec2(d.x, d.z);
  if (face == 3u) return vec2(d.x, -d.z);
  return vec2(face == 4u ? d.x : -d.x, -d.y);
}

/// 1: nothing stands before the lamp. Four texels around its direction, bilinear.
float lampVisibility(uint probe, vec3 direction, float distance) {
  vec3 a = abs(direction);
  float greatest = max(a.x, max(a.y, a.z));
  uint face = cubeFace(direction);
  int size = int(push.params.size);
  vec2 place = (facePlace(face, direction / greatest) * 0.5 + 0.5) * float(size) - 0.5;
  vec2 base = floor(place), f = place - base;
  float z_near = probe_views.at[probe * 6u].view.z_near;
  // Reversed depth of the lamp along the face's axis; what is nearer is greater. Lamps sit in fittings: 2 % of slack.
  float own = distance > 0.0 ? z_near / (0.98 * distance * greatest) : 1e-12;
  float seen = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec2 texel = clamp(ivec2(base) + corner, ivec2(0), ivec2(size - 1)) + ivec2(face, probe) * size;
    vec2 w = mix(1.0 - f, f, vec2(corner));
    seen += texelFetch(depth, texel, 0).x > own ? 0.0 : w.x * w.y;
  }
  return seen;
}

void main() {
  uint job = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
  uint probe = jobs.at[job].probe, first = probe * 6u * kProbeStride;
  vec3 emitted = vec3(0.0), reflected = vec3(0.0), shares = vec3(0.0), lamp_light = vec3(0.0);
  for (uint face = 0u; face < 6u; ++face) {
    ProbeSums part = sums.at[first + face * kProbeStride + min(lane, kProbeSolidAngle - 1u)];
    emitted += part.emitted;
    reflected += part.reflected;
    shares += sums.at[first + face * kProbeStride + kProbeSolidAngle].emitted;
  }
  uint i = min(lane, push.params.coefficients - 1u);
  if (sky.row.luminance > 0.0) emitted += shares.x / sky.row.luminance * sky.row.remainder[i];
  for (uint k = 0u; k < push.params.lamp_count; ++k) {
    uint n = probe * push.params.lamp_count + k;
    vec3 irradiance = lamps.at[n].irradiance;
    float seen = lampVisibility(probe, lamps.at[n].direction, lamps.at[n].distance);
    if (lane == 0u) lamps_seen.at[n] = seen;
    lamp_light += seen * lamps.at[n].basis[i] * irradiance;
  }
  world[lane] = World(emitted, reflected, lamp_light);
  barrier();
  if (lane == 0u) trust.at[probe] = 1.0 - smoothstep(kProbeSomeBacks, kProbeMostBacks, shares.y / (4.0 * 3.14159265));
  if (lane >= push.params.coefficients) return;
  uint band = uint(sqrt(float(lane) + 0.5));
  World turned = World(vec3(0.0), vec3(0.0), vec3(0.0));
  for (uint k = 0u; k < 2u * band + 1u; ++k) {
    float m = push.params.band[band] * turns.at[(jobs.at[job].turn * 36u + lane) * 11u + k];
    World from = world[band * band + k];
    turned.direct += m * from.direct;
    turned.reflected += m * from.reflected;
    turned.lamps += m * from.lamps;
  }
  lights.at[job * push.params.coefficients + lane] = ProbeLight(turned.direct, turned.reflected);
  lamp_lights.at[job * push.params.coefficients + lane] = turned.lamps;
}
