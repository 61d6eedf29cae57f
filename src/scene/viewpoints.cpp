// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Cameras that no file gives: one that shows everything, and turns about the scene.
#include <gloam/scene.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gloam {

PosedCamera framingCamera(const PosedScene& posed, float aspect) {
  const glm::vec3 centre = 0.5f * (posed.bounds_min + posed.bounds_max);
  const glm::vec3 half = 0.5f * (posed.bounds_max - posed.bounds_min);
  const float radius = std::max(glm::length(half), 1e-3f);
  if (!(aspect > 0.0f)) aspect = 1.0f;

  // From the front, a little to the right and above: shows three sides of a box.
  const float azimuth_rad = glm::radians(28.0f), elevation_rad = glm::radians(18.0f);
  const glm::vec3 toward_eye(std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad),
                             std::cos(azimuth_rad) * std::cos(elevation_rad));
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), toward_eye));
  const glm::vec3 up = glm::cross(toward_eye, right);

  PosedCamera camera;
  camera.camera.name = "framing";
  camera.camera.vertical_fov_rad = glm::radians(40.0f);
  const float tan_y = std::tan(0.5f * camera.camera.vertical_fov_rad) * 0.94f;  // leaves a margin
  const float tan_x = tan_y * aspect;
  float distance = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p = half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const float depth = glm::dot(p, toward_eye);
    distance = std::max(
        {distance, std::abs(glm::dot(p, right)) / tan_x + depth, std::abs(glm::dot(p, up)) / tan_y + depth});
  }
  distance = std::max(distance, 1e-2f * radius);
  const glm::vec3 eye = centre + toward_eye * distance;
  camera.camera.z_near = std::max(1e-3f * radius, 0.5f * (distance - radius));
  camera.world_from_view = glm::inverse(glm::lookAt(eye, centre, glm::vec3(0.0f, 1.0f, 0.0f)));
  return camera;
}

PosedCamera orbit(const PosedCamera& camera, const PosedScene& posed, float angle_rad) {
  if (angle_rad == 0.0f) return camera;  // to the last bit: references are told apart by their cameras
  const glm::vec3 centre = 0.5f * (posed.bounds_min + posed.bounds_max);
  PosedCamera turned = camera;
  glm::mat4 turn = glm::translate(glm::mat4(1.0f), centre);
  turn = glm::rotate(turn, angle_rad, glm::vec3(0.0f, 1.0f, 0.0f));
  turn = glm::translate(turn, -centre);
  turned.world_from_view = turn * camera.world_from_view;
  return turned;
}

}  // namespace gloam
