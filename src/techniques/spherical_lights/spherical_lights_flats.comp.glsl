// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What each rectangle of ground and walls sends: the mean of its samples, in its colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Arriving { vec3 at[]; } arriving;
layout(scalar, set = 0, binding = 1) readonly buffer SendingPatches { PatchRow at[]; } sending_patches;
layout(scalar, set = 0, binding = 2) writeonly buffer PatchRadiance { vec3 at[]; } patch_radiance;
layout(scalar, push_constant) uniform Push { FlatParams params; } push;

void main() {
  uint j = gl_GlobalInvocationID.x;
  if (j >= push.params.patches) return;
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < kPatchPoints; ++k) sum += arriving.at[push.params.first_point + j * kPatchPoints + k];
  patch_radiance.at[j] = sum / float(kPatchPoints) * sending_patches.at[j].albedo;
}
