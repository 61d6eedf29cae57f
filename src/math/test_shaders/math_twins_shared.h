// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the shader that calls the room's GLSL reads and writes; both sides include it (scalar layout).
#ifndef GLOAM_MATH_TWINS_SHARED_H
#define GLOAM_MATH_TWINS_SHARED_H
#ifdef __cplusplus
#include <glm/glm.hpp>
namespace gloam::math_test {
using glm::vec3;
#endif

struct TwinInput {
  vec3 direction, normal, to_view;
  float f[36];
  float g[36];
  vec3 light[36];
  float exponent, metallic, roughness;
  vec3 base_color;
};

struct TwinOutput {
  float basis3[9];
  float basis6[36];
  float zonal5[25];  // of f[0 … 4], turned to `direction`
  float product3[9];
  float product4[16];
  float product5[25];
  float product6[36];
  vec3 cosine4[16];
  vec3 irradiance[4];  // orders 3 to 6
  vec3 phong[4];
  vec3 lobes;
};

#ifdef __cplusplus
}  // namespace gloam::math_test
#endif
#endif
