// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// When receivers of one surface tell too different things for a pixel between them: mean distance from their mean, relative to it.
#ifndef GLOAM_SPHERICAL_LIGHTS_DISAGREE_GLSL
#define GLOAM_SPHERICAL_LIGHTS_DISAGREE_GLSL

/// A slope of 40 % from one receiver to the next stays below the first; one of sixteen in a crevice exceeds the second; the third is what
/// may be wrong beside silhouettes.
const float kDisagree = 0.1, kDisagreeWide = 0.1, kOff = 0.015;

const vec3 kBrightness = vec3(0.2126, 0.7152, 0.0722);
vec4 brightnessOf(mat4x3 colors) { return kBrightness * colors; }

#endif
