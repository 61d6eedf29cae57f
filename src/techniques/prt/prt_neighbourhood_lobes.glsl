// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lobes over the radiance that a grid has at a place, and over the light as it is where there is no grid. The includer
// defines field_order, has_thrown, damped, kWords, light and radiance.
#ifndef GLOAM_PRT_NEIGHBOURHOOD_LOBES_GLSL
#define GLOAM_PRT_NEIGHBOURHOOD_LOBES_GLSL

/// What the last lobe gathered: of the light as it is, of what is left of it here (and windowed), of what is thrown here.
vec3 open, shadowed, soft, thrown;

void addCoefficient(uint at, float weight, float soft_weight) {
  vec2 a = unpackHalf2x16(radiance.at[at]), b = unpackHalf2x16(radiance.at[at + 1u]);
  shadowed += weight * vec3(a, b.x);
  if (damped) soft += soft_weight * vec3(a, b.x);
  if (has_thrown) thrown += weight * vec3(b.y, unpackHalf2x16(radiance.at[at + 2u]));
}

#define ADD(i) addCoefficient(at + uint(i) * kWords, weight * y[i], weight * z[i]);
#define OPEN(i) open += y[i] * light.at[i];
#define BANDS_3(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8)
#define BANDS_4(DO) BANDS_3(DO) DO(9) DO(10) DO(11) DO(12) DO(13) DO(14) DO(15)
#define BANDS_5(DO) BANDS_4(DO) DO(16) DO(17) DO(18) DO(19) DO(20) DO(21) DO(22) DO(23) DO(24)
#define BANDS_6(DO) BANDS_5(DO) DO(25) DO(26) DO(27) DO(28) DO(29) DO(30) DO(31) DO(32) DO(33) DO(34) DO(35)
#define COSINE_3(DO) BANDS_3(DO)
#define COSINE_5(DO) BANDS_3(DO) DO(16) DO(17) DO(18) DO(19) DO(20) DO(21) DO(22) DO(23) DO(24)
#define GATHER(order, count, coefficients)          \
  {                                                 \
    float y[count], z[count];                       \
    shEvaluate##order(axis, y);                     \
    GLOAM_SH_SCALE_BANDS_##order(y, factors)        \
    z = y;                                          \
    GLOAM_SH_SCALE_BANDS_##order(z, soft_factors)   \
    coefficients(OPEN)                              \
    for (uint corner = 0u; corner < 8u; ++corner) { \
      uint at = cornerWord(place, corner);          \
      float weight = cornerWeight(place, corner);   \
      coefficients(ADD)                             \
    }                                               \
    if (damped) shadowed = withoutRinging(shadowed, soft); \
    return;                                         \
  }

float soft_factors[6];

/// The lobe of these band factors about an axis, over light as it is and as it is here.
void gatherPhong(GridPlace place, vec3 axis, float factors[6]) {
  open = shadowed = soft = thrown = vec3(0.0);
  if (field_order <= 3) GATHER(3, 9, BANDS_3)
  if (field_order == 4) GATHER(4, 16, BANDS_4)
  if (field_order == 5) GATHER(5, 25, BANDS_5)
  GATHER(6, 36, BANDS_6)
}

/// The same of the clamped cosine, which has nothing in bands 3 and 5.
void gatherCosine(GridPlace place, vec3 axis) {
  const float factors[6] = kShClampedCosineFactors;
  open = shadowed = soft = thrown = vec3(0.0);
  if (field_order <= 4) GATHER(3, 9, COSINE_3)
  GATHER(5, 25, COSINE_5)
}

#endif
