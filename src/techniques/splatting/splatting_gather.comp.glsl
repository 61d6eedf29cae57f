// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One chunk of virtual lights at every subsplat of a level (MS-5): summed in registers, not blended.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_light.glsl"
#include "techniques/splatting/splatting_shared.h"

layout(constant_id = 0) const bool first = true;  // nothing to add to yet
layout(constant_id = 1) const bool measures = false;
layout(constant_id = 2) const bool shadowed = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform VplBlock { VplRow at[kVplChunk]; } vpls;
layout(scalar, set = 0, binding = 1) readonly buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 2) readonly buffer Subsplats { Subsplat at[]; } subsplats;
layout(scalar, set = 0, binding = 3) buffer Light { vec4 at[]; } light;  // A: its change
layout(scalar, set = 0, binding = 4) readonly buffer Visible { uvec2 at[]; } visible;  // a bit a light, by leaf (MS-8)
layout(scalar, push_constant) uniform Push { int level; } push;

void addOne(inout vec4 sum, VplRow vpl, vec3 position, vec3 normal, uint bits) {
  vec4 light = vec4(0.0);
  if (measures) {
    addVplAndChange(light, vpl, position, normal);
  } else {
    vec3 plain = vec3(0.0);
    addVpl(plain, vpl, position, normal);
    light.rgb = plain;
  }
  sum += shadowed ? light * float(bits & 1u) : light;
}

void main() {
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  if (index >= counts.value.leaves[push.level]) return;
  uvec2 bits = shadowed ? visible.at[index] : uvec2(0xffffffffu);
  index += counts.value.first_leaf[push.level];
  vec3 position = subsplats.at[index].position, normal = subsplats.at[index].normal;
  vec4 sum = vec4(0.0);
  if (!first) sum = light.at[index];
  // In halves, as in splatting_full.comp.glsl.
  for (int i = 0; i < kVplChunk / 2; ++i) addOne(sum, vpls.at[i], position, normal, bits.x >> i);
  for (int i = 0; i < kVplChunk / 2; ++i) addOne(sum, vpls.at[kVplChunk / 2 + i], position, normal, bits.y >> i);
  light.at[index] = sum;
}
