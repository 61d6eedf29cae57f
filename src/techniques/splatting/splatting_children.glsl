// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which of a texel's four children show a surface. Bindings 1 and 2 of set 0.
#ifndef GLOAM_SPLATTING_CHILDREN_GLSL
#define GLOAM_SPLATTING_CHILDREN_GLSL
#include "techniques/splatting/splatting_ranges.glsl"

layout(set = 0, binding = 1) uniform usampler2D child_means;
layout(set = 0, binding = 2) uniform sampler2D depth;

bool isCoveredChild(ivec2 child, bool is_pixel) {
  ivec2 size = is_pixel ? textureSize(depth, 0) : textureSize(child_means, 0);
  if (any(greaterThanEqual(child, size))) return false;
  return is_pixel ? texelFetch(depth, child, 0).x > 0.0 : isCovered(texelFetch(child_means, child, 0));
}

#endif
