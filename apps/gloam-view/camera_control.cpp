// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "camera_control.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace gloam::view {
namespace {

constexpr float kSteepest = 1.5533f;  // 89 degrees: beyond it up would flip
constexpr float kZoomStep = 0.88f;
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

}  // namespace

void CameraControl::set(const PosedCamera& posed, const PosedScene& scene) {
  camera_ = posed.camera;
  scene_size_ = std::max(glm::length(scene.bounds_max - scene.bounds_min), 1e-4f);
  const glm::vec3 eye(posed.world_from_view[3]);
  const glm::vec3 forward = -glm::normalize(glm::vec3(posed.world_from_view[2]));
  yaw_rad_ = std::atan2(forward.z, forward.x);
  pitch_rad_ = std::asin(std::clamp(forward.y, -1.0f, 1.0f));
  const glm::vec3 middle = (scene.bounds_min + scene.bounds_max) * 0.5f;
  distance_ = std::max(glm::dot(middle - eye, forward), 0.05f * scene_size_);
  limit();
  target_ = eye + this->forward() * distance_;
}

void CameraControl::setTarget(const glm::vec3& eye, const glm::vec3& target) {
  const glm::vec3 to = target - eye;
  distance_ = std::max(glm::length(to), 1e-4f);
  yaw_rad_ = std::atan2(to.z, to.x);
  pitch_rad_ = std::asin(std::clamp(to.y / distance_, -1.0f, 1.0f));
  limit();
  target_ = eye + forward() * distance_;
}

void CameraControl::limit() {
  pitch_rad_ = std::clamp(pitch_rad_, -kSteepest, kSteepest);
  distance_ = std::clamp(distance_, 1e-4f * scene_size_, 100.0f * scene_size_);
}

glm::vec3 CameraControl::forward() const {
  return {std::cos(pitch_rad_) * std::cos(yaw_rad_), std::sin(pitch_rad_),
          std::cos(pitch_rad_) * std::sin(yaw_rad_)};
}

glm::vec3 CameraControl::right() const {
  return glm::normalize(glm::cross(forward(), kUp));
}

glm::vec3 CameraControl::up() const {
  return glm::cross(right(), forward());
}

PosedCamera CameraControl::posed() const {
  return {camera_, glm::inverse(glm::lookAt(eye(), target_, kUp))};
}

void CameraControl::orbit(const glm::vec2& angles) {
  yaw_rad_ += angles.x;
  pitch_rad_ -= angles.y;
  limit();
}

void CameraControl::look(const glm::vec2& angles) {
  const glm::vec3 stays = eye();
  yaw_rad_ += angles.x;
  pitch_rad_ += angles.y;
  limit();
  target_ = stays + forward() * distance_;
}

void CameraControl::pan(const glm::vec2& heights) {
  const float height = camera_.perspective ? 2.0f * distance_ * std::tan(camera_.vertical_fov_rad * 0.5f)
                                           : 2.0f * camera_.half_height;
  target_ += (right() * heights.x + up() * heights.y) * height;
}

void CameraControl::zoom(float steps) {
  const float factor = std::pow(kZoomStep, steps);
  if (!camera_.perspective) camera_.half_height *= factor;
  distance_ *= factor;
  limit();
}

void CameraControl::fly(const glm::vec3& step) {
  target_ += right() * step.x + kUp * step.y + forward() * step.z;
}

void CameraControl::frame(const glm::vec3& low, const glm::vec3& high, float aspect) {
  target_ = (low + high) * 0.5f;
  const float radius = std::max(glm::length(high - low) * 0.5f, 1e-4f);
  const float vertical = camera_.perspective ? camera_.vertical_fov_rad * 0.5f : 0.4f;
  const float half = std::min(vertical, std::atan(std::tan(vertical) * std::max(aspect, 0.05f)));
  distance_ = radius / std::sin(half);
  if (!camera_.perspective) camera_.half_height = radius;
  limit();
}

glm::vec3 project(const PosedCamera& camera, const glm::vec3& world, const glm::vec2& size) {
  const glm::vec3 eye(glm::inverse(camera.world_from_view) * glm::vec4(world, 1.0f));
  const float depth = -eye.z;
  const float half = camera.camera.perspective ? std::tan(camera.camera.vertical_fov_rad * 0.5f) * depth
                                               : camera.camera.half_height;
  const float scale = 0.5f * size.y / std::max(half, 1e-9f);
  return {size.x * 0.5f + eye.x * scale, size.y * 0.5f - eye.y * scale, depth};
}

Ray rayThrough(const PosedCamera& camera, const glm::vec2& place, const glm::vec2& size) {
  const glm::vec2 p = (place - size * 0.5f) / (size.y * 0.5f);
  const glm::mat4& m = camera.world_from_view;
  if (!camera.camera.perspective) {
    const float h = camera.camera.half_height;
    return {glm::vec3(m * glm::vec4(p.x * h, -p.y * h, 0.0f, 1.0f)), -glm::normalize(glm::vec3(m[2]))};
  }
  const float t = std::tan(camera.camera.vertical_fov_rad * 0.5f);
  return {glm::vec3(m[3]), glm::normalize(glm::mat3(m) * glm::vec3(p.x * t, -p.y * t, -1.0f))};
}

}  // namespace gloam::view
