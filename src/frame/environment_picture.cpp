// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/environment_picture.h"

#include <algorithm>
#include <cmath>

#include "gpu/format.h"

namespace gloam::frame {

namespace {

constexpr float kLargestHalf = 65504.0f;
constexpr int kLeastPainted = 512;

using Kind = DistantLight::Kind;

/// Whether two lights are sure to look alike.
bool same(const DistantLight& a, const DistantLight& b) {
  if (a.kind != b.kind) return false;
  switch (a.kind) {
    case Kind::kConstant:
      return a.radiance == b.radiance;
    case Kind::kGradient:
      return a.zenith == b.zenith && a.horizon == b.horizon && a.nadir == b.nadir;
    case Kind::kFunction:  // functions cannot be compared; their projection is made once for each that stays
      return a.known_sh && a.known_sh == b.known_sh && a.rotation_rad == b.rotation_rad &&
             a.intensity == b.intensity;
    case Kind::kMap:
      return a.map == b.map && a.rotation_rad == b.rotation_rad && a.intensity == b.intensity;
    default:
      return false;
  }
}

/// A disc turned about +Y.
DiscRow rowOf(const DistantLight& disc, float rotation_rad, float intensity) {
  const float c = std::cos(rotation_rad), s = std::sin(rotation_rad);
  const glm::vec3& d = disc.direction;
  DiscRow row{};
  row.direction = {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
  row.radius_rad = disc.radius_rad;
  row.radiance = intensity * disc.radiance;
  return row;
}

EnvironmentRow lookup(float rotation_rad, float intensity, int width, int height) {
  EnvironmentRow row{};
  row.cos_rotation = std::cos(rotation_rad);
  row.sin_rotation = std::sin(rotation_rad);
  row.intensity = intensity;
  row.map_width = float(width);
  row.map_height = float(height);
  return row;
}

}  // namespace

EnvironmentPicture::EnvironmentPicture(gpu::Device& device) : device_(&device) {
  upload({});
}

void EnvironmentPicture::set(const Environment& environment) {
  discs_.clear();
  if (environment.lights && !environment.lights->lights.empty()) {
    empty_ = false;
    describe(environment);
    return;
  }
  behind_.clear();
  painted_ = true;
  empty_ = environment.empty();
  row_ = lookup(environment.rotation_rad, environment.intensity, environment.width, environment.height);
  upload(environment);
}

void EnvironmentPicture::describe(const Environment& environment) {
  std::vector<DistantLight> behind;
  for (const DistantLight& light : environment.lights->lights) {
    if (light.kind == Kind::kDisc) {
      discs_.push_back(rowOf(light, environment.rotation_rad, environment.intensity));
    } else {
      behind.push_back(light);
    }
  }
  float rotation_rad = environment.rotation_rad, intensity = environment.intensity;
  int width = 1, height = 1;
  if (behind.size() == 1 && behind[0].kind == Kind::kMap) {  // its own texels, looked up otherwise
    DistantLight& light = behind[0];
    rotation_rad += light.rotation_rad + light.map->rotation_rad;
    intensity *= light.intensity * light.map->intensity;
    light.rotation_rad = 0.0f;
    light.intensity = 1.0f;
    width = std::max(light.map->width, 1);
    height = std::max(light.map->height, 1);
  } else if (!behind.empty()) {
    width = kLeastPainted;  // as paintLights() takes it
    height = kLeastPainted / 2;
    for (const DistantLight& light : behind) {
      if (light.kind != Kind::kMap || light.map->width <= width) continue;
      width = light.map->width;
      height = width / 2;
    }
  }
  row_ = lookup(rotation_rad, intensity, width, height);
  row_.disc_count = static_cast<std::uint32_t>(discs_.size());
  const bool alike = !behind_.empty() && std::ranges::equal(behind, behind_, same);
  if (alike) return;
  behind_ = std::move(behind);
  painted_ = false;
}

const gpu::Image& EnvironmentPicture::map() const {
  if (!painted_) {
    if (behind_.size() == 1 && behind_[0].kind == Kind::kMap) {
      upload(*behind_[0].map);
    } else {
      upload(behind_.empty() ? Environment{} : paintLights({}, behind_));
    }
    painted_ = true;
  }
  return map_;
}

void EnvironmentPicture::upload(const Environment& environment) const {
  gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT, .mips = gpu::kAllMips};
  std::vector<std::uint16_t> halves(4, 0);
  if (!environment.empty()) {
    desc.width = environment.width;
    desc.height = environment.height;
    halves.resize(environment.radiance.size() * 4);
    for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        halves[4 * i + std::size_t(c)] =
            gpu::halfFromFloat(std::min(environment.radiance[i][c], kLargestHalf));
    }
  }
  map_ = gpu::Image(*device_, "frame.environment", desc);
  map_.upload(halves);
  map_.generateMips();
}

}  // namespace gloam::frame
