// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-1: the basis as polynomials in x, y, z, written once for C++ and GLSL. GLOAM_SH_BASIS_n(out, x, y, z) sets the
// n^2 entries of the array `out`; x, y, z are names of scalars, a unit vector.
#ifndef GLOAM_MATH_SH_BASIS_H
#define GLOAM_MATH_SH_BASIS_H

#define GLOAM_SH_BASIS_1(out, x, y, z) out[0] = kShNorm00;

#define GLOAM_SH_BASIS_2(out, x, y, z) \
  GLOAM_SH_BASIS_1(out, x, y, z)       \
  out[1] = kShNorm11 * y;              \
  out[2] = kShNorm10 * z;              \
  out[3] = kShNorm11 * x;

#define GLOAM_SH_BASIS_3(out, x, y, z)        \
  GLOAM_SH_BASIS_2(out, x, y, z)              \
  out[4] = 2.0f * kShNorm22 * x * y;          \
  out[5] = kShNorm21 * z * y;                 \
  out[6] = kShNorm20 * (3.0f * z * z - 1.0f); \
  out[7] = kShNorm21 * z * x;                 \
  out[8] = kShNorm22 * (x * x - y * y);

#define GLOAM_SH_BASIS_4(out, x, y, z)             \
  GLOAM_SH_BASIS_3(out, x, y, z)                   \
  out[9] = kShNorm33 * y * (3.0f * x * x - y * y); \
  out[10] = 2.0f * kShNorm32 * z * x * y;          \
  out[11] = kShNorm31 * (5.0f * z * z - 1.0f) * y; \
  out[12] = kShNorm30 * z * (5.0f * z * z - 3.0f); \
  out[13] = kShNorm31 * (5.0f * z * z - 1.0f) * x; \
  out[14] = kShNorm32 * z * (x * x - y * y);       \
  out[15] = kShNorm33 * x * (x * x - 3.0f * y * y);

#define GLOAM_SH_BASIS_5(out, x, y, z)                            \
  GLOAM_SH_BASIS_4(out, x, y, z)                                  \
  out[16] = 4.0f * kShNorm44 * x * y * (x * x - y * y);           \
  out[17] = kShNorm43 * z * y * (3.0f * x * x - y * y);           \
  out[18] = 2.0f * kShNorm42 * (7.0f * z * z - 1.0f) * x * y;     \
  out[19] = kShNorm41 * z * (7.0f * z * z - 3.0f) * y;            \
  out[20] = kShNorm40 * ((35.0f * z * z - 30.0f) * z * z + 3.0f); \
  out[21] = kShNorm41 * z * (7.0f * z * z - 3.0f) * x;            \
  out[22] = kShNorm42 * (7.0f * z * z - 1.0f) * (x * x - y * y);  \
  out[23] = kShNorm43 * z * x * (x * x - 3.0f * y * y);           \
  out[24] = kShNorm44 * ((x * x - 6.0f * y * y) * x * x + y * y * y * y);

#define GLOAM_SH_BASIS_6(out, x, y, z)                                                \
  GLOAM_SH_BASIS_5(out, x, y, z)                                                      \
  out[25] = kShNorm55 * y * ((5.0f * x * x - 10.0f * y * y) * x * x + y * y * y * y); \
  out[26] = 4.0f * kShNorm54 * z * x * y * (x * x - y * y);                           \
  out[27] = kShNorm53 * (9.0f * z * z - 1.0f) * y * (3.0f * x * x - y * y);           \
  out[28] = 2.0f * kShNorm52 * z * (3.0f * z * z - 1.0f) * x * y;                     \
  out[29] = kShNorm51 * ((21.0f * z * z - 14.0f) * z * z + 1.0f) * y;                 \
  out[30] = kShNorm50 * z * ((63.0f * z * z - 70.0f) * z * z + 15.0f);                \
  out[31] = kShNorm51 * ((21.0f * z * z - 14.0f) * z * z + 1.0f) * x;                 \
  out[32] = kShNorm52 * z * (3.0f * z * z - 1.0f) * (x * x - y * y);                  \
  out[33] = kShNorm53 * (9.0f * z * z - 1.0f) * x * (x * x - 3.0f * y * y);           \
  out[34] = kShNorm54 * z * ((x * x - 6.0f * y * y) * x * x + y * y * y * y);         \
  out[35] = kShNorm55 * x * ((x * x - 10.0f * y * y) * x * x + 5.0f * y * y * y * y);

#endif
