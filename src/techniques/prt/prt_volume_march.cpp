// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// T(p, s) = exp(-integral of sigma along the way), by the midpoint rule. A step of optical depth tau sends T (1 - e^-tau) of what
// its middle scatters, which is exact where density is constant over the step: even light stays even light.
#include "techniques/prt/prt_volume_march.h"

#include <algorithm>
#include <cmath>

namespace gloam::prt {

EvenMedium evenMedium(const Volume& volume) {
  const float mean = (volume.albedo.x + volume.albedo.y + volume.albedo.z) / 3.0f;
  EvenMedium even;
  even.extinction = 1.0f - mean * volume.asymmetry;
  even.albedo = glm::max(glm::vec3(0.0f), (volume.albedo - mean * volume.asymmetry) / even.extinction);
  return even;
}

VolumeMarcher::VolumeMarcher(const Volume& volume, float extinction, const glm::mat3& node_from_axes)
    : size_(volume.size),
      cell_((volume.bounds_max - volume.bounds_min) / glm::vec3(volume.size)),
      origin_(volume.bounds_min),
      extinction_(extinction),
      step_(std::min({cell_.x, cell_.y, cell_.z})),
      node_from_axes_(node_from_axes) {
  const glm::ivec3 padded = size_ + 2;
  padded_.resize(std::size_t(padded.x) * std::size_t(padded.y) * std::size_t(padded.z));
  const auto at = [&](const glm::ivec3& p) {
    const glm::ivec3 q = glm::clamp(p, glm::ivec3(0), size_ - 1);
    return std::size_t(q.x) +
           std::size_t(size_.x) * (std::size_t(q.y) + std::size_t(size_.y) * std::size_t(q.z));
  };
  std::size_t i = 0;
  for (int z = -1; z <= size_.z; ++z)
    for (int y = -1; y <= size_.y; ++y)
      for (int x = -1; x <= size_.x; ++x) padded_[i++] = volume.density[at({x, y, z})];
  number_.assign(volume.voxels(), kEmptyVoxel);
  glm::ivec3 low = size_, high(-1);
  for (int z = 0; z < size_.z; ++z)
    for (int y = 0; y < size_.y; ++y)
      for (int x = 0; x < size_.x; ++x) {
        const glm::ivec3 here(x, y, z);
        bool any = false;
        for (int n = 0; n < 27 && !any; ++n)
          any = volume.density[at(here + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1)] > 0.0f;
        if (!any) continue;
        number_[at(here)] = std::uint32_t(filled_.size());
        filled_.push_back(std::uint32_t(at(here)));
        low = glm::min(low, here);
        high = glm::max(high, here);
      }
  low_ = glm::vec3(low) + 0.5f;  // voxel i reaches from i + 1/2 to i + 3/2 there
  high_ = glm::vec3(high) + 1.5f;
}

glm::vec3 VolumeMarcher::position(std::uint32_t voxel) const {
  const std::uint32_t x = std::uint32_t(size_.x), y = std::uint32_t(size_.y);
  return origin_ + cell_ * (glm::vec3(float(voxel % x), float(voxel / x % y), float(voxel / (x * y))) + 0.5f);
}

float VolumeMarcher::sample(const glm::vec3& at) const {
  const glm::ivec3 base = glm::clamp(glm::ivec3(at), glm::ivec3(0), size_);
  const glm::vec3 f = glm::clamp(at - glm::vec3(base), 0.0f, 1.0f);
  const std::size_t row = std::size_t(size_.x + 2), slice = row * std::size_t(size_.y + 2);
  const float* p = &padded_[std::size_t(base.x) + row * std::size_t(base.y) + slice * std::size_t(base.z)];
  const auto along = [&](const float* a) { return a[0] + f.x * (a[1] - a[0]); };
  const float near_low = along(p), near_high = along(p + row), far_low = along(p + slice),
              far_high = along(p + slice + row);
  const float near = near_low + f.y * (near_high - near_low), far = far_low + f.y * (far_high - far_low);
  return near + f.z * (far - near);
}

float VolumeMarcher::densityAt(const glm::vec3& position) const {
  const glm::vec3 at = (position - origin_) / cell_;
  if (glm::any(glm::lessThan(at, glm::vec3(0.0f))) || glm::any(glm::greaterThan(at, glm::vec3(size_))))
    return 0.0f;
  return sample(at + 0.5f);
}

VolumeMarcher::Way VolumeMarcher::wayFrom(std::uint32_t voxel, const glm::vec3& direction) const {
  const glm::vec3 along = glm::normalize(node_from_axes_ * direction) / cell_;  // voxels a metre
  const glm::vec3 start = (position(voxel) - origin_) / cell_ + 0.5f;
  float reach = std::numeric_limits<float>::max();
  for (int c = 0; c < 3; ++c) {
    if (along[c] > 0.0f) reach = std::min(reach, (high_[c] - start[c]) / along[c]);
    if (along[c] < 0.0f) reach = std::min(reach, (low_[c] - start[c]) / along[c]);
  }
  Way way;
  way.steps = std::max(1, int(std::ceil(reach / step_ - 1e-3f)));
  const float length = reach / float(way.steps);
  way.step = length * along;
  way.at = start + 0.5f * way.step;
  way.length = length * extinction_;
  return way;
}

float VolumeMarcher::opticalDepth(std::uint32_t voxel, const glm::vec3& direction) const {
  Way way = wayFrom(voxel, direction);
  float depth = 0.0f;
  for (int i = 0; i < way.steps && depth < kDark; ++i, way.at += way.step)
    depth += sample(way.at) * way.length;
  return std::min(depth, kDark);
}

void VolumeMarcher::gather(std::uint32_t voxel, const glm::vec3& direction,
                           std::vector<Gathered>& gathered) const {
  Way way = wayFrom(voxel, direction);
  float left = 1.0f;
  for (int i = 0; i < way.steps && left > 6e-6f; ++i, way.at += way.step) {
    const float depth = sample(way.at) * way.length;
    if (depth <= 0.0f) continue;
    const glm::ivec3 at = glm::clamp(glm::ivec3(way.at - 0.5f), glm::ivec3(0), size_ - 1);
    const std::size_t index =
        std::size_t(at.x) +
        std::size_t(size_.x) * (std::size_t(at.y) + std::size_t(size_.y) * std::size_t(at.z));
    const float through = left * std::exp(-depth);
    if (number_[index] != kEmptyVoxel) gathered.push_back({number_[index], left - through});
    left = through;
  }
}

}  // namespace gloam::prt
