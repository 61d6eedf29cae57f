// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Each pixel shows the nearest shell, clear towards its middle and denser towards its rim, with the model shining through.
// Where one sphere gives way to another, and along outlines, a dark line is drawn.
#include "spheres_overlay.h"

#include <scene/camera_rays.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "show.h"

namespace gloam::cli {
namespace {

constexpr int kRaysASide = 3;    // a pixel, against jagged rims
constexpr float kClear = 0.34f;  // opacity of a shell seen face on
constexpr float kLine = 0.10f;   // of its radius: how broad the dark rim is, at most
constexpr int kNobody = -1;

/// Colours that neighbours in number do not share: the golden ratio spreads hues evenly, brightness alternates.
glm::vec3 colorOf(const PosedSphere& sphere) {
  const int id = sphere.sphere + 7 * sphere.set;
  const float hue = 6.0f * float(std::fmod(0.08 + double(id) * 0.618033988749895, 1.0));
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) {
    const float wave = std::abs(std::fmod(hue + 4.0f * float(c), 6.0f) - 3.0f) - 1.0f;
    color[c] = 0.12f + 0.72f * std::clamp(wave, 0.0f, 1.0f);
  }
  return color * (id % 2 == 0 ? 1.0f : 0.72f);
}

struct Hit {
  int sphere = kNobody;
  float depth = INFINITY;
  glm::vec3 normal{0.0f};
};

/// First shell along the ray; `direction` has eye depth 1 a length of itself.
Hit firstShell(const std::vector<PosedSphere>& spheres, const std::vector<int>& near, const glm::vec3& origin,
               const glm::vec3& direction, float z_near) {
  Hit hit;
  const float a = glm::dot(direction, direction);
  for (const int i : near) {
    const PosedSphere& s = spheres[std::size_t(i)];
    const glm::vec3 to = s.center - origin;
    const float b = glm::dot(to, direction);
    const float inside = b * b - a * (glm::dot(to, to) - s.radius * s.radius);
    if (inside < 0.0f) continue;
    const float depth = (b - std::sqrt(inside)) / a;
    if (depth < z_near || depth >= hit.depth) continue;
    hit = {i, depth, (origin + depth * direction - s.center) / s.radius};
  }
  return hit;
}

/// Spheres that a row of pixels may meet: those its plane cuts.
std::vector<int> spheresOfRow(const std::vector<PosedSphere>& spheres, const CameraRays& rays, int y,
                              int width) {
  const glm::vec3 top_left = rays.direction(0.0f, float(y)),
                  bottom_left = rays.direction(0.0f, float(y) + 1.0f);
  const glm::vec3 across = rays.step_x * float(width);
  const auto normalOf = [&](const glm::vec3& left) {
    return glm::normalize(rays.perspective ? glm::cross(across, left) : rays.axes[1]);
  };
  std::vector<int> near;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const PosedSphere& s = spheres[i];
    const glm::vec3 above = normalOf(top_left), below = normalOf(bottom_left);
    const float to_top = glm::dot(s.center - rays.origin(0.0f, float(y)), above);
    const float to_bottom = glm::dot(s.center - rays.origin(0.0f, float(y) + 1.0f), below);
    const bool beside = std::min(std::abs(to_top), std::abs(to_bottom)) <= s.radius;
    if (beside || (to_top > 0.0f) != (to_bottom > 0.0f)) near.push_back(int(i));
  }
  return near;
}

glm::vec3 greyed(const glm::vec3& color) {
  const float luminance = glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return glm::mix(color, glm::vec3(luminance), 0.75f);
}

struct Overlay {
  const std::vector<PosedSphere>& spheres;
  CameraRays rays;
  const Image &picture, &depth;

  glm::vec3 shade(const glm::vec3& below, const Hit& hit, const glm::vec3& direction) const {
    const float facing = std::max(0.0f, -glm::dot(hit.normal, glm::normalize(direction)));
    const glm::vec3 to_light = glm::normalize(rays.axes * glm::vec3(-0.4f, 0.7f, 0.6f));
    const float light = 0.62f + 0.38f * std::max(0.0f, glm::dot(hit.normal, to_light));
    const float rim = (1.0f - facing) * (1.0f - facing);
    const float opacity = kClear + (0.9f - kClear) * rim;
    const glm::vec3 shell = colorOf(spheres[std::size_t(hit.sphere)]) * light;
    const float line = std::clamp((facing - 0.5f * kLine) / kLine, 0.25f, 1.0f);
    return glm::mix(below, shell, opacity) * line;
  }

  glm::vec3 pixel(int x, int y, const std::vector<int>& near) const {
    const float* p = picture.at(x, y);
    const glm::vec3 below = greyed({p[0], p[1], p[2]});
    const float surface = *depth.at(x, y);
    glm::vec3 sum(0.0f);
    int met[kRaysASide * kRaysASide];
    for (int i = 0; i < kRaysASide * kRaysASide; ++i) {
      const float sx = float(x) + (float(i % kRaysASide) + 0.5f) / float(kRaysASide);
      const float sy = float(y) + (float(i / kRaysASide) + 0.5f) / float(kRaysASide);
      const glm::vec3 direction = rays.direction(sx, sy);
      const Hit hit = firstShell(spheres, near, rays.origin(sx, sy), direction, rays.z_near);
      const bool hidden = surface > 0.0f && hit.depth > surface * 1.0005f;
      met[i] = hidden ? kNobody : hit.sphere;
      sum += met[i] == kNobody ? below : shade(below, hit, direction);
    }
    const auto differing = std::ranges::count_if(met, [&](int m) { return m != met[0]; });
    const bool seam = differing > 0;
    return sum / float(kRaysASide * kRaysASide) * (seam ? 0.45f : 1.0f);
  }
};

}  // namespace

Image spheresPicture(const LayeredImage& frame, const std::vector<PosedSphere>& spheres,
                     const PosedCamera& camera, const DisplayOptions& display) {
  const Image picture = toneMapped(lightOf(frame, ""), display);
  const Image depth = frame.image("depth", {"Z"}, "frame");
  const Overlay overlay{spheres, makeCameraRays(camera, frame.width, frame.height), picture, depth};
  Image out(frame.width, frame.height, 3);
  tbb::parallel_for(0, frame.height, [&](int y) {
    const std::vector<int> near = spheresOfRow(spheres, overlay.rays, y, frame.width);
    for (int x = 0; x < frame.width; ++x) {
      const glm::vec3 color = overlay.pixel(x, y, near);
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = color[c];
    }
  });
  return out;
}

}  // namespace gloam::cli
