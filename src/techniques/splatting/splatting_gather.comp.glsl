// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One chunk of virtual lights at every subsplat that asks for their set (MS-5, MS-9): summed in registers, not blended.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_light.glsl"

layout(constant_id = 0) const bool first = true;  // nothing to add to yet
layout(constant_id = 1) const bool merged = false;
layout(constant_id = 2) const bool shadowed = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform LightBlock { SplatLight at[kVplChunk]; } lights;
layout(scalar, set = 0, binding = 1) readonly buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 2) readonly buffer Subsplats { Subsplat at[]; } subsplats;
layout(scalar, set = 0, binding = 3) readonly buffer List { uint at[]; } list;
layout(scalar, set = 0, binding = 4) buffer Light { vec4 at[]; } light;  // A: what merging may have changed
layout(scalar, set = 0, binding = 5) readonly buffer Visible { uint at[]; } visible;  // a bit a light: first words by place in the list, then second ones (MS-8)
layout(scalar, push_constant) uniform Push { int set; } push;

void main() {
  uint index = uint(kEach) * (gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x);
  uint count = counts.value.listed[push.set];
  if (index >= count) return;
  Receivers at;
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  uvec4 low = uvec4(0xffffffffu), high = uvec4(0xffffffffu);
  for (int i = 0; i < kEach; ++i) {
    uint entry = min(index + uint(i), count - 1u), subsplat = list.at[entry];
    Subsplat point = subsplats.at[subsplat];
    at.x[i] = point.position.x;
    at.y[i] = point.position.y;
    at.z[i] = point.position.z;
    at.normal_x[i] = unpackSnorm2x16(point.normal.x).x;
    at.normal_y[i] = unpackSnorm2x16(point.normal.x).y;
    at.normal_z[i] = unpackSnorm2x16(point.normal.y).x;
    if (shadowed) {
      low[i] = visible.at[entry];
      high[i] = visible.at[count + entry];
    }
    if (!first) {
      vec4 before = light.at[subsplat];
      sum.red[i] = before.r;
      sum.green[i] = before.g;
      sum.blue[i] = before.b;
      sum.error[i] = before.a;
    }
  }
  // In halves, as in splatting_coarse.comp.glsl.
  for (int i = 0; i < kVplChunk / 2; ++i)
    addLight(sum, lights.at[i], at, shadowed ? vec4((low >> i) & 1u) : vec4(1.0), false, merged);
  for (int i = 0; i < kVplChunk / 2; ++i)
    addLight(sum, lights.at[kVplChunk / 2 + i], at, shadowed ? vec4((high >> i) & 1u) : vec4(1.0), false, merged);
  for (int i = 0; i < kEach; ++i) {
    if (index + uint(i) < count) light.at[list.at[index + uint(i)]] = vec4(sum.red[i], sum.green[i], sum.blue[i], sum.error[i]);
  }
}
