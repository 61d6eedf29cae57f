// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the shader that calls the room's exponentials reads and writes; both sides include it (scalar layout).
#ifndef GLOAM_MATH_EXP_TWINS_SHARED_H
#define GLOAM_MATH_EXP_TWINS_SHARED_H
#ifdef __cplusplus
namespace gloam::math_test {
#endif

struct ExpTwinInput {
  float f[36];
  float alpha;
};

struct ExpTwinOutput {
  float hybrid3[9], hybrid4[16], hybrid5[25], hybrid6[36];
  float quadratic3[9], quadratic4[16], quadratic5[25], quadratic6[36];
  float linear4[16], series4[16];
  float coordinate, alpha;
};

#ifdef __cplusplus
}  // namespace gloam::math_test
#endif
#endif
