// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tables of a sky for sky_lanes_simd.cpp, which says how directions are chosen.
#include "reference/environment_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "math/sampling.h"
#include "reference/angles.h"
#include "reference/distribution.h"
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

// Sine of the elevation at which row r of cells begins, r = 0 … height + 1, from the top down.
double rowSine(int r, int height) {
  const double y = std::clamp(double(r), 0.5, double(height) + 0.5);
  return std::cos((y - 0.5) / height * kPiDouble);
}

constexpr int kMostTexels = 32768;  // each way
constexpr std::int64_t kMostOfAll = std::int64_t(1) << 27;
constexpr int kRowBits = 12;  // of the table of where to begin among rows

// The same for the cells of a row: about as many parts as cells.
int bitsFor(int cells) {
  return std::clamp(int(std::bit_width(unsigned(cells))) - 1, 1, 16);
}

void append(const Distribution& choice, std::vector<std::uint32_t>& starts,
            std::vector<std::uint16_t>& first) {
  starts.insert(starts.end(), choice.starts().begin(), choice.starts().end());
  starts.push_back(0xffffffffu);
  for (const std::uint32_t entry : choice.first()) first.push_back(std::uint16_t(entry));
  first.push_back(std::uint16_t(choice.last()));
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, int order) {
  if (environment.empty()) return;
  const auto texels = std::int64_t(environment.width) * environment.height;
  if (std::max(environment.width, environment.height) > kMostTexels || texels > kMostOfAll)
    throw Error("environment", fmt::format("{} x {} texels; the reference takes {} each way and {} in all",
                                           environment.width, environment.height, kMostTexels, kMostOfAll));
  if (order > 0) {
    fillProjection(environment, order);
  } else {
    fillPixels(environment);
  }
  fillChoices();
}

void EnvironmentSampler::fillPixels(const Environment& environment) {
  const int width = sky_.width = environment.width, height = sky_.height = environment.height;
  sky_.cos_rotation = std::cos(environment.rotation_rad);
  sky_.sin_rotation = std::sin(environment.rotation_rad);
  sky_.turned = 0.5f + std::remainder(environment.rotation_rad / (2.0f * kPi), 1.0f);
  std::vector<glm::vec4> texels;  // with a border around
  texels.reserve(std::size_t(width + 1) * std::size_t(height + 2));
  for (int row = 0; row < height + 2; ++row) {
    const int from_row = std::clamp(row - 1, 0, height - 1);
    for (int column = 0; column < width + 1; ++column) {
      const int from_column = (column + width - 1) % width;
      const glm::vec3 radiance =
          environment.intensity *
          environment.radiance[std::size_t(from_row) * std::size_t(width) + std::size_t(from_column)];
      texels.emplace_back(radiance, importanceOf(radiance));
    }
  }
  fillTexels(texels);
}

void EnvironmentSampler::fillProjection(const Environment& environment, int order) {
  projection_ = sh::truncated(projectEnvironment(environment, sh::kMaxOrder), order);
  const int width = sky_.width = kProjectionWidth, height = sky_.height = kProjectionHeight;
  Environment grid;  // for its directions alone
  grid.width = width;
  grid.height = height;
  std::vector<glm::vec4> texels;
  double mean = 0.0;
  for (int row = 0; row < height + 2; ++row) {
    for (int column = 0; column < width + 1; ++column) {
      const glm::vec3 direction =
          texelDirection(grid, (column + width - 1) % width, std::clamp(row - 1, 0, height - 1));
      const float importance = importanceOf(sh::valueAt(projection_, direction));
      texels.emplace_back(0.0f, 0.0f, 0.0f, importance);
      mean += double(importance) * double(std::sqrt(std::max(0.0f, 1.0f - direction.y * direction.y)));
    }
  }
  mean *= 0.5 * double(kPi) / (double(width + 1) * double(height + 2));
  if (mean > 0.0)
    for (glm::vec4& texel : texels) texel.w += kEvenShare * float(mean);
  fillTexels(texels);
}

void EnvironmentSampler::fillTexels(const std::vector<glm::vec4>& texels) {
  const std::size_t width = std::size_t(sky_.width + 1), cells = width * std::size_t(sky_.height + 1);
  sky_.texels.reserve(2 * cells);
  for (std::size_t i = 0; i < cells; ++i) {
    sky_.texels.push_back(texels[i]);
    sky_.texels.push_back(texels[i + width]);
  }
}

void EnvironmentSampler::fillChoices() {
  const int width = sky_.width, height = sky_.height;
  const float half_angle = std::sin(0.25f * kPi / float(height));
  sky_.polar_height = 2.0f * half_angle * half_angle;
  const int cell_bits = bitsFor(width), row_bits = kRowBits;
  sky_.cell_shift = 32 - cell_bits;
  sky_.row_shift = 32 - row_bits;
  std::vector<float> cells(static_cast<std::size_t>(width)), rows;
  std::vector<double> density;
  double total = 0.0;
  for (int r = 0; r <= height; ++r) {
    double sum = 0.0;
    for (int c = 0; c < width; ++c) {
      const glm::vec4* t = cell(c, r);
      const double mean = 0.25 * (double(t[0].w) + double(t[1].w) + double(t[2].w) + double(t[3].w));
      cells[std::size_t(c)] = float(mean);
      sum += mean;
    }
    const double sines = rowSine(r, height) - rowSine(r + 1, height);
    rows.push_back(float(2.0 * kPiDouble / width * sines * sum));
    total += 2.0 * kPiDouble / width * sines * sum;
    const bool pole = r == 0 || r == height;
    density.push_back(pole ? 1.0 : sines * height / kPiDouble);
    append(Distribution(cells, cell_bits), sky_.cell_starts, sky_.cell_first);
  }
  const Distribution choice(rows, row_bits);
  if (choice.empty()) return;
  append(choice, sky_.row_starts, sky_.row_first);
  sky_.row_first.push_back(0);
  sky_.cell_first.push_back(0);
  for (const double row : density) sky_.density.push_back(float(row / total));
}

void EnvironmentSampler::at(const SkyPlaces& places, const LaneVectors& directions, std::uint32_t mask,
                            SkyLight& light) const {
  lightAt(sky_, places, mask, light);
  if (projection_.order == 0) return;
  constexpr std::size_t kMost = std::size_t(sh::kMaxOrder) * std::size_t(sh::kMaxOrder);
  std::array<float, kMost * kLanes> basis;
  sh::evaluateMany(projection_.order, directions.x.at, directions.y.at, directions.z.at, basis, kLanes);
  for (int i = 0; i < kLanes; ++i) {
    glm::vec3 sum(0.0f);
    for (int k = 0; k < projection_.order * projection_.order; ++k)
      sum += projection_[k] * basis[std::size_t(k) * kLanes + std::size_t(i)];
    light.radiance.set(i, sum);
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
  const glm::vec4* t = cell(cell_x, cell_y);
  const float right = x - float(cell_x), down = y - float(cell_y);
  const glm::vec4 light = glm::mix(glm::mix(t[0], t[1], down), glm::mix(t[2], t[3], down), right);
  float pdf = light.w * sky_.density[std::size_t(cell_y)];
  if (cell_y > 0 && cell_y < height) pdf /= std::max(cos_elevation, 1e-6f);
  return {projection_.order > 0 ? sh::valueAt(projection_, d) : glm::vec3(light), pdf};
}

}  // namespace gloam::reference
