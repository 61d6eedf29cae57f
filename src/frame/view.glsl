// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From a pixel to the ray through it and the point that it shows. frame/view.h makes the numbers.
#ifndef GLOAM_FRAME_VIEW_GLSL
#define GLOAM_FRAME_VIEW_GLSL
#include "frame/frame_shared.h"

struct Ray {
  vec3 origin;
  vec3 direction;  // its part along the camera's axis is 1: distances along it are eye depths
};

/// `pixel` in pixels from the top left corner; centres at + 1/2.
Ray pixelRay(FrameView view, vec2 pixel) {
  vec3 offset = view.corner + pixel.x * view.step_x + pixel.y * view.step_y;
  return view.depth_range > 0.0 ? Ray(view.eye + offset, view.forward) : Ray(view.eye, offset);
}

/// Distance along the camera's axis from the value of the depth buffer (more than 0).
float eyeDepth(FrameView view, float depth) {
  return view.depth_range > 0.0 ? view.z_near + (1.0 - depth) * view.depth_range : view.z_near / depth;
}

/// Unit vector from a point to the eye.
vec3 directionToEye(FrameView view, vec3 position) {
  return view.depth_range > 0.0 ? -view.forward : normalize(view.eye - position);
}

#endif
