// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What does not change a frame: tables over a sphere's apparent size, and the light in the form that shading takes.
#pragma once

#include <gloam/sh.h>

#include <array>

#include "techniques/spherical_lights/spherical_lights_shared.h"

namespace gloam::spherical_lights {

/// Over which points of a sphere its radiance is averaged: as much as each turns to the receiver (the paper's), or as large as each
/// looks from there.
enum class Average { kArea, kSolidAngle };

/// SL-4: w_theta as factors of bands: the mean of P_l(cos) under the weight, for a sine of the half-angle in 0 … 1. The average
/// radiance is the sum over l of w_l sum over m of L_lm y_lm(centre to receiver).
glm::vec4 averageWeights(Average average, float sin_half_angle);

/// Logs of what a sphere leaves visible, as zonal coefficients times sqrt(4 pi / (2 l + 1)) (SH-4).
glm::vec4 logWeights(float sin_half_angle);

/// A polynomial from its constant term on: what tables would hold, since drivers that run on processors look up slowly.
using Fit = std::array<glm::vec4, kFitTerms>;
/// Of averageWeights, in 2 t - 1, t = sh::logBlockerCoordinate (0 to 1).
Fit averageFit(Average average);
glm::vec4 averageFitted(const Fit& fit, float sin_half_angle);
/// Of logWeights over the square of the sine, so that small ones are as close as large ones; below and above kLogSplit, each in -1 … 1.
using LogFit = std::array<Fit, 2>;
LogFit logFit();
glm::vec4 logFitted(const LogFit& fit, float sin_half_angle);

/// D_l = 2 pi times the integral of P_l over the disc: V . f = sum over l of D_l sum over m of f_lm y_lm(to the sphere).
glm::vec4 discWeights(float sin_half_angle);

/// Coefficients of four bands by which functions turn (bands 1 to 3, rows of 3, 5, 7): f'_i = sum of D_ij f_j.
void bandRotation(const glm::mat3& matrix, float out[83]);

}  // namespace gloam::spherical_lights
