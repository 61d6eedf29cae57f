// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The camera as rays through pixels: one definition for the rasteriser's matrix (frame/view) and the path tracer.
#pragma once

#include <gloam/scene.h>

namespace gloam {

/// Pixels count from the top left corner; centres are at + 1/2. A perspective camera looks along
/// corner + x step_x + y step_y from `eye`, and eye depth is 1 along that vector; an orthographic one looks along `forward`
/// from eye + that.
struct CameraRays {
  bool perspective = true;
  glm::vec3 eye{0.0f};
  glm::vec3 forward{0.0f, 0.0f, -1.0f};  ///< unit
  glm::mat3 axes{1.0f};                  ///< columns right, up, backward; orthonormal
  glm::vec3 corner{0.0f}, step_x{0.0f}, step_y{0.0f};
  float half_width = 1.0f, half_height = 1.0f;  ///< of the picture at depth 1 (perspective) or everywhere
  float z_near = 0.05f;                         ///< least eye depth that is seen

  /// Where the ray of a pixel position starts (at eye depth 0), and its direction with eye depth 1 a length of itself.
  glm::vec3 origin(float x, float y) const {
    return perspective ? eye : eye + corner + x * step_x + y * step_y;
  }
  glm::vec3 direction(float x, float y) const {
    return perspective ? corner + x * step_x + y * step_y : forward;
  }
};

/// Only the orientation and position of world_from_view count; scale and shear are taken out. Square pixels:
/// Camera::aspect and the far plane do not count. Throws Error for a matrix without orientation, a field of view outside 0
/// to 180 degrees, a near plane or an orthographic height that is not positive.
CameraRays makeCameraRays(const PosedCamera& camera, int width, int height);

/// Orthonormal axes of a camera: columns right, up, backward.
glm::mat3 cameraAxes(const glm::mat4& world_from_view);

}  // namespace gloam
