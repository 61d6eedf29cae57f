// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One point and 32 lights of its set: a word of bits. Neighbours ask for the same light at once, so that their rays go alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "visibility/device_shared.h"
#include "visibility/visibility_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Points { SightPoint at[]; } points;
layout(scalar, set = 0, binding = 1) readonly buffer Lights { uint at[]; } lights;
layout(scalar, set = 0, binding = 2) readonly buffer Sets { SightSet at[]; } sets;
layout(scalar, set = 0, binding = 3) readonly buffer Nodes { BoxNode at[]; } nodes;
layout(scalar, set = 0, binding = 4) readonly buffer Triangles { BoxTriangle at[]; } triangles;
layout(scalar, set = 0, binding = 5) writeonly buffer Visible { uint at[]; } visible;
layout(scalar, push_constant) uniform Push { SightParams params; } push;

#include "visibility/box_tree.glsl"

vec3 vectorAt(uint word) {
  return vec3(uintBitsToFloat(lights.at[word]), uintBitsToFloat(lights.at[word + 1u]), uintBitsToFloat(lights.at[word + 2u]));
}

SightEnd endAt(uint light) {
  uint word = light * push.params.light_stride;
  return SightEnd(vectorAt(word), lights.at[word + 3u], vectorAt(word + 4u), uintBitsToFloat(lights.at[word + 7u]));
}

bool sees(SightPoint point, SightEnd end) {
  vec3 origin = point.position + point.offset * point.normal;
  bool surface = end.kind == kSightSurface || end.kind == kSightBothSides, far = end.kind == kSightDirectional;
  vec3 between = end.position - (far ? vec3(0.0) : origin);
  float facing = surface ? dot(end.normal, between) : -1.0;
  if (end.kind >= kSightNothing || dot(point.normal, between) <= 0.0) return false;
  if (end.kind == kSightSurface && facing >= 0.0) return false;
  float side = surface ? (facing > 0.0 ? -end.offset : end.offset) : 0.0;
  between += side * end.normal;
  float distance = length(between);
  return distance > 0.0 && !occluded(origin, between / distance, far ? 1e30 : max(distance - abs(side), 0.0));
}

void main() {
  uint p = gl_GlobalInvocationID.y * push.params.row + gl_GlobalInvocationID.x, word = gl_GlobalInvocationID.z;
  if (gl_GlobalInvocationID.x >= push.params.row || p >= push.params.point_count) return;
  SightPoint point = points.at[p];
  uint bits = 0u;
  if (point.set < push.params.set_count && point.normal != vec3(0.0)) {
    SightSet set = sets.at[point.set];
    uint end = min(set.count, word * 32u + 32u);
    for (uint k = word * 32u; k < end; ++k) {
      if (sees(point, endAt(set.first + k))) bits |= 1u << (k & 31u);
    }
  }
  visible.at[word * push.params.point_count + p] = bits;
}
