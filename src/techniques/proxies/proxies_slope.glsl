// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Moving least squares over receivers: the value at a place of the plane that fits theirs best, and how far it is to be trusted.
#ifndef GLOAM_PROXIES_SLOPE_GLSL
#define GLOAM_PROXIES_SLOPE_GLSL

/// Of squared receivers: what keeps the slope at 0 across receivers that stand in a line.
const float kStiffness = 0.03;
/// What is trusted, and what no longer: the offset of the receivers' weighted middle (in receivers); the sum of weights without
/// their signs, by which errors are enlarged; distance of values from their plane, relative to the value read; and, from the second
/// to the first, weights of what fits.
const vec2 kOffset = vec2(0.05, 0.2), kEnlarged = vec2(1.5, 2.2), kBent = vec2(0.006, 0.018), kWeight = vec2(0.8, 0.4);

/// Receiver i counts by w_i (c.x + c.y x_i + c.z y_i), of which the sum is 1 and those times x_i, y_i are 0, but for the stiffness.
struct Slope {
  vec3 c;
  mat3 solve;
};
/// Sums of w, w x, and w (x x, x y, y y).
Slope slopeOf(float s, vec2 x1, vec3 xx) {
  float stiff = kStiffness * s + 1e-12, p = xx.x + stiff, q = xx.z + stiff, r = xx.y;
  vec3 c = vec3(p * q - r * r, r * x1.y - q * x1.x, r * x1.x - p * x1.y);
  float inverse = 1.0 / max(s * c.x + x1.x * c.y + x1.y * c.z, 1e-20);
  mat3 solve = inverse * mat3(c, vec3(c.y, s * q - x1.y * x1.y, x1.x * x1.y - s * r),
                              vec3(c.z, x1.x * x1.y - s * r, s * p - x1.x * x1.x));
  return Slope(c * inverse, solve);
}

/// 0 to 1. bent: what values leave over of their plane.
float trusted(float s, vec2 offset, float enlarged, float bent) {
  return smoothstep(kWeight.y, kWeight.x, s) * (1.0 - smoothstep(kOffset.x, kOffset.y, length(offset))) *
         (1.0 - smoothstep(kEnlarged.x, kEnlarged.y, enlarged)) * (1.0 - smoothstep(kBent.x, kBent.y, bent));
}

#endif
