// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-7: where a table of blockers' logs (math/sh_log_exp.h, LogBlockerTable) is looked up.
#ifndef GLOAM_MATH_SH_LOG_BLOCKER_GLSL
#define GLOAM_MATH_SH_LOG_BLOCKER_GLSL

/// sqrt(2) sin(theta / 2), 0 to 1, of alpha = sin(theta). Entry i of n stands at i / (n - 1); linear in between.
float shLogBlockerCoordinate(float alpha) {
  float a = clamp(alpha, 0.0f, 1.0f);
  return a / sqrt(1.0f + sqrt(1.0f - a * a));
}

/// The alpha at that coordinate.
float shLogBlockerAlpha(float coordinate) {
  float v = clamp(coordinate, 0.0f, 1.0f);
  return v * sqrt(2.0f - v * v);
}

#endif
