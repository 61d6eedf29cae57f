// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gizmo.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

namespace gloam::view {
namespace {

constexpr float kReachPixels = 84.0f, kNearPixels = 7.0f, kCentrePixels = 8.0f;

glm::vec3 axisOf(int i) {
  glm::vec3 axis(0.0f);
  axis[i] = 1.0f;
  return axis;
}

float distanceToSegment(const glm::vec2& p, const glm::vec2& a, const glm::vec2& b) {
  const glm::vec2 ab = b - a, ap = p - a;
  const float t = std::clamp(glm::dot(ap, ab) / std::max(glm::dot(ab, ab), 1e-6f), 0.0f, 1.0f);
  return glm::length(ap - ab * t);
}

/// Along the axis, the place that is nearest to the ray.
float alongAxis(const Ray& ray, const glm::vec3& origin, const glm::vec3& axis) {
  const glm::vec3 w = origin - ray.origin;
  const float b = glm::dot(axis, ray.direction), d = glm::dot(axis, w), e = glm::dot(ray.direction, w);
  const float denominator = 1.0f - b * b;
  return denominator < 1e-5f ? 0.0f : (b * e - d) / denominator;
}

std::optional<glm::vec3> onPlane(const Ray& ray, const glm::vec3& origin, const glm::vec3& normal) {
  const float facing = glm::dot(ray.direction, normal);
  if (std::abs(facing) < 1e-4f) return std::nullopt;
  const float t = glm::dot(origin - ray.origin, normal) / facing;
  if (t <= 0.0f) return std::nullopt;
  return ray.origin + ray.direction * t;
}

float angleOnRing(const glm::vec3& point, const glm::vec3& origin, int axis) {
  const glm::vec3 d = point - origin;
  return std::atan2(d[(axis + 2) % 3], d[(axis + 1) % 3]);
}

bool within(const std::array<glm::vec2, 4>& square, const glm::vec2& p) {
  bool positive = false, negative = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec2 a = square[i], b = square[(i + 1) % 4];
    const float side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    (side >= 0.0f ? positive : negative) = true;
  }
  return positive != negative;
}

}  // namespace

float Handles::reach() const {
  const float depth = project(camera, origin, size).z;
  const float half = camera.camera.perspective ? std::tan(camera.camera.vertical_fov_rad * 0.5f) * depth
                                               : camera.camera.half_height;
  return kReachPixels * scale * 2.0f * half / size.y;
}

glm::vec2 Handles::onScreen(const glm::vec3& world) const {
  return glm::vec2(project(camera, world, size));
}

glm::vec2 Handles::tip(int axis) const {
  return onScreen(origin + axisOf(axis) * reach());
}

std::array<glm::vec2, 4> Handles::square(int axis) const {
  const glm::vec3 a = axisOf((axis + 1) % 3) * reach(), b = axisOf((axis + 2) % 3) * reach();
  const auto at = [&](float u, float v) { return onScreen(origin + a * u + b * v); };
  return {at(0.28f, 0.28f), at(0.5f, 0.28f), at(0.5f, 0.5f), at(0.28f, 0.5f)};
}

std::array<glm::vec2, kRingPoints> Handles::ring(int axis) const {
  std::array<glm::vec2, kRingPoints> points;
  const float radius = reach();
  for (int i = 0; i < kRingPoints; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * float(i) / kRingPoints;
    glm::vec3 p(0.0f);
    p[(axis + 1) % 3] = std::cos(angle) * radius;
    p[(axis + 2) % 3] = std::sin(angle) * radius;
    points[std::size_t(i)] = onScreen(origin + p);
  }
  return points;
}

Handle handleAt(const Handles& handles, const glm::vec2& mouse) {
  using Kind = Handle::Kind;
  const glm::vec2 centre = handles.onScreen(handles.origin);
  // All arrows begin at the dot: it comes first.
  if (!handles.turns && glm::length(mouse - centre) < kCentrePixels * handles.scale)
    return {Kind::kCentre, 0};
  Handle best;
  float nearest = kNearPixels * handles.scale;
  for (int axis = 0; axis < 3; ++axis) {
    if (handles.turns) {
      const auto ring = handles.ring(axis);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const float d = distanceToSegment(mouse, ring[i], ring[(i + 1) % ring.size()]);
        if (d < nearest) nearest = d, best = {Kind::kRing, axis};
      }
      continue;
    }
    if (within(handles.square(axis), mouse)) return {Kind::kPlane, axis};
    const float d = distanceToSegment(mouse, centre, handles.tip(axis));
    if (d < nearest) nearest = d, best = {Kind::kAxis, axis};
  }
  return best;
}

Pull::Pull(const Handles& handles, const Handle& handle, int node, cli::NodeMoves before,
           const glm::vec2& mouse)
    : handles_(handles), handle_(handle), node_(node), before_(std::move(before)) {
  normal_ = handle.kind == Handle::Kind::kCentre
                ? -glm::normalize(glm::vec3(handles.camera.world_from_view[2]))
                : axisOf(handle.axis);
  const Ray ray = rayThrough(handles.camera, mouse, handles.size);
  start_ = onPlane(ray, handles.origin, normal_).value_or(handles.origin);
  if (handle.kind == Handle::Kind::kAxis) start_value_ = alongAxis(ray, handles.origin, normal_);
  if (handle.kind == Handle::Kind::kRing) start_value_ = angleOnRing(start_, handles.origin, handle.axis);
}

std::optional<glm::mat4> Pull::motionTo(const glm::vec2& mouse) {
  const Ray ray = rayThrough(handles_.camera, mouse, handles_.size);
  if (handle_.kind == Handle::Kind::kAxis) {
    shift_ = normal_ * (alongAxis(ray, handles_.origin, normal_) - start_value_);
    return glm::translate(glm::mat4(1.0f), shift_);
  }
  const std::optional<glm::vec3> point = onPlane(ray, handles_.origin, normal_);
  if (!point) return std::nullopt;
  if (handle_.kind != Handle::Kind::kRing) {
    shift_ = *point - start_;
    return glm::translate(glm::mat4(1.0f), shift_);
  }
  const float angle = angleOnRing(*point, handles_.origin, handle_.axis) - start_value_;
  return glm::translate(glm::mat4(1.0f), handles_.origin) * glm::rotate(glm::mat4(1.0f), angle, normal_) *
         glm::translate(glm::mat4(1.0f), -handles_.origin);
}

std::optional<cli::NodeMoves> Pull::to(const Scene& scene, const glm::vec2& mouse) {
  const std::optional<glm::mat4> motion = motionTo(mouse);
  if (!motion) return std::nullopt;
  cli::NodeMoves moves = before_;
  cli::moveNode(scene, moves, node_, *motion);
  return moves;
}

}  // namespace gloam::view
