// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sphere is cut into cells between the centres of four texels, in each of which the light is bilinear. A cell is chosen
// by its mean times its solid angle, a place within it by the bilinear function itself: so the density follows the light,
// but for the change of the cosine within a row. The half cells at the poles are constant upward and are sampled by solid
// angle. The density is importance / total / cos(elevation) times a factor of the row.
#include "reference/environment_sampler.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "reference/sampler.h"
#include "scene/environment.h"

namespace gloam::reference {
namespace {

constexpr float kPi = sampling::kPi;
// A projection is smooth: this grid follows it well. A tenth of all samples is spread evenly, so that nothing is missed where
// it changes its sign between two texels.
constexpr int kProjectionWidth = 128, kProjectionHeight = 64;
constexpr float kEvenShare = 0.1f;

// Where between 0 and 1 a density that goes linearly from a to b has the share u below it.
float sampleLinear(float a, float b, float u) {
  const float sum = a + b;
  if (!(sum > 0.0f)) return u;
  return std::min(u * sum / (a + std::sqrt(glm::mix(a * a, b * b, u))), 1.0f);
}

float importanceOf(const glm::vec3& radiance) {
  const glm::vec3 size = glm::abs(radiance);
  return (size.r + size.g + size.b) * (1.0f / 3.0f);
}

// Sine of the elevation at which row r of cells begins, r = 0 … height + 1, from the top down.
double rowSine(int r, int height) {
  const double y = std::clamp(double(r), 0.5, double(height) + 0.5);
  return std::cos((y - 0.5) / height * 3.14159265358979323846);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, int order) {
  if (environment.empty()) return;
  if (order > 0) {
    fillProjection(environment, order);
  } else {
    fillPixels(environment);
  }
  finish();
}

void EnvironmentSampler::fillPixels(const Environment& environment) {
  width_ = environment.width;
  height_ = environment.height;
  cos_rotation_ = std::cos(environment.rotation_rad);
  sin_rotation_ = std::sin(environment.rotation_rad);
  texels_.resize(std::size_t(width_ + 1) * std::size_t(height_ + 2));
  for (int row = 0; row < height_ + 2; ++row) {
    const int from_row = std::clamp(row - 1, 0, height_ - 1);
    for (int column = 0; column < width_ + 1; ++column) {
      const int from_column = (column + width_ - 1) % width_;
      const glm::vec3 radiance =
          environment.intensity *
          environment.radiance[std::size_t(from_row) * std::size_t(width_) + std::size_t(from_column)];
      texels_[std::size_t(row) * std::size_t(width_ + 1) + std::size_t(column)] =
          glm::vec4(radiance, importanceOf(radiance));
    }
  }
}

void EnvironmentSampler::fillProjection(const Environment& environment, int order) {
  projection_ = sh::truncated(projectEnvironment(environment, sh::kMaxOrder), order);
  width_ = kProjectionWidth;
  height_ = kProjectionHeight;
  Environment grid;  // for its directions alone
  grid.width = width_;
  grid.height = height_;
  texels_.resize(std::size_t(width_ + 1) * std::size_t(height_ + 2));
  double mean = 0.0;
  for (int row = 0; row < height_ + 2; ++row) {
    for (int column = 0; column < width_ + 1; ++column) {
      const glm::vec3 direction =
          texelDirection(grid, (column + width_ - 1) % width_, std::clamp(row - 1, 0, height_ - 1));
      const float importance = importanceOf(sh::valueAt(projection_, direction));
      texels_[std::size_t(row) * std::size_t(width_ + 1) + std::size_t(column)] =
          glm::vec4(0.0f, 0.0f, 0.0f, importance);
      mean += double(importance) * double(std::sqrt(std::max(0.0f, 1.0f - direction.y * direction.y)));
    }
  }
  mean *= 0.5 * double(kPi) / (double(width_ + 1) * double(height_ + 2));
  if (mean > 0.0)
    for (glm::vec4& texel : texels_) texel.w += kEvenShare * float(mean);
}

void EnvironmentSampler::finish() {
  std::vector<float> cells, row_weights;
  cells.resize(std::size_t(width_));
  row_weights.resize(std::size_t(height_) + 1);
  rows_.reserve(row_weights.size());
  double total = 0.0;
  for (int r = 0; r <= height_; ++r) {
    const glm::vec4* upper = &texels_[std::size_t(r) * std::size_t(width_ + 1)];
    const glm::vec4* lower = upper + width_ + 1;
    double sum = 0.0;
    for (int c = 0; c < width_; ++c) {
      cells[std::size_t(c)] = 0.25f * (upper[c].w + upper[c + 1].w + lower[c].w + lower[c + 1].w);
      sum += double(cells[std::size_t(c)]);
    }
    rows_.emplace_back(cells);
    const double solid_angle = 2.0 * double(kPi) / width_ * (rowSine(r, height_) - rowSine(r + 1, height_));
    row_weights[std::size_t(r)] = float(sum * solid_angle);
    total += sum * solid_angle;
  }
  marginal_ = Distribution(row_weights);
  const float half_angle = std::sin(0.25f * kPi / float(height_));
  polar_height_ = 2.0f * half_angle * half_angle;
  row_density_.assign(row_weights.size(), 0.0f);
  for (int r = 0; r <= height_; ++r) {
    const bool pole = r == 0 || r == height_;
    const double step = double(kPi) / height_;
    const double factor = pole ? 1.0 : (rowSine(r, height_) - rowSine(r + 1, height_)) / step;
    if (total > 0.0) row_density_[std::size_t(r)] = float(factor / total);
  }
}

glm::vec4 EnvironmentSampler::interpolated(const Place& place) const {
  const glm::vec4* upper =
      &texels_[std::size_t(place.cell_y) * std::size_t(width_ + 1) + std::size_t(place.cell_x)];
  const glm::vec4* lower = upper + width_ + 1;
  const glm::vec4 left = upper[0] + (lower[0] - upper[0]) * place.y;
  const glm::vec4 right = upper[1] + (lower[1] - upper[1]) * place.y;
  return left + (right - left) * place.x;
}

EnvironmentSampler::Light EnvironmentSampler::lightAt(const Place& place, const glm::vec3& direction,
                                                      float cos_elevation) const {
  const glm::vec4 light = interpolated(place);
  float pdf = light.w * row_density_[std::size_t(place.cell_y)];
  if (place.cell_y > 0 && place.cell_y < height_) pdf /= std::max(cos_elevation, 1e-6f);
  return {projection_.order > 0 ? sh::valueAt(projection_, direction) : glm::vec3(light), pdf};
}

EnvironmentSampler::Light EnvironmentSampler::from(const glm::vec3& d) const {
  if (black()) return {};
  const glm::vec3 local(cos_rotation_ * d.x - sin_rotation_ * d.z, d.y,
                        sin_rotation_ * d.x + cos_rotation_ * d.z);
  const float cos_elevation = std::sqrt(local.x * local.x + local.z * local.z);
  const float u = std::atan2(local.z, local.x) * (0.5f / kPi) + 0.5f;
  const float down = 0.5f - std::atan2(local.y, cos_elevation) * (1.0f / kPi);
  float x = u * float(width_) + 0.5f;
  if (x >= float(width_)) x -= float(width_);
  const float y = std::clamp(down * float(height_) + 0.5f, 0.5f, float(height_) + 0.5f);
  const int cell_x = std::clamp(int(x), 0, width_ - 1), cell_y = std::clamp(int(y), 0, height_);
  return lightAt({cell_x, cell_y, x - float(cell_x), y - float(cell_y)}, d, cos_elevation);
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const glm::uvec2& numbers) const {
  if (black()) return {};
  const Distribution::Choice row = marginal_.choose(numbers.y);
  const Distribution::Choice column = rows_[row.index].choose(numbers.x);
  Place place{int(column.index), int(row.index), 0.0f, 0.0f};
  const glm::vec4* upper = &texels_[std::size_t(row.index) * std::size_t(width_ + 1) + column.index];
  const glm::vec4* lower = upper + width_ + 1;
  float cos_elevation, sin_elevation;
  if (place.cell_y == 0 || place.cell_y == height_) {
    const float below = polar_height_ * (place.cell_y == 0 ? row.rest : 1.0f - row.rest);  // 1 - |sine|
    sin_elevation = place.cell_y == 0 ? 1.0f - below : below - 1.0f;
    cos_elevation = std::sqrt(below * (2.0f - below));
    place.y = 0.5f;  // the same all over
  } else {
    place.y = sampleLinear(upper[0].w + upper[1].w, lower[0].w + lower[1].w, row.rest);
    const float elevation = kPi * (0.5f - (float(place.cell_y) + place.y - 0.5f) / float(height_));
    sin_elevation = std::sin(elevation);
    cos_elevation = std::cos(elevation);
  }
  place.x = sampleLinear(glm::mix(upper[0].w, lower[0].w, place.y), glm::mix(upper[1].w, lower[1].w, place.y),
                         column.rest);
  const float phi = 2.0f * kPi * ((float(place.cell_x) + place.x - 0.5f) / float(width_) - 0.5f);
  const glm::vec3 local(cos_elevation * std::cos(phi), sin_elevation, cos_elevation * std::sin(phi));
  Sample result;
  result.direction = {cos_rotation_ * local.x + sin_rotation_ * local.z, local.y,
                      cos_rotation_ * local.z - sin_rotation_ * local.x};
  result.light = lightAt(place, result.direction, cos_elevation);
  return result;
}

}  // namespace gloam::reference
