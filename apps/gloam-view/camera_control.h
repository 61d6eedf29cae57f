// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A camera led by a hand: round a point (orbit) or through the scene (fly). Never rolls: up stays up, so that a preset's eye and
// target say all of it.
#pragma once

#include <gloam/scene.h>

namespace gloam::view {

class CameraControl {
 public:
  /// Takes over a camera; a roll that it has is straightened. The point it turns about lies before it, as far as the middle of
  /// the scene is.
  void set(const PosedCamera& camera, const PosedScene& posed);
  void setTarget(const glm::vec3& eye, const glm::vec3& target);
  PosedCamera posed() const;

  void orbit(const glm::vec2& angles_rad);  ///< x to the right, y upward, about the target
  void look(const glm::vec2& angles_rad);   ///< about the eye
  void pan(const glm::vec2& heights);       ///< sideways and upward, in heights of the picture at the target
  void zoom(float steps);                   ///< toward the target; negative: away
  void fly(const glm::vec3& right_up_forward);  ///< metres
  void frame(const glm::vec3& low, const glm::vec3& high, float aspect);
  void setFov(float vertical_rad) { camera_.perspective = true, camera_.vertical_fov_rad = vertical_rad; }
  /// Orthographic from now on, so many metres high.
  void setOrtho(float height_m) { camera_.perspective = false, camera_.half_height = 0.5f * height_m; }

  const Camera& camera() const { return camera_; }
  glm::vec3 eye() const { return target_ - forward() * distance_; }
  const glm::vec3& target() const { return target_; }
  glm::vec3 forward() const;
  glm::vec3 right() const;
  glm::vec3 up() const;
  float distance() const { return distance_; }
  float sceneSize() const { return scene_size_; }

 private:
  void limit();

  Camera camera_;
  glm::vec3 target_{0.0f};
  float distance_ = 1.0f;
  float yaw_rad_ = 0.0f, pitch_rad_ = 0.0f;  ///< of the forward direction
  float scene_size_ = 1.0f;
};

/// Where a point of the world stands in a picture of that size; z: in front of the eye where above 0.
glm::vec3 project(const PosedCamera& camera, const glm::vec3& world, const glm::vec2& size);
struct Ray {
  glm::vec3 origin, direction;
};
/// The ray through a place of a picture of that size; `direction` has unit length.
Ray rayThrough(const PosedCamera& camera, const glm::vec2& place, const glm::vec2& size);

}  // namespace gloam::view
