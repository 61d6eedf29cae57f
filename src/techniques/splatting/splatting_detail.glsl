// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-7: c (a max(0, V.N) + 1 - a).
#ifndef GLOAM_SPLATTING_DETAIL_GLSL
#define GLOAM_SPLATTING_DETAIL_GLSL

layout(constant_id = 6) const float detail = 0.0;

float detailFactor(FrameView view, ivec2 pixel, uvec2 packed_normals) {
  vec3 to_eye = -normalize(pixelRay(view, vec2(pixel) + 0.5).direction);
  return detail * max(dot(shadingNormal(packed_normals), to_eye), 0.0) + 1.0 - detail;
}

#endif
