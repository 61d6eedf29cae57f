// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The first look at the leaves of one level: where they receive, and the light of the most merged lights there. What it shows of
// the light's change splits leaves after all (MS-10); what merging may have changed of it makes them ask for the next set (MS-9).
// The measure of change is that of irradiance caching (Ward, Rubinstein, Clear 1988): the texel's size on its surface over the
// mean distance of its light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/splatting/splatting_light.glsl"

/// A surface seen at a slant is longer by the inverse of this at most.
const float kLeastCosine = 0.25;

layout(constant_id = 0) const bool at_pixel = false;  // the finest level
layout(constant_id = 1) const bool children_are_pixels = false;
layout(constant_id = 2) const bool merged = true;  // else it is all the light there is

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform LightBlock { SplatLight at[kVplChunk]; } lights;
#include "techniques/splatting/splatting_children.glsl"
layout(scalar, set = 0, binding = 3) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 4) uniform usampler2D normals;
layout(set = 0, binding = 5) uniform usampler2D means;
layout(scalar, set = 0, binding = 6) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 7) buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 8) buffer Children { uint at[]; } children;
layout(scalar, set = 0, binding = 9) writeonly buffer Subsplats { Subsplat at[]; } subsplats;
layout(scalar, set = 0, binding = 10) writeonly buffer Light { vec4 at[]; } light;
layout(scalar, set = 0, binding = 11) writeonly buffer List { uint at[]; } list;
layout(scalar, push_constant) uniform Push { CoarsePush value; int set; } push;

struct Point {
  vec3 position, normal;
  float side;  // of the texel on its surface, metres
};

/// At the mean of a texel's pixels; of the finest level that is allowed, which may hold an edge, at the pixel in its middle, else
/// the first that shows a surface.
Point pointOf(ivec2 at, int level) {
  FrameView view = frame_view.view;
  vec2 place;
  float d;
  vec3 normal;
  if (at_pixel) {
    int side = 1 << level;
    ivec2 size = textureSize(depth, 0), corner = at * side, pixel = min(corner + side / 2, size - 1);
    d = texelFetch(depth, pixel, 0).x;
    for (int i = 0; d <= 0.0 && i < side * side; ++i) {
      pixel = min(corner + ivec2(i % side, i / side), size - 1);
      d = texelFetch(depth, pixel, 0).x;
    }
    place = vec2(pixel) + 0.5;
    normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  } else {
    Means mean = unpackMeans(texelFetch(means, at, 0));
    place = (vec2(at) + mean.middle) * float(1 << level);
    d = mean.depth;
    normal = mean.shading;
  }
  Ray ray = pixelRay(view, place);
  float along = eyeDepth(view, max(d, 1e-30));
  vec3 position = ray.origin + ray.direction * along;
  float cosine = max(dot(normal, directionToEye(view, position)), kLeastCosine);
  float scale = view.depth_range > 0.0 ? 1.0 : along;
  return Point(position, normal, float(1 << level) * max(length(view.step_x), length(view.step_y)) * scale / cosine);
}

void splitLeaf(uint leaf, int level) {
  uint place = leaves.at[leaf];
  ivec2 at = ivec2(place & 0xffffu, place >> 16);
  for (int i = 0; i < 4; ++i) {
    ivec2 child = 2 * at + ivec2(i & 1, i >> 1);
    if (isCoveredChild(child, children_are_pixels))
      children.at[atomicAdd(counts.value.leaves[level - 1], 1u)] = uint(child.x) | (uint(child.y) << 16);
  }
  leaves.at[leaf] = place | kSplit;
}

void main() {
  int level = push.value.level;
  uint index = uint(kEach) * (gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x);
  uint count = counts.value.leaves[level], first = counts.value.first_leaf[level];
  if (index >= count) return;
  Receivers at;
  vec4 sides;
  for (int i = 0; i < kEach; ++i) {
    uint leaf = min(index + uint(i), count - 1u), place = leaves.at[leaf] & ~kSplit;
    Point point = pointOf(ivec2(place & 0xffffu, place >> 16), level);
    at.x[i] = point.position.x;
    at.y[i] = point.position.y;
    at.z[i] = point.position.z;
    at.normal_x[i] = point.normal.x;
    at.normal_y[i] = point.normal.y;
    at.normal_z[i] = point.normal.z;
    sides[i] = point.side;
    subsplats.at[first + leaf] =
        Subsplat(point.position, uvec2(packSnorm2x16(point.normal.xy), packSnorm2x16(vec2(point.normal.z, 0.0))));
  }
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  // In halves, which drivers unroll: what is read at constant places of a block is read once for many invocations.
  for (int i = 0; i < kVplChunk / 2; ++i) addLight(sum, lights.at[i], at, vec4(1.0), true, merged);
  for (int i = 0; i < kVplChunk / 2; ++i) addLight(sum, lights.at[kVplChunk / 2 + i], at, vec4(1.0), true, merged);
  vec4 all = sum.red + sum.green + sum.blue;
  vec4 turns = sides * sides * sum.change - push.value.light_threshold * push.value.light_threshold * all;
  for (int i = 0; i < kEach; ++i) {
    uint leaf = index + uint(i);
    if (leaf >= count) break;
    light.at[first + leaf] = vec4(sum.red[i], sum.green[i], sum.blue[i], 1.0);
    if (!at_pixel && push.value.light_threshold > 0.0 && turns[i] > 0.0) splitLeaf(leaf, level);
    if (merged && (push.value.cluster_threshold <= 0.0 || sum.error[i] > push.value.cluster_threshold * all[i]))
      list.at[atomicAdd(counts.value.listed[push.set], 1u)] = first + leaf;
  }
}
