// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A volume over what is behind it: L = integral of T sigma S dt + T L_behind along the ray, from the box's near side to its far
// side or the surface, step by step: S T (1 - e^-tau), exact where both are constant over a step.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/view.glsl"

const float kLargestHalf = 65504.0;
const float kOpaque = 0.002;  // of what is behind: no longer seen

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) uniform VolumeBlock { VolumeRow row; } volume;
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler3D volume_direct;
layout(set = 0, binding = 4) uniform sampler3D volume_indirect;
layout(set = 0, binding = 5, rgba16f) uniform image2D direct;
layout(set = 0, binding = 6, rgba16f) uniform image2D indirect;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  FrameView view = frame_view.view;
  Ray ray = pixelRay(view, vec2(pixel) + 0.5);
  // In the box's own coordinates; t counts eye depths as it does in the world.
  vec3 origin = volume.row.box_from_world * vec4(ray.origin, 1.0);
  vec3 along = volume.row.box_from_world * vec4(ray.direction, 0.0);
  vec3 inverse = 1.0 / mix(along, vec3(1e-20), equal(along, vec3(0.0)));
  vec3 a = -origin * inverse, b = (1.0 - origin) * inverse;
  vec3 nearer = min(a, b), farther = max(a, b);
  float from = max(max(nearer.x, nearer.y), max(nearer.z, view.z_near));
  float to = min(farther.x, min(farther.y, farther.z));
  float d = texelFetch(depth, pixel, 0).x;
  if (d > 0.0) to = min(to, eyeDepth(view, d));
  if (!(to > from)) return;
  float unit = length(along * volume.row.side);  // length in the node of one eye depth
  float steps = clamp(ceil((to - from) * unit / volume.row.step), 1.0, 4096.0);
  float stride = (to - from) / steps, tau_of = stride * unit;
  vec3 at = origin + (from + 0.5 * stride) * along, step_of = stride * along;
  float through = 1.0;
  vec3 first = vec3(0.0), further = vec3(0.0);
  for (float i = 0.0; i < steps && through > kOpaque; i += 1.0, at += step_of) {
    vec4 here = textureLod(volume_direct, at, 0.0);
    if (here.a <= 0.0) continue;
    float next = through * exp(-here.a * tau_of);
    first += (through - next) * here.rgb;
    further += (through - next) * textureLod(volume_indirect, at, 0.0).rgb;
    through = next;
  }
  if (through == 1.0) return;
  if (through <= kOpaque) {  // what is left of the way looks like what came before
    first /= 1.0 - through;
    further /= 1.0 - through;
    through = 0.0;
  }
  vec4 behind = imageLoad(direct, pixel);
  vec3 behind_further = imageLoad(indirect, pixel).rgb;
  imageStore(direct, pixel, vec4(min(first + through * behind.rgb, vec3(kLargestHalf)), 1.0 - through * (1.0 - behind.a)));
  imageStore(indirect, pixel, vec4(min(further + through * behind_further, vec3(kLargestHalf)), 0.0));
}
