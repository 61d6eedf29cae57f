// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where the point that a pixel shows was in the last frame. Rigid things: through the two matrices; deformed
// ones: through the same barycentric coordinates of the last pose.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#define GLOAM_TRIANGLE_SET 1
#include "frame/triangle.glsl"
#include "frame/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform usampler2D ids;
layout(set = 0, binding = 2) uniform writeonly image2D motion;

vec2 pixelFromClip(vec4 clip) {
  return (clip.xy / clip.w * 0.5 + 0.5) * vec2(frame_view.view.width, frame_view.view.height);
}

vec3 previousPosition(uint instance, vec3 weights, uvec3 vertices) {
  uint first = instances.at[instance].previous_first_vertex;
  vec3 object = weights.x * positions.at[first + vertices.x] + weights.y * positions.at[first + vertices.y] +
                weights.z * positions.at[first + vertices.z];
  return instances.at[instance].previous_world_from_object * vec4(object, 1.0);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(motion)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  vec2 moved = vec2(0.0);
  if (isCovered(id)) {
    FrameView view = frame_view.view;
    uint instance = id.x - 1u;
    uvec3 vertices = triangleVertices(instance, id.y);
    mat3 corners = triangleCorners(instance, vertices);
    Ray ray = pixelRay(view, vec2(pixel) + 0.5);
    vec3 weights = barycentrics(corners, ray.origin, ray.direction);
    vec4 now = view.clip_from_world * vec4(corners * weights, 1.0);
    vec4 before = view.previous_clip_from_world * vec4(previousPosition(instance, weights, vertices), 1.0);
    if (before.w > 0.0) moved = pixelFromClip(now) - pixelFromClip(before);
  }
  imageStore(motion, pixel, vec4(moved, 0.0, 0.0));
}
