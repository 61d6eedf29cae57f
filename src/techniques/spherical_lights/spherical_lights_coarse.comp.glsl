// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SL-8: what a sphere that stands for several sends: their mean by area, direction by direction. A group a sphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 16) in;
layout(scalar, set = 0, binding = 0) readonly buffer Spheres { SphereRow at[]; } spheres;
layout(scalar, set = 0, binding = 1) readonly buffer Coarse { CoarseRow at[]; } coarse;
layout(scalar, set = 0, binding = 2) readonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 3) buffer Sent { SentRow at[]; } sent;
layout(scalar, push_constant) uniform Push { uint spheres; } push;

void main() {
  uint s = gl_WorkGroupID.x, i = gl_LocalInvocationID.x;
  vec3 sum = vec3(0.0);
  float areas = 1e-30;
  for (uint k = 0u; k < coarse.at[s].leaves; ++k) {
    uint leaf = leaves.at[coarse.at[s].first_leaf + k];
    float area = spheres.at[leaf].radius * spheres.at[leaf].radius;
    sum += area * sent.at[leaf].at[i];
    areas += area;
  }
  sent.at[push.spheres + s].at[i] = sum / areas;
}
