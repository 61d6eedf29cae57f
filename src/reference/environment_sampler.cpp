// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tables of a sky for sky_lanes_simd.cpp, which says how directions are chosen.
#include "reference/environment_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sampling.h"
#include "reference/angles.h"
#include "scene/environment.h"

namespace gloam::reference {
namespace {

constexpr float kPi = sampling::kPi;
constexpr double kPiDouble = 3.14159265358979323846;
// A projection is smooth: this grid follows it well. A tenth of all samples is spread evenly, so that nothing is missed where
// it changes its sign between two texels.
constexpr int kProjectionWidth = 128, kProjectionHeight = 64;
constexpr float kEvenShare = 0.1f;

float importanceOf(const glm::vec3& radiance) {
  const glm::vec3 size = glm::abs(radiance);
  return (size.r + size.g + size.b) * (1.0f / 3.0f);
}

constexpr int kMostTexels = 32768;  // each way
constexpr std::int64_t kMostOfAll = std::int64_t(1) << 27;

// The slow twin of findKernel's.
int blockAt(const SkyTable& sky, float x, float y) {
  const int cell_x = int(x), cell_y = int(y);
  int bit = sky.tile_bits;
  std::int32_t entry = sky.tiles[std::size_t((cell_y >> bit) * sky.tiles_across + (cell_x >> bit))];
  while (entry < 0) {
    --bit;
    entry = sky.nodes[std::size_t(~entry + ((cell_y >> bit) & 1) * 2 + ((cell_x >> bit) & 1))];
  }
  return entry;
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, int order) {
  if (environment.empty()) return;
  const auto count = std::int64_t(environment.width) * environment.height;
  if (std::max(environment.width, environment.height) > kMostTexels || count > kMostOfAll)
    throw Error("environment", fmt::format("{} x {} texels; the reference takes {} each way and {} in all",
                                           environment.width, environment.height, kMostTexels, kMostOfAll));
  const Texels texels = order > 0 ? fillProjection(environment, order) : fillPixels(environment);
  fillCells(texels.radiance);
  fillBlocks(sky_, texels.importance);
}

EnvironmentSampler::Texels EnvironmentSampler::fillPixels(const Environment& environment) {
  const int width = sky_.width = environment.width, height = sky_.height = environment.height;
  sky_.cos_rotation = std::cos(environment.rotation_rad);
  sky_.sin_rotation = std::sin(environment.rotation_rad);
  sky_.turned = 0.5f + std::remainder(environment.rotation_rad / (2.0f * kPi), 1.0f);
  Texels texels;
  texels.radiance.reserve(std::size_t(width + 1) * std::size_t(height + 2));
  texels.importance.reserve(texels.radiance.capacity());
  for (int row = 0; row < height + 2; ++row) {
    const int from_row = std::clamp(row - 1, 0, height - 1);
    for (int column = 0; column < width + 1; ++column) {
      const int from_column = (column + width - 1) % width;
      const glm::vec3 radiance =
          environment.intensity *
          environment.radiance[std::size_t(from_row) * std::size_t(width) + std::size_t(from_column)];
      texels.radiance.push_back(packed(radiance));
      texels.importance.push_back(importanceOf(radiance));
    }
  }
  return texels;
}

EnvironmentSampler::Texels EnvironmentSampler::fillProjection(const Environment& environment, int order) {
  projection_ = sh::truncated(projectEnvironment(environment, sh::kMaxOrder), order);
  const int width = sky_.width = kProjectionWidth, height = sky_.height = kProjectionHeight;
  Environment grid;  // for its directions alone
  grid.width = width;
  grid.height = height;
  Texels texels;
  double mean = 0.0;
  for (int row = 0; row < height + 2; ++row) {
    for (int column = 0; column < width + 1; ++column) {
      const glm::vec3 direction =
          texelDirection(grid, (column + width - 1) % width, std::clamp(row - 1, 0, height - 1));
      const float importance = importanceOf(sh::valueAt(projection_, direction));
      texels.importance.push_back(importance);
      mean += double(importance) * double(std::sqrt(std::max(0.0f, 1.0f - direction.y * direction.y)));
    }
  }
  mean *= 0.5 * double(kPi) / (double(width + 1) * double(height + 2));
  if (mean > 0.0)
    for (float& texel : texels.importance) texel += kEvenShare * float(mean);
  return texels;
}

void EnvironmentSampler::fillCells(const std::vector<SkyTexel>& texels) {
  if (texels.empty()) return;
  const std::size_t width = std::size_t(sky_.width + 1), cells = width * std::size_t(sky_.height + 1);
  sky_.texels.reserve(2 * cells);
  for (std::size_t i = 0; i < cells; ++i) {
    sky_.texels.push_back(texels[i]);
    sky_.texels.push_back(texels[i + width]);
  }
}

SkyTexel packed(const glm::vec3& radiance) {
  constexpr int kBits = 18, kBias = 127;
  const float largest = std::max(radiance.r, std::max(radiance.g, radiance.b));
  if (!(largest > 0.0f)) return {};
  int exponent = 0;
  std::frexp(largest, &exponent);
  const int unit = std::clamp(exponent - kBits, 1 - kBias, 254 - kBias);
  const auto part = [&](float c) {
    const float steps = std::nearbyint(std::ldexp(std::max(c, 0.0f), -unit));
    return std::uint32_t(std::min(steps, float((1 << kBits) - 1)));
  };
  const std::uint32_t r = part(radiance.r), g = part(radiance.g), b = part(radiance.b);
  return {r | (g << kBits), (g >> 14) | (b << 4) | (std::uint32_t(unit + kBias) << 22)};
}

glm::vec3 unpacked(const SkyTexel& t) {
  const glm::vec3 steps(float(t.low & 0x3ffffu), float((t.low >> 18) | ((t.high & 15u) << 14)),
                        float((t.high >> 4) & 0x3ffffu));
  return steps * std::ldexp(1.0f, int(t.high >> 22) - 127);
}

void EnvironmentSampler::radiance(const SkyPlaces& places, const LaneVectors& directions, std::uint32_t mask,
                                  LaneVectors& light) const {
  if (projection_.order == 0) return radianceOf(sky_, places, mask, light);
  constexpr std::size_t kMost = std::size_t(sh::kMaxOrder) * std::size_t(sh::kMaxOrder);
  std::array<float, kMost * kLanes> basis;
  sh::evaluateMany(projection_.order, directions.x.at, directions.y.at, directions.z.at, basis, kLanes);
  for (int i = 0; i < kLanes; ++i) {
    glm::vec3 sum(0.0f);
    for (int k = 0; k < projection_.order * projection_.order; ++k)
      sum += projection_[k] * basis[std::size_t(k) * kLanes + std::size_t(i)];
    light.set(i, sum);
  }
}

EnvironmentSampler::Light EnvironmentSampler::from(const glm::vec3& d) const {
  if (black()) return {};
  const int width = sky_.width, height = sky_.height;
  const float cos_elevation = std::sqrt(d.x * d.x + d.z * d.z);
  float turns = angles::turns(d.z, d.x) + sky_.turned;  // 0 to 1 is once round
  turns += (turns < 0.0f ? 1.0f : 0.0f) - (turns >= 1.0f ? 1.0f : 0.0f);
  float x = turns * float(width) + 0.5f;
  x -= x >= float(width) ? float(width) : 0.0f;
  const float elevation = angles::turns(d.y, cos_elevation);
  const float y = std::clamp((0.5f - 2.0f * elevation) * float(height) + 0.5f, 0.5f, float(height) + 0.5f);
  const int cell_x = std::clamp(int(x), 0, width - 1), cell_y = std::clamp(int(y), 0, height);
  const SkyBlock& block = sky_.blocks[std::size_t(blockAt(sky_, x, y))];
  const float across = std::clamp((x - block.x) / std::max(block.across, 1e-6f), 0.0f, 1.0f),
              along = std::clamp((y - block.y) / std::max(block.down, 1e-6f), 0.0f, 1.0f);
  const float density = glm::mix(glm::mix(block.densities[0], block.densities[1], across),
                                 glm::mix(block.densities[2], block.densities[3], across), along);
  const float pdf = density / std::max(cos_elevation, 1e-6f);
  if (projection_.order > 0) return {sh::valueAt(projection_, d), pdf};
  const SkyTexel* t = cell(cell_x, cell_y);
  const float right = x - float(cell_x), down = y - float(cell_y);
  return {glm::mix(glm::mix(unpacked(t[0]), unpacked(t[1]), down),
                   glm::mix(unpacked(t[2]), unpacked(t[3]), down), right),
          pdf};
}

}  // namespace gloam::reference
