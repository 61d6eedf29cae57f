// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frame/view.h"

namespace gloam::frame {

namespace {

constexpr float kWidestSpotRad = 1.05f;  ///< to each side; wider ones get a cube
constexpr float kNearest_m = 1e-3f;      ///< of what throws shadows; nearer still in small scenes
constexpr int kFilterMargin = 4;  ///< texels around what a map must show, for the filter (frame/shadow.glsl)

float marginFactor(int map_size) {
  return float(map_size) / float(std::max(map_size - 2 * kFilterMargin, map_size / 2));
}

/// Any axes with that forward direction.
void setAxes(ShadowView& view, const glm::vec3& forward) {
  const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  view.forward = forward;
  view.right = glm::normalize(glm::cross(forward, helper));
  view.up = glm::cross(view.right, forward);
}

void setMatrix(ShadowView& view) {
  glm::mat4 clip_from_view(0.0f);  // view axes right, up, forward
  clip_from_view[0][0] = 1.0f / view.half_width;
  clip_from_view[1][1] = -1.0f / view.half_height;
  if (view.depth_range > 0.0f) {
    clip_from_view[2][2] = -1.0f / view.depth_range;
    clip_from_view[3][2] = 1.0f;
    clip_from_view[3][3] = 1.0f;
  } else {
    clip_from_view[2][3] = 1.0f;
    clip_from_view[3][2] = view.z_near;
  }
  const glm::mat3 view_axes_from_world = glm::transpose(glm::mat3(view.right, view.up, view.forward));
  glm::mat4 view_from_world(view_axes_from_world);
  view_from_world[3] = glm::vec4(-(view_axes_from_world * view.origin), 1.0f);
  view.clip_from_world = clip_from_view * view_from_world;
}

ShadowView perspectiveView(const glm::vec3& origin, const glm::vec3& forward, float tangent, float near,
                           int map_size) {
  ShadowView view{};
  setAxes(view, forward);
  view.origin = origin;
  view.z_near = near;
  view.half_width = view.half_height = tangent * marginFactor(map_size);
  setMatrix(view);
  return view;
}

struct Interval {
  float low = std::numeric_limits<float>::max(), high = -std::numeric_limits<float>::max();
  void add(float x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  bool overlaps(const Interval& other) const { return low < other.high && other.low < high; }
};

/// Half the length of an interval, rounded up in steps of a quarter octave, and its centre, rounded to
/// texels.
std::pair<float, float> steadied(const Interval& interval, int map_size) {
  const float raw = std::max(0.5f * (interval.high - interval.low), 1e-6f) * marginFactor(map_size);
  const float half = std::exp2(std::ceil(4.0f * std::log2(raw * (1.0f + 1.0f / float(map_size)))) / 4.0f);
  const float texel = 2.0f * half / float(map_size);
  return {half, std::round(0.5f * (interval.low + interval.high) / texel) * texel};
}

ShadowView directionalView(const glm::vec3& direction, const FrameView& camera, const glm::vec3& low,
                           const glm::vec3& high, int map_size) {
  ShadowView view{};
  setAxes(view, direction);
  Interval scene_x, scene_y, scene_z, seen_x, seen_y;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
    scene_x.add(glm::dot(p, view.right));
    scene_y.add(glm::dot(p, view.up));
    scene_z.add(glm::dot(p, direction));
  }
  for (const glm::vec3& p : frustumCorners(camera, low, high)) {
    seen_x.add(glm::dot(p, view.right));
    seen_y.add(glm::dot(p, view.up));
  }
  const auto both = [](const Interval& a, const Interval& b) {
    return a.overlaps(b) ? Interval{std::max(a.low, b.low), std::min(a.high, b.high)} : a;
  };
  const auto [half_width, x] = steadied(both(scene_x, seen_x), map_size);
  const auto [half_height, y] = steadied(both(scene_y, seen_y), map_size);
  const float slack = 1e-3f * (scene_z.high - scene_z.low) + 1e-4f;
  view.half_width = half_width;
  view.half_height = half_height;
  view.depth_range = scene_z.high - scene_z.low + 2.0f * slack;
  view.origin = x * view.right + y * view.up + (scene_z.low - slack) * direction;
  setMatrix(view);
  return view;
}

/// The maps of one lamp.
std::vector<ShadowView> shadowViews(const PosedLight& posed, const FrameView& camera, const glm::vec3& low,
                                    const glm::vec3& high, int map_size) {
  if (posed.light.type == Light::Type::kDirectional)
    return {directionalView(posed.direction, camera, low, high, map_size)};
  const float near = std::min(1e-4f * std::max(glm::length(high - low), 1e-3f), kNearest_m);
  if (posed.light.type == Light::Type::kSpot && posed.light.outer_cone_rad < kWidestSpotRad)
    return {perspectiveView(posed.position, posed.direction,
                            std::tan(std::max(posed.light.outer_cone_rad, 1e-3f)), near, map_size)};
  std::vector<ShadowView> faces;  // +X -X +Y -Y +Z -Z
  for (int face = 0; face < 6; ++face) {
    glm::vec3 forward(0.0f);
    forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
    faces.push_back(perspectiveView(posed.position, forward, 1.0f, near, map_size));
  }
  return faces;
}

int mapCount(const Light& light) {
  const bool cube = light.type == Light::Type::kPoint ||
                    (light.type == Light::Type::kSpot && light.outer_cone_rad >= kWidestSpotRad);
  return cube ? 6 : 1;
}

bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

LightRow rowOf(const PosedLight& posed) {
  const Light& light = posed.light;
  if (!isFinite(posed.position) || !isFinite(posed.direction) || !isFinite(light.intensity) ||
      !std::isfinite(light.range) || !std::isfinite(light.outer_cone_rad) ||
      !std::isfinite(light.inner_cone_rad))
    throw Error("light '" + light.name + "'",
                "position, direction, intensity, range and cones must be finite numbers");
  LightRow row{};
  row.position = posed.position;
  row.direction = posed.direction;
  row.intensity = light.intensity;
  row.range = light.range;
  row.cos_inner = std::cos(light.inner_cone_rad);
  row.cos_outer = std::cos(light.outer_cone_rad);
  row.kind = light.type == Light::Type::kDirectional ? kLightDirectional
             : light.type == Light::Type::kPoint     ? kLightPoint
                                                     : kLightSpot;
  return row;
}

}  // namespace

LightPlan planLights(std::span<const PosedLight> lights, const FrameView& view, const glm::vec3& bounds_min,
                     const glm::vec3& bounds_max, int map_size, std::size_t budget_bytes, int max_layers,
                     Warnings& warnings) {
  LightPlan plan;
  plan.map_size = map_size;
  std::vector<const PosedLight*> shining;
  int layers = 0, without_shadow = 0;
  for (const PosedLight& posed : lights) {
    LightRow row = rowOf(posed);
    if (row.intensity == glm::vec3(0.0f)) continue;
    const int count = mapCount(posed.light);
    if (layers + count <= max_layers) {
      row.first_map = static_cast<std::uint32_t>(layers);
      row.map_count = static_cast<std::uint32_t>(count);
      layers += count;
    } else {
      ++without_shadow;
    }
    plan.lights.push_back(row);
    shining.push_back(&posed);
  }
  while (plan.map_size > 64 &&
         std::size_t(layers) * std::size_t(plan.map_size) * std::size_t(plan.map_size) * 4 > budget_bytes)
    plan.map_size /= 2;
  if (plan.map_size != map_size)
    warnings.push_back(
        fmt::format("{} shadow maps are drawn at {} instead of {} texels a side to fit into {} MiB", layers,
                    plan.map_size, map_size, budget_bytes >> 20));
  if (without_shadow > 0)
    warnings.push_back(
        fmt::format("{} lights cast no shadow: the device takes {} shadow maps", without_shadow, max_layers));
  for (std::size_t i = 0; i < shining.size(); ++i) {
    if (plan.lights[i].map_count == 0) continue;
    for (const ShadowView& map : shadowViews(*shining[i], view, bounds_min, bounds_max, plan.map_size))
      plan.shadow_views.push_back(map);
  }
  return plan;
}

}  // namespace gloam::frame
