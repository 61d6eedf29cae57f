// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8: coefficients of the exponentials, for C++ and GLSL. Written by sh_fit_exp: least squares over the logs
// of 224 sets of 1 to 40 spheres an order (sh_exp_fit.cpp says how); do not edit.
// clang-format off
#ifndef GLOAM_MATH_SH_EXP_TABLES_H
#define GLOAM_MATH_SH_EXP_TABLES_H
#ifdef __cplusplus
namespace gloam::sh {
#endif

const float kShExpNorm = 32.0f;  // of f^, at most
const int kShExpSquarings = 8;
const float kShExpBlend = 0.75f;  // of the quadratic one's range: from where on one more squaring comes in

// Range of |f^|; a2, a3, b1, b2: a = 1 + a2 x^2 + a3 x^3, b = 1 + b1 x + b2 x^2.
const float kShExpHybrid2[5] = {0.250000f, 0.0397699f, 0.000138400f, -4.97704e-07f, 0.0132658f};
const float kShExpHybrid3[5] = {0.250000f, 0.0322942f, -0.0633513f, -0.0738967f, 0.523776f};
const float kShExpHybrid4[5] = {0.250000f, 0.0412133f, -0.106297f, -0.234397f, 1.12983f};
const float kShExpHybrid5[5] = {0.250000f, -0.0149059f, 0.130935f, 0.155681f, -0.668411f};
const float kShExpHybrid6[5] = {0.250000f, -0.00545780f, 0.0682251f, 0.160969f, -0.653805f};

// The same, then c1, c2: c = 1/2 + c1 x + c2 x^2.
const float kShExpQuadratic2[7] = {2.00000f, 3.14449e-05f, -1.94671e-05f, -0.000181957f, 0.0135048f, -0.000548964f, 0.00369135f};
const float kShExpQuadratic3[7] = {2.00000f, 0.00286427f, -0.00390518f, -0.0214256f, 0.0362323f, -0.0605293f, 0.0330460f};
const float kShExpQuadratic4[7] = {2.00000f, 0.00697060f, -0.00582732f, -0.0144821f, 0.0304152f, -0.119230f, 0.0453422f};
const float kShExpQuadratic5[7] = {1.00000f, -0.00632906f, 0.0108161f, 0.0166654f, -0.0175642f, -0.0273141f, -0.104815f};
const float kShExpQuadratic6[7] = {1.00000f, -0.00288577f, 0.00480154f, -0.0185777f, 0.0444419f, -0.0403614f, -0.100695f};

// a and b of expLinear at |f^| = 0, step, 2 step ...
const int kShExpLinearEntries = 17;
const float kShExpLinearStep = 0.5f;
const float kShExpLinearA2[17] = {
    1.00000f, 1.00996f, 1.04005f, 1.09087f, 1.16342f, 1.25916f, 1.37999f, 1.52832f, 1.70710f,
    1.91990f, 2.17096f, 2.46528f, 2.80873f, 3.20815f, 3.67150f, 4.20801f, 4.82838f};
const float kShExpLinearB2[17] = {
    1.00000f, 1.00332f, 1.01332f, 1.03011f, 1.05390f, 1.08498f, 1.12371f, 1.17058f, 1.22613f,
    1.29106f, 1.36616f, 1.45235f, 1.55071f, 1.66246f, 1.78901f, 1.93196f, 2.09313f};
const float kShExpLinearA3[17] = {
    1.00000f, 1.00953f, 1.03673f, 1.08001f, 1.13838f, 1.21136f, 1.29889f, 1.40133f, 1.51936f,
    1.65406f, 1.80682f, 1.97941f, 2.17399f, 2.39313f, 2.63988f, 2.91780f, 3.23108f};
const float kShExpLinearB3[17] = {
    1.00000f, 0.939220f, 0.890978f, 0.853622f, 0.825828f, 0.806551f, 0.794980f, 0.790504f, 0.792689f,
    0.801257f, 0.816071f, 0.837125f, 0.864540f, 0.898563f, 0.939565f, 0.988049f, 1.04466f};
const float kShExpLinearA4[17] = {
    1.00000f, 1.00925f, 1.03464f, 1.07351f, 1.12410f, 1.18531f, 1.25655f, 1.33761f, 1.42857f,
    1.52980f, 1.64184f, 1.76545f, 1.90156f, 2.05125f, 2.21582f, 2.39674f, 2.59567f};
const float kShExpLinearB4[17] = {
    1.00000f, 0.897343f, 0.816624f, 0.753384f, 0.704190f, 0.666401f, 0.637978f, 0.617353f, 0.603318f,
    0.594953f, 0.591558f, 0.592614f, 0.597743f, 0.606686f, 0.619280f, 0.635445f, 0.655175f};
const float kShExpLinearA5[17] = {
    1.00000f, 1.00902f, 1.03307f, 1.06889f, 1.11442f, 1.16843f, 1.23027f, 1.29968f, 1.37669f,
    1.46155f, 1.55467f, 1.65664f, 1.76818f, 1.89013f, 2.02348f, 2.16937f, 2.32910f};
const float kShExpLinearB5[17] = {
    1.00000f, 0.864988f, 0.763069f, 0.685867f, 0.627336f, 0.583088f, 0.549928f, 0.525517f, 0.508140f,
    0.496539f, 0.489792f, 0.487229f, 0.488372f, 0.492891f, 0.500572f, 0.511294f, 0.525015f};
const float kShExpLinearA6[17] = {
    1.00000f, 1.00884f, 1.03187f, 1.06548f, 1.10755f, 1.15688f, 1.21285f, 1.27525f, 1.34412f,
    1.41969f, 1.50235f, 1.59258f, 1.69101f, 1.79837f, 1.91549f, 2.04335f, 2.18303f};
const float kShExpLinearB6[17] = {
    1.00000f, 0.839383f, 0.723239f, 0.638424f, 0.576022f, 0.529934f, 0.495952f, 0.471144f, 0.453454f,
    0.441427f, 0.434035f, 0.430549f, 0.430458f, 0.433410f, 0.439175f, 0.447618f, 0.458678f};

#ifdef __cplusplus
}  // namespace gloam::sh
#endif
#endif
