// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant lights as pixels, for the picture behind a scene and for the path tracer.
#include <gloam/lights.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/environment.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kLeastWidth = 512, kLargestWidth = 4096;
constexpr float kTexelsAcross = 3.0f;  // a disc's diameter

int widthFor(const Environment& base, std::span<const DistantLight> lights) {
  int width = kLeastWidth;
  for (const DistantLight& light : lights) {
    if (light.kind == DistantLight::Kind::kMap) width = std::max(width, light.map->width);
    if (light.kind != DistantLight::Kind::kDisc) continue;
    const float wanted = kTexelsAcross * kPi / light.radius_rad;
    while (float(width) < wanted && width < kLargestWidth) width *= 2;
  }
  return std::max(width, base.width);
}

class Painter {
 public:
  explicit Painter(Environment& map)
      : map_(map), c_(std::cos(map.rotation_rad)), s_(std::sin(map.rotation_rad)) {
    for (int column = 0; column < map.width; ++column) {
      const float phi = 2.0f * kPi * ((float(column) + 0.5f) / float(map.width) - 0.5f);
      around_.emplace_back(std::cos(phi), std::sin(phi));
    }
  }

  glm::vec3& texel(int column, int row) {
    return map_.radiance[std::size_t(row) * std::size_t(map_.width) + std::size_t(column)];
  }
  glm::vec3 worldDirection(int column, int row) const {
    const glm::vec2& around = around_[std::size_t(column)];
    const float elevation = kPi * (0.5f - (float(row) + 0.5f) / float(map_.height));
    const float x = std::cos(elevation) * around.x, z = std::cos(elevation) * around.y;
    return {c_ * x + s_ * z, std::sin(elevation), c_ * z - s_ * x};
  }

  void addBase(const Environment& base) {
    const bool same = base.width == map_.width && base.height == map_.height;
    tbb::parallel_for(0, map_.height, [&](int row) {
      for (int column = 0; column < map_.width; ++column) {
        const std::size_t i = std::size_t(row) * std::size_t(map_.width) + std::size_t(column);
        const glm::vec3 radiance =
            same ? base.radiance[i] : mapRadiance(base, texelDirection(map_, column, row));
        map_.radiance[i] = base.intensity * radiance;
      }
    });
  }

  void addSmooth(const DistantLight& light) {
    tbb::parallel_for(0, map_.height, [&](int row) {
      for (int column = 0; column < map_.width; ++column)
        texel(column, row) += radianceFrom(light, worldDirection(column, row));
    });
  }

  // Shares of texels at the rim are counted on a grid, then all are scaled so that their solid angles sum to the cone's.
  void addDisc(const DistantLight& disc) {
    struct Row {
      std::vector<std::pair<int, float>> shares;  // column, part of the texel
      double solid_angle = 0.0;
    };
    const float diagonal = 1.5f * kPi / float(map_.height);
    const float axis_elevation = std::asin(std::clamp(disc.direction.y, -1.0f, 1.0f));
    std::vector<Row> rows(std::size_t(map_.height));
    tbb::parallel_for(0, map_.height, [&](int y) {
      const float elevation = kPi * (0.5f - (float(y) + 0.5f) / float(map_.height));
      if (std::abs(elevation - axis_elevation) > disc.radius_rad + diagonal) return;
      Row& row = rows[std::size_t(y)];
      double covered = 0.0;
      for (int column = 0; column < map_.width; ++column) {
        const glm::vec3 off = worldDirection(column, y) - disc.direction;
        const float angle = 2.0f * std::asin(std::min(1.0f, 0.5f * glm::length(off)));
        if (angle > disc.radius_rad + diagonal) continue;
        const float share = angle < disc.radius_rad - diagonal ? 1.0f : rimShare(column, y, disc);
        row.shares.emplace_back(column, share);
        covered += double(share);
      }
      row.solid_angle = covered * double(sh::equirectangularSolidAngle(y, map_.width, map_.height));
    });
    double sum = 0.0;
    for (const Row& row : rows) sum += row.solid_angle;
    const double half = std::sin(0.5 * double(disc.radius_rad));
    if (!(sum > 0.0)) return;
    const glm::vec3 radiance = disc.radiance * float(4.0 * double(kPi) * half * half / sum);
    for (int y = 0; y < map_.height; ++y) {
      for (const auto& [column, share] : rows[std::size_t(y)].shares) texel(column, y) += share * radiance;
    }
  }

 private:
  float rimShare(int column, int row, const DistantLight& disc) const {
    constexpr int kPoints = 8;
    const glm::vec3 axis(c_ * disc.direction.x - s_ * disc.direction.z, disc.direction.y,
                         s_ * disc.direction.x + c_ * disc.direction.z);
    const float reach = 2.0f * std::sin(0.5f * disc.radius_rad);  // chord of the half-angle
    const float top = std::sin(kPi * (0.5f - float(row) / float(map_.height)));
    const float bottom = std::sin(kPi * (0.5f - float(row + 1) / float(map_.height)));
    int inside = 0;
    for (int j = 0; j < kPoints; ++j) {
      const float y = bottom + (top - bottom) * (float(j) + 0.5f) / kPoints;
      const float r = std::sqrt(std::max(0.0f, 1.0f - y * y));
      for (int i = 0; i < kPoints; ++i) {
        const float phi =
            2.0f * kPi * ((float(column) + (float(i) + 0.5f) / kPoints) / float(map_.width) - 0.5f);
        const glm::vec3 off = glm::vec3(r * std::cos(phi), y, r * std::sin(phi)) - axis;
        if (glm::dot(off, off) <= reach * reach) ++inside;
      }
    }
    return float(inside) / float(kPoints * kPoints);
  }

  Environment& map_;
  float c_, s_;
  std::vector<glm::vec2> around_;  // cosine and sine of each column's longitude
};

}  // namespace

Environment paintLights(const Environment& base, std::span<const DistantLight> lights) {
  Environment map;
  map.name = base.name;
  map.warnings = base.warnings;
  map.rotation_rad = base.rotation_rad;
  map.width = widthFor(base, lights);
  map.height = map.width == base.width ? base.height : map.width / 2;
  map.radiance.assign(std::size_t(map.width) * std::size_t(map.height), glm::vec3(0.0f));
  Painter painter(map);
  if (!base.empty()) painter.addBase(base);
  for (const DistantLight& light : lights) {
    if (light.kind == DistantLight::Kind::kDisc) {
      painter.addDisc(light);
    } else {
      painter.addSmooth(light);
    }
  }
  Environment unturned = base;  // its projection in the map's own axes
  unturned.rotation_rad = 0.0f;
  sh::ShRgb sh = projectEnvironment(unturned, sh::kMaxOrder);
  const float c = std::cos(map.rotation_rad), s = std::sin(map.rotation_rad);
  sh +=
      sh::rotate(glm::mat3(c, 0.0f, s, 0.0f, 1.0f, 0.0f, -s, 0.0f, c), projectLights(lights, sh::kMaxOrder));
  map.lights = std::make_shared<const EnvironmentLights>(EnvironmentLights{sh, {}});
  return map;
}

Environment describeLights(std::vector<DistantLight> lights) {
  Environment described;
  const sh::ShRgb sh = projectLights(lights, sh::kMaxOrder);
  described.lights = std::make_shared<const EnvironmentLights>(EnvironmentLights{sh, std::move(lights)});
  return described;
}

DistantLight mapLight(Environment environment) {
  DistantLight light{.kind = DistantLight::Kind::kMap};
  light.known_sh = std::make_shared<const sh::ShRgb>(projectEnvironment(environment, sh::kMaxOrder));
  light.map = std::make_shared<const Environment>(std::move(environment));
  return light;
}

}  // namespace gloam
