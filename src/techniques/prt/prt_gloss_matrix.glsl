// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Elements of a vertex's matrices. GS is symmetric as far as it is square: its lower triangle is stored, by rows, then the
// rows beyond. GI - GS is stored by rows, columns in pairs.
#ifndef GLOAM_PRT_GLOSS_MATRIX_GLSL
#define GLOAM_PRT_GLOSS_MATRIX_GLSL

float direct(int i) {
  if (!half_float) return uintBitsToFloat(transfer_direct.at[first_direct + uint(i) * kBlockVertices]);
  return unpackHalf2x16(transfer_direct.at[first_direct + uint(i >> 1) * kBlockVertices])[i & 1];
}
float gs(int i, int j) {
  if (i >= kColumns) return direct(kTriangle + (i - kColumns) * kColumns + j);
  return direct(j <= i ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i);
}
/// Row i, columns 2 pair and 2 pair + 1, of GI - GS times two coefficients of the light.
vec3 pair(int i, int pair, vec3 even, vec3 odd) {
  uint at = first_indirect;
  if (half_float) {
    at += uint(3 * (i * kPairs + pair)) * kBlockVertices;
    vec2 a = unpackHalf2x16(transfer_indirect.at[at]), b = unpackHalf2x16(transfer_indirect.at[at + kBlockVertices]);
    vec2 c = unpackHalf2x16(transfer_indirect.at[at + 2u * kBlockVertices]);
    return vec3(a, b.x) * even + vec3(b.y, c) * odd;
  }
  at += uint(6 * (i * kPairs + pair)) * kBlockVertices;
  float m[6];
  for (int k = 0; k < 6; ++k) m[k] = uintBitsToFloat(transfer_indirect.at[at + uint(k) * kBlockVertices]);
  return vec3(m[0], m[1], m[2]) * even + vec3(m[3], m[4], m[5]) * odd;
}

#endif
