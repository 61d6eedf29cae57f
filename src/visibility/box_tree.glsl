// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The functions of visibility/box_tree.cpp. Needs the buffers `nodes` and `triangles`.
#ifndef GLOAM_VISIBILITY_BOX_TREE_GLSL
#define GLOAM_VISIBILITY_BOX_TREE_GLSL
#include "visibility/device_shared.h"

bool meetsBox(vec3 low, vec3 high, vec3 origin, vec3 inverse, float t_far) {
  vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
  vec3 near = min(a, b), far = max(a, b);
  float enter = max(max(near.x, near.y), max(near.z, 0.0));
  float leave = min(min(far.x, far.y), min(far.z, t_far));
  return enter <= leave * 1.0000005;
}

bool meetsTriangle(BoxTriangle t, vec3 origin, vec3 direction, float t_far) {
  vec3 p = cross(direction, t.edge_v);
  float determinant = dot(t.edge_u, p);
  if (determinant == 0.0) return false;
  vec3 from = origin - t.corner;
  float u = dot(from, p) / determinant;
  vec3 q = cross(from, t.edge_u);
  float v = dot(direction, q) / determinant;
  float distance = dot(t.edge_v, q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance <= t_far;
}

/// Whether anything stands on the ray, nearer than t_far.
bool occluded(vec3 origin, vec3 direction, float t_far) {
  vec3 inverse = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
  uint stack[kBoxStack];
  int top = 0;
  uint place = 0u;
  for (;;) {
    for (int i = 0; i < 4; ++i) {
      uint child = nodes.at[place].child[i];
      if (child == 0u || !meetsBox(nodes.at[place].low[i], nodes.at[place].high[i], origin, inverse, t_far)) continue;
      if ((child & kBoxLeaf) == 0u) {
        stack[top++] = child;
        continue;
      }
      uint first = (child & ~kBoxLeaf) >> 2;
      for (uint t = first; t <= first + (child & 3u); ++t) {
        if (meetsTriangle(triangles.at[t], origin, direction, t_far)) return true;
      }
    }
    if (top == 0) return false;
    place = stack[--top];
  }
}

#endif
