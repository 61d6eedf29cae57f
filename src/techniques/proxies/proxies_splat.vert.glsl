// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-7 as the paper has it (section 4.1): each proxy's sphere of influence drawn over the receivers that it may hold. The
// rectangle round its outline in the picture stands for the paper's tessellated sphere: exact in x and in y, all of the picture
// where the eye is within.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/proxies/proxies_shared.h"
#include "techniques/proxies/proxies_splat_push.glsl"

layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) readonly buffer Proxies { ProxyRow at[]; } proxies;

layout(location = 0) flat out uint proxy_index;

/// Where a sphere begins and ends along one axis of the picture, in pixels. x: its centre's distance from the axis of sight that
/// way, z: along it. Slopes of the tangents from the eye: (x z -+ r sqrt(x^2 + z^2 - r^2)) / (z^2 - r^2).
vec2 extent(float x, float z, float radius, vec3 step, float first, float size) {
  float pixel = length(step);
  if (frame_view.view.depth_range > 0.0) return (vec2(x - radius, x + radius) - first) / pixel;
  if (z <= radius * 1.0001) return vec2(0.0, size);
  float root = radius * sqrt(max(0.0, x * x + z * z - radius * radius));
  vec2 slopes = vec2(x * z - root, x * z + root) / (z * z - radius * radius);
  return (slopes - first) / pixel;
}

void main() {
  proxy_index = uint(gl_InstanceIndex);
  ProxyRow proxy = proxies.at[gl_InstanceIndex];
  vec2 size = vec2(push.columns, push.rows) * float(push.divisor);
  bool bounded = push.params.least_sine > 1e-4;
  float reach = bounded ? proxy.radius / push.params.least_sine : 0.0;
  vec3 d = proxy.center - frame_view.view.eye;
  float z = dot(d, frame_view.view.forward);
  vec3 u = normalize(frame_view.view.step_x), v = normalize(frame_view.view.step_y);
  vec2 across = vec2(0.0, size.x), down = vec2(0.0, size.y);
  if (bounded) {
    across = extent(dot(d, u), z, reach, frame_view.view.step_x, dot(frame_view.view.corner, u), size.x);
    down = extent(dot(d, v), z, reach, frame_view.view.step_y, dot(frame_view.view.corner, v), size.y);
  }
  bool seen = proxy.radius > 0.0 && (!bounded || z + reach > 0.0);
  // Whole receivers, each of which may stand at any pixel of its block.
  vec2 low = floor(vec2(across.x, down.x) / float(push.divisor) - 0.01);
  vec2 high = floor(vec2(across.y, down.y) / float(push.divisor) + 0.01) + 1.0;
  low = clamp(low, vec2(0.0), vec2(push.columns, push.rows));
  high = clamp(high, vec2(0.0), vec2(push.columns, push.rows));
  const vec2 kCorners[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1));
  vec2 at = mix(low, high, kCorners[gl_VertexIndex % 6]);
  gl_Position = seen ? vec4(2.0 * at / vec2(push.columns, push.rows) - 1.0, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
}
