// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/view.h"

#include "scene/camera_rays.h"

namespace gloam::frame {

namespace {

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

FrameView makeView(const PosedCamera& posed, int width, int height, const glm::vec3& bounds_min,
                   const glm::vec3& bounds_max) {
  const CameraRays rays = makeCameraRays(posed, width, height);
  FrameView view{};
  view.eye = rays.eye;
  view.forward = rays.forward;
  view.width = static_cast<std::uint32_t>(width);
  view.height = static_cast<std::uint32_t>(height);
  view.z_near = rays.z_near;
  glm::mat4 clip_from_view(0.0f);
  if (rays.perspective) {
    clip_from_view[2][3] = -1.0f;
    clip_from_view[3][2] = view.z_near;
  } else {
    const float farthest = farthestDepth(view.eye, view.forward, bounds_min, bounds_max);
    view.depth_range = std::max(1.01f * (farthest - view.z_near), 1e-3f);
    clip_from_view[2][2] = 1.0f / view.depth_range;
    clip_from_view[3][2] = (view.z_near + view.depth_range) / view.depth_range;
    clip_from_view[3][3] = 1.0f;
  }
  clip_from_view[0][0] = 1.0f / rays.half_width;
  clip_from_view[1][1] = -1.0f / rays.half_height;  // rows count downward
  view.corner = rays.corner;
  view.step_x = rays.step_x;
  view.step_y = rays.step_y;
  view.clip_from_world = clip_from_view * viewFromWorld(rays.axes, view.eye);
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
