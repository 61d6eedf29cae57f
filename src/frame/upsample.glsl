// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8 (Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007): how well a coarse receiver stands for a pixel, by which bilinear
// weights are multiplied: max(0, N_p.N_i)^32 / (eps + |z_p - z_i|).
#ifndef GLOAM_FRAME_UPSAMPLE_GLSL
#define GLOAM_FRAME_UPSAMPLE_GLSL

/// Relative to the pixel's own depth: differences below it count alike.
const float kDepthTolerance = 2e-3;
/// Sums of weights below this mean that no receiver fits.
const float kPoorFit = 0.05;
const float kLeastBilinear = 1e-3;

/// 0 to 1. `receiver`: normal and depth along the axis, 0 for background.
float receiverFitness(vec4 receiver, vec3 normal, float along) {
  if (receiver.w <= 0.0) return 0.0;
  float epsilon = kDepthTolerance * along;
  float c = max(0.0, dot(normal, receiver.xyz));
  float c2 = c * c, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8;
  return c16 * c16 * epsilon / (epsilon + abs(along - receiver.w));
}

/// Where a pixel lies among receivers, which stand at the middle pixels of their blocks (frame_receivers).
vec2 receiverPlace(ivec2 pixel, uint divisor) {
  return (vec2(pixel) - float(divisor / 2u)) / float(divisor);
}

#endif
