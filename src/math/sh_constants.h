// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-1: the one source of the basis' constants, included by C++ and GLSL alike. kShNormLM normalises
//   y_lm = kShNorm_l|m| * p_l|m|(z) * (Re for m >= 0, Im for m < 0 of (x + i y)^|m|)
// where p_lm, a polynomial with coprime integers as coefficients, is proportional to d^m/dz^m of Legendre's P_l.
// The tests derive every one of them again from its definition.
#ifndef GLOAM_MATH_SH_CONSTANTS_H
#define GLOAM_MATH_SH_CONSTANTS_H
#ifdef __cplusplus
namespace gloam::sh {
#endif

const float kShNorm00 = 0.282094791773878f;
const float kShNorm10 = 0.488602511902920f;
const float kShNorm11 = 0.488602511902920f;
const float kShNorm20 = 0.315391565252520f;  // 3 z^2 - 1
const float kShNorm21 = 1.092548430592079f;  // z
const float kShNorm22 = 0.546274215296040f;
const float kShNorm30 = 0.373176332590115f;  // z (5 z^2 - 3)
const float kShNorm31 = 0.457045799464466f;  // 5 z^2 - 1
const float kShNorm32 = 1.445305721320277f;  // z
const float kShNorm33 = 0.590043589926644f;
const float kShNorm40 = 0.105785546915204f;  // 35 z^4 - 30 z^2 + 3
const float kShNorm41 = 0.669046543557289f;  // z (7 z^2 - 3)
const float kShNorm42 = 0.473087347878780f;  // 7 z^2 - 1
const float kShNorm43 = 1.770130769779931f;  // z
const float kShNorm44 = 0.625835735449176f;
const float kShNorm50 = 0.116950322453424f;  // z (63 z^4 - 70 z^2 + 15)
const float kShNorm51 = 0.452946651195697f;  // 21 z^4 - 14 z^2 + 1
const float kShNorm52 = 2.396768392486662f;  // z (3 z^2 - 1)
const float kShNorm53 = 0.489238299435250f;  // 9 z^2 - 1
const float kShNorm54 = 2.075662314881042f;  // z
const float kShNorm55 = 0.656382056840170f;

// SH-5: sqrt(4 pi / (2 l + 1)), and A_l of the clamped cosine.
const float kShZonal0 = 3.544907701811032f;
const float kShZonal1 = 2.046653415892977f;
const float kShZonal2 = 1.585330919042404f;
const float kShZonal3 = 1.339849171813550f;
const float kShZonal4 = 1.181635900603677f;
const float kShZonal5 = 1.068829886827146f;
const float kShCosine0 = 3.141592653589793f;
const float kShCosine1 = 2.094395102393195f;
const float kShCosine2 = 0.785398163397448f;
const float kShCosine4 = -0.130899693899575f;  // those of bands 3 and 5 are 0

#ifdef __cplusplus
}  // namespace gloam::sh
#endif
#endif
