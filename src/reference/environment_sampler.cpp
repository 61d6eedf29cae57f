// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sphere is cut into cells between the centres of four texels, in each of which the light is bilinear. A cell is chosen
// by its mean times its solid angle, a place within it by the bilinear function itself: so the density follows the light,
// but for the change of the cosine within a row. The half cells at the poles are constant upward and are sampled by solid
// angle. The density is importance / total / cos(elevation) times a factor of the row.
//
// Random places of a large picture are far away in memory. So the first choice is among blocks of 4 x 4 cells, from tables
// small enough to stay near; all else follows from the block's own texels, which are fetched while paths do something else.
#include "reference/environment_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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

// Four floats in one register.
using Four = float __attribute__((vector_size(16)));
Four four(const glm::vec4& v) {
  Four result;
  std::memcpy(&result, &v, sizeof result);
  return result;
}

// Where between 0 and 1 a density that goes linearly from a to b has the share u below it.
float sampleLinear(float a, float b, float u) {
  const float sum = a + b;
  if (!(sum > 0.0f)) return u;
  return std::min(u * sum / (a + std::sqrt(glm::mix(a * a, b * b, u))), 1.0f);
}

// Which of four parts holds what is left of their sum, and what is left in it, 0 to 1.
struct Part {
  int index;
  float rest;
};
Part partOf(const float* parts, float rest) {
  float before = 0.0f, sum = 0.0f;
  int index = 0;
  for (int i = 0; i < 3; ++i) {
    sum += parts[i];
    const bool beyond = rest >= sum && sum + parts[i + 1] > sum;
    index = beyond ? i + 1 : index;
    before = beyond ? sum : before;
  }
  const float size = parts[index];
  return {index, size > 0.0f ? std::clamp((rest - before) / size, 0.0f, 1.0f) : 0.5f};
}

float importanceOf(const glm::vec3& radiance) {
  const glm::vec3 size = glm::abs(radiance);
  return (size.r + size.g + size.b) * (1.0f / 3.0f);
}

// Sine of the elevation at which row r of cells begins, r = 0 … height + 1, from the top down.
double rowSine(int r, int height) {
  const double y = std::clamp(double(r), 0.5, double(height) + 0.5);
  return std::cos((y - 0.5) / height * kPiDouble);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, int order) {
  if (environment.empty()) return;
  if (order > 0) {
    fillProjection(environment, order);
  } else {
    fillPixels(environment);
  }
  fillRows();
  fillBlocks();
}

void EnvironmentSampler::fillPixels(const Environment& environment) {
  width_ = environment.width;
  height_ = environment.height;
  cos_rotation_ = std::cos(environment.rotation_rad);
  sin_rotation_ = std::sin(environment.rotation_rad);
  turned_ = 0.5f + std::remainder(environment.rotation_rad / (2.0f * kPi), 1.0f);
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
  turned_ = 0.5f;
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

void EnvironmentSampler::fillRows() {
  const float half_angle = std::sin(0.25f * kPi / float(height_));
  polar_height_ = 2.0f * half_angle * half_angle;
  for (int r = 0; r <= height_; ++r) {
    const double sines = rowSine(r, height_) - rowSine(r + 1, height_);
    const bool pole = r == 0 || r == height_;
    rows_.push_back(
        {float(2.0 * kPiDouble / width_ * sines), float(pole ? 1.0 : sines * height_ / kPiDouble)});
  }
}

void EnvironmentSampler::fillBlocks() {
  block_columns_ = (width_ + kBlock - 1) / kBlock;
  const int block_rows = (height_ + kBlock) / kBlock;
  std::vector<float> row_weights;
  double total = 0.0;
  for (int block_row = 0; block_row < block_rows; ++block_row) {
    std::vector<double> sums(std::size_t(block_columns_), 0.0);
    for (int r = block_row * kBlock; r < std::min((block_row + 1) * kBlock, height_ + 1); ++r) {
      for (int c = 0; c < width_; ++c) {
        const glm::vec4 *upper = texel(c, r), *lower = texel(c, r + 1);
        sums[std::size_t(c / kBlock)] +=
            0.25 * (double(upper[0].w) + double(upper[1].w) + double(lower[0].w) + double(lower[1].w)) *
            double(rows_[std::size_t(r)].solid_angle);
      }
    }
    double row_sum = 0.0;
    std::vector<float> weights;
    for (const double sum : sums) {
      row_sum += sum;
      weights.push_back(float(sum));
      lit_.push_back(sum > 0.0 ? 1 : 0);
    }
    blocks_.emplace_back(weights);
    row_weights.push_back(float(row_sum));
    total += row_sum;
  }
  block_rows_ = Distribution(row_weights);
  for (Row& row : rows_) row.density = total > 0.0 ? float(double(row.density) / total) : 0.0f;
}

void EnvironmentSampler::prefetch(int cell_x, int cell_y, int rows) const {
  for (int r = 0; r < rows; ++r) {
    const char* from = reinterpret_cast<const char*>(texel(cell_x, cell_y + r));
    __builtin_prefetch(from);
    if (rows > 2) __builtin_prefetch(from + kBlock * sizeof(glm::vec4));
  }
}

EnvironmentSampler::Light EnvironmentSampler::at(const Place& place, const glm::vec3& direction) const {
  const glm::vec4 *upper = texel(place.cell_x, place.cell_y), *lower = upper + width_ + 1;
  const Four upper_left = four(upper[0]), upper_right = four(upper[1]);
  const Four left = upper_left + (four(lower[0]) - upper_left) * place.y;
  const Four right = upper_right + (four(lower[1]) - upper_right) * place.y;
  const Four light = left + (right - left) * place.x;
  float pdf = light[3] * rows_[std::size_t(place.cell_y)].density;
  if (place.cell_y > 0 && place.cell_y < height_) pdf /= std::max(place.cos_elevation, 1e-6f);
  return {
      projection_.order > 0 ? sh::valueAt(projection_, direction) : glm::vec3(light[0], light[1], light[2]),
      pdf};
}

EnvironmentSampler::Place EnvironmentSampler::placeOf(float longitude, float elevation,
                                                      float cos_elevation) const {
  float turns = longitude + turned_;  // 0 to 1 is once round
  turns += (turns < 0.0f ? 1.0f : 0.0f) - (turns >= 1.0f ? 1.0f : 0.0f);
  float x = turns * float(width_) + 0.5f;
  x -= x >= float(width_) ? float(width_) : 0.0f;
  const float y = std::clamp((0.5f - 2.0f * elevation) * float(height_) + 0.5f, 0.5f, float(height_) + 0.5f);
  const int cell_x = std::clamp(int(x), 0, width_ - 1), cell_y = std::clamp(int(y), 0, height_);
  prefetch(cell_x, cell_y, 2);
  return {cell_x, cell_y, x - float(cell_x), y - float(cell_y), cos_elevation};
}

EnvironmentSampler::Place EnvironmentSampler::place(const glm::vec3& d) const {
  const float cos_elevation = std::sqrt(d.x * d.x + d.z * d.z);
  return placeOf(angles::turns(d.z, d.x), angles::turns(d.y, cos_elevation), cos_elevation);
}

void EnvironmentSampler::places(const LaneVectors& directions, int count, Place* places) const {
  LaneFloats longitude, elevation, cos_elevation;
  anglesOfLanes(directions, longitude, elevation, cos_elevation);
  for (int i = 0; i < count; ++i) places[i] = placeOf(longitude.at[i], elevation.at[i], cos_elevation.at[i]);
}

EnvironmentSampler::Block EnvironmentSampler::choose(const glm::uvec2& numbers) const {
  const Distribution::Choice row = block_rows_.choose(numbers.y);
  const Distribution::Choice column = blocks_[row.index].choose(numbers.x);
  prefetch(int(column.index) * kBlock, int(row.index) * kBlock,
           std::min(kBlock + 1, height_ + 2 - int(row.index) * kBlock));
  return {int(column.index), int(row.index), column.rest, row.rest};
}

// The cell and the place in it; what is left of the block's numbers chooses on.
EnvironmentSampler::Place EnvironmentSampler::placeIn(const Block& block) const {
  const int x0 = block.column * kBlock, y0 = block.row * kBlock;
  const int columns = std::min(kBlock, width_ - x0), rows = std::min(kBlock, height_ + 1 - y0);
  float pairs[kBlock + 1][kBlock] = {}, of_rows[kBlock] = {}, of_cells[kBlock] = {};
  for (int r = 0; r <= rows; ++r) {
    const glm::vec4* t = texel(x0, y0 + r);
    for (int c = 0; c < columns; ++c) pairs[r][c] = t[c].w + t[c + 1].w;
  }
  float total = 0.0f;
  for (int r = 0; r < rows; ++r) {
    float sum = 0.0f;
    for (int c = 0; c < kBlock; ++c) sum += pairs[r][c] + pairs[r + 1][c];
    of_rows[r] = sum * rows_[std::size_t(y0 + r)].solid_angle;
    total += of_rows[r];
  }
  const Part row = partOf(of_rows, block.rest_y * total);
  float row_total = 0.0f;
  for (int c = 0; c < kBlock; ++c) {
    of_cells[c] = pairs[row.index][c] + pairs[row.index + 1][c];
    row_total += of_cells[c];
  }
  const Part column = partOf(of_cells, block.rest_x * row_total);
  return {x0 + column.index, y0 + row.index, column.rest, row.rest, 0.0f};
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const Block& block) const {
  Place place = placeIn(block);
  const glm::vec4 *upper = texel(place.cell_x, place.cell_y), *lower = upper + width_ + 1;
  float sin_elevation;
  if (place.cell_y == 0 || place.cell_y == height_) {
    const float below = polar_height_ * (place.cell_y == 0 ? place.y : 1.0f - place.y);  // 1 - |sine|
    sin_elevation = place.cell_y == 0 ? 1.0f - below : below - 1.0f;
    place.cos_elevation = std::sqrt(below * (2.0f - below));
    place.y = 0.5f;  // the same all over
  } else {
    place.y = sampleLinear(upper[0].w + upper[1].w, lower[0].w + lower[1].w, place.y);
    const float down = (float(place.cell_y) + place.y - 0.5f) / float(height_);
    const angles::Circle elevation = angles::circle(0.25f - 0.5f * down);
    sin_elevation = elevation.sine;
    place.cos_elevation = elevation.cosine;
  }
  place.x = sampleLinear(glm::mix(upper[0].w, lower[0].w, place.y), glm::mix(upper[1].w, lower[1].w, place.y),
                         place.x);
  const angles::Circle azimuth =
      angles::circle((float(place.cell_x) + place.x - 0.5f) / float(width_) - 0.5f);
  const float local_x = place.cos_elevation * azimuth.cosine, local_z = place.cos_elevation * azimuth.sine;
  Sample result;
  result.direction = {cos_rotation_ * local_x + sin_rotation_ * local_z, sin_elevation,
                      cos_rotation_ * local_z - sin_rotation_ * local_x};
  result.light = at(place, result.direction);
  return result;
}

}  // namespace gloam::reference
