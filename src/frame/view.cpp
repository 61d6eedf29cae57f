// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/view.h"

#include <fmt/format.h>
#include <cmath>

namespace gloam::frame {

namespace {

constexpr float kPi = 3.14159265358979f;

/// Distance along `forward` from the eye to the farthest corner of a box.
float farthestDepth(const glm::vec3& eye, const glm::vec3& forward, const glm::vec3& low,
                    const glm::vec3& high) {
  float farthest = -std::numeric_limits<float>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
    farthest = std::max(farthest, glm::dot(p - eye, forward));
  }
  return farthest;
}

glm::mat4 viewFromWorld(const glm::mat3& axes, const glm::vec3& eye) {
  glm::mat4 result(glm::transpose(axes));
  result[3] = glm::vec4(-(glm::transpose(axes) * eye), 1.0f);
  return result;
}

}  // namespace

glm::mat3 cameraAxes(const glm::mat4& world_from_view) {
  const glm::vec3 backward = glm::normalize(glm::vec3(world_from_view[2]));
  glm::vec3 right = glm::vec3(world_from_view[0]);
  right = glm::normalize(right - backward * glm::dot(backward, right));
  return {right, glm::cross(backward, right), backward};
}

FrameView makeView(const PosedCamera& posed, int width, int height, const glm::vec3& bounds_min,
                   const glm::vec3& bounds_max) {
  const Camera& camera = posed.camera;
  const std::string place = camera.name.empty() ? "camera" : "camera '" + camera.name + "'";
  const glm::mat3 axes = cameraAxes(posed.world_from_view);
  if (!std::isfinite(axes[0].x + axes[1].x + axes[2].x + posed.world_from_view[3].x))
    throw Error(place, "its matrix has no orientation (a scale of 0 or not-a-number)");

  FrameView view{};
  view.eye = glm::vec3(posed.world_from_view[3]);
  view.forward = -axes[2];
  view.width = static_cast<std::uint32_t>(width);
  view.height = static_cast<std::uint32_t>(height);
  const float aspect = float(width) / float(height);
  glm::mat4 clip_from_view(0.0f);
  float half_height = camera.half_height;
  if (camera.perspective) {
    if (!(camera.vertical_fov_rad > 0.0f && camera.vertical_fov_rad < kPi))
      throw Error(place,
                  fmt::format("field of view {} rad is not between 0 and pi", camera.vertical_fov_rad));
    if (!(camera.z_near > 0.0f)) throw Error(place, fmt::format("z_near {} is not positive", camera.z_near));
    view.z_near = camera.z_near;
    half_height = std::tan(0.5f * camera.vertical_fov_rad);
    clip_from_view[2][3] = -1.0f;
    clip_from_view[3][2] = view.z_near;
  } else {
    if (!(half_height > 0.0f))
      throw Error(place, fmt::format("orthographic height {} is not positive", half_height));
    const float farthest = farthestDepth(view.eye, view.forward, bounds_min, bounds_max);
    view.z_near = std::max(camera.z_near, 0.0f);
    view.depth_range = std::max(1.01f * (farthest - view.z_near), 1e-3f);
    clip_from_view[2][2] = 1.0f / view.depth_range;
    clip_from_view[3][2] = (view.z_near + view.depth_range) / view.depth_range;
    clip_from_view[3][3] = 1.0f;
  }
  const float half_width = half_height * aspect;
  clip_from_view[0][0] = 1.0f / half_width;
  clip_from_view[1][1] = -1.0f / half_height;  // rows count downward
  view.corner = -half_width * axes[0] + half_height * axes[1];
  if (camera.perspective) view.corner += view.forward;
  view.step_x = (2.0f * half_width / float(width)) * axes[0];
  view.step_y = (-2.0f * half_height / float(height)) * axes[1];
  view.clip_from_world = clip_from_view * viewFromWorld(axes, view.eye);
  view.previous_clip_from_world = view.clip_from_world;
  return view;
}

std::array<glm::vec3, 8> frustumCorners(const FrameView& view, const glm::vec3& bounds_min,
                                        const glm::vec3& bounds_max) {
  const float far =
      std::max(farthestDepth(view.eye, view.forward, bounds_min, bounds_max), view.z_near * 1.01f);
  std::array<glm::vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const float x = i & 1 ? float(view.width) : 0.0f, y = i & 2 ? float(view.height) : 0.0f;
    const float depth = i & 4 ? far : view.z_near;
    const glm::vec3 offset = view.corner + x * view.step_x + y * view.step_y;
    corners[std::size_t(i)] =
        view.depth_range > 0.0f ? view.eye + offset + depth * view.forward : view.eye + depth * offset;
  }
  return corners;
}

}  // namespace gloam::frame
