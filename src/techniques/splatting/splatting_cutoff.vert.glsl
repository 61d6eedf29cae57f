// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The rectangle of the picture within which a virtual light is seen to reach: all round a sphere about it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "vpls/vpls_shared.h"

layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) readonly buffer Vpls { VplRow at[]; } vpls;
layout(scalar, push_constant) uniform Push { float radius; } push;

layout(location = 0) flat out uint vpl_index;

/// Where a sphere begins and ends along one axis of the picture, in pixels. x: its centre's distance from the axis of sight that
/// way, z: along it. Slopes of the tangents from the eye: (x z -+ r sqrt(x^2 + z^2 - r^2)) / (z^2 - r^2).
vec2 extent(float x, float z, float radius, vec3 step, float first, float size) {
  float pixel = length(step);
  if (frame_view.view.depth_range > 0.0) return (vec2(x - radius, x + radius) - first) / pixel;
  if (z <= radius * 1.0001) return vec2(0.0, size);
  float root = radius * sqrt(max(0.0, x * x + z * z - radius * radius));
  return (vec2(x * z - root, x * z + root) / (z * z - radius * radius) - first) / pixel;
}

void main() {
  vpl_index = uint(gl_InstanceIndex);
  VplRow vpl = vpls.at[gl_InstanceIndex];
  FrameView view = frame_view.view;
  vec2 size = vec2(view.width, view.height);
  vec3 d = vpl.position - view.eye;
  float z = dot(d, view.forward);
  vec3 u = normalize(view.step_x), v = normalize(view.step_y);
  vec2 across = extent(dot(d, u), z, push.radius, view.step_x, dot(view.corner, u), size.x);
  vec2 down = extent(dot(d, v), z, push.radius, view.step_y, dot(view.corner, v), size.y);
  bool sends = vpl.intensity.r + vpl.intensity.g + vpl.intensity.b > 0.0 && z + push.radius > 0.0;
  vec2 low = clamp(floor(vec2(across.x, down.x)), vec2(0.0), size), high = clamp(ceil(vec2(across.y, down.y)), vec2(0.0), size);
  const vec2 kCorners[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1));
  vec2 at = mix(low, high, kCorners[gl_VertexIndex % 6]);
  gl_Position = sends ? vec4(2.0 * at / size - 1.0, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
}
