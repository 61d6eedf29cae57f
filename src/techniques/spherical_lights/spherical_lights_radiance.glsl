// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SL-4: radiance of a sphere, averaged over what of it a receiver sees.
#ifndef GLOAM_SPHERICAL_LIGHTS_RADIANCE_GLSL
#define GLOAM_SPHERICAL_LIGHTS_RADIANCE_GLSL

struct Gathered {
  vec3 direct, indirect, unblocked;  // direct: with what glows by itself
  float visibility;                  // mean of what all spheres leave
};

/// The basis from the sphere to the receiver, bands by their weights; y: the basis the other way.
Sh4 averageAt(float sin_half_angle, Sh4 y) {
  return scaled(y, averageWeights(sin_half_angle) * vec4(1.0, -1.0, 1.0, -1.0));
}
#define GLOAM_TERMS(row, v, j) \
  (f.v.x * row.at[j] + f.v.y * row.at[j + 1] + f.v.z * row.at[j + 2] + f.v.w * row.at[j + 3])
/// Of a SentRow, where f is that basis.
#define GLOAM_RADIANCE(row) \
  max(GLOAM_TERMS(row, a, 0) + GLOAM_TERMS(row, b, 4) + GLOAM_TERMS(row, c, 8) + GLOAM_TERMS(row, d, 12), vec3(0.0))

#endif
