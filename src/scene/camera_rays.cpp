// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/camera_rays.h"

#include <fmt/format.h>

#include <cmath>

namespace gloam {

glm::mat3 cameraAxes(const glm::mat4& world_from_view) {
  const glm::vec3 backward = glm::normalize(glm::vec3(world_from_view[2]));
  glm::vec3 right = glm::vec3(world_from_view[0]);
  right = glm::normalize(right - backward * glm::dot(backward, right));
  return {right, glm::cross(backward, right), backward};
}

CameraRays makeCameraRays(const PosedCamera& posed, int width, int height) {
  constexpr float kPi = 3.14159265358979f;
  const Camera& camera = posed.camera;
  const std::string place = camera.name.empty() ? "camera" : "camera '" + camera.name + "'";
  CameraRays rays;
  rays.axes = cameraAxes(posed.world_from_view);
  if (!std::isfinite(rays.axes[0].x + rays.axes[1].x + rays.axes[2].x + posed.world_from_view[3].x))
    throw Error(place, "its matrix has no orientation (a scale of 0 or not-a-number)");
  rays.perspective = camera.perspective;
  rays.eye = glm::vec3(posed.world_from_view[3]);
  rays.forward = -rays.axes[2];
  if (camera.perspective) {
    if (!(camera.vertical_fov_rad > 0.0f && camera.vertical_fov_rad < kPi))
      throw Error(place,
                  fmt::format("field of view {} rad is not between 0 and pi", camera.vertical_fov_rad));
    if (!(camera.z_near > 0.0f)) throw Error(place, fmt::format("z_near {} is not positive", camera.z_near));
    rays.z_near = camera.z_near;
    rays.half_height = std::tan(0.5f * camera.vertical_fov_rad);
  } else {
    if (!(camera.half_height > 0.0f))
      throw Error(place, fmt::format("orthographic height {} is not positive", camera.half_height));
    rays.z_near = std::max(camera.z_near, 0.0f);
    rays.half_height = camera.half_height;
  }
  rays.half_width = rays.half_height * (float(width) / float(height));
  rays.corner = -rays.half_width * rays.axes[0] + rays.half_height * rays.axes[1];
  if (camera.perspective) rays.corner += rays.forward;
  rays.step_x = (2.0f * rays.half_width / float(width)) * rays.axes[0];
  rays.step_y = (-2.0f * rays.half_height / float(height)) * rays.axes[1];
  return rays;
}

}  // namespace gloam
