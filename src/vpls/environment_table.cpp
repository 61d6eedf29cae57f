// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Importance of a texel: half by its power, half by that power where radiance above the mean is cut down to the mean.
#include "vpls/environment_table.h"

#include <numbers>

#include "math/sampling.h"

namespace gloam::vpls {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

double sizeOf(const glm::vec3& v) {
  return (double(v.r) + double(v.g) + double(v.b)) / 3.0;
}

double discSolidAngle(const frame::DiscRow& disc) {
  const double half = std::sin(0.5 * double(disc.radius_rad));
  return 4.0 * std::numbers::pi * half * half;
}

/// sine of the latitude at a row's upper edge; row 0 is the top.
double upperEdge(int row, int height) {
  return std::sin(std::numbers::pi * (0.5 - double(row) / double(height)));
}

}  // namespace

EnvironmentTable::EnvironmentTable(const frame::EnvironmentLight& environment) {
  if (environment.empty()) return;
  const frame::EnvironmentPicture& picture = environment.picture();
  const gpu::Image& map = picture.map();
  int mip = 0;
  while (mip + 1 < map.desc().mips && map.width() >> mip > kEnvironmentWidth) ++mip;
  width_ = std::max(1, map.width() >> mip);
  height_ = std::max(1, map.height() >> mip);
  discs_ = picture.discs();
  const glm::vec3 exact = environment.sh()[0] * std::sqrt(4.0f * kPi);  // the integral over the sphere
  fill(map.downloadFloats(mip), picture.row(), exact);
}

void EnvironmentTable::fill(const std::vector<float>& texels, const frame::EnvironmentRow& row,
                            const glm::vec3& exact) {
  cos_rotation_ = row.cos_rotation;
  sin_rotation_ = row.sin_rotation;
  std::vector<double> solid_angle;  // of a texel, by row
  for (int y = 0; y < height_; ++y)
    solid_angle.push_back((upperEdge(y, height_) - upperEdge(y + 1, height_)) * 2.0 * std::numbers::pi /
                          double(width_));
  glm::dvec3 total(0.0);
  float brightest = 0.0f;
  for (std::size_t i = 0; i < std::size_t(width_) * std::size_t(height_); ++i) {
    const glm::vec3 texel =
        row.intensity * glm::max(glm::vec3(texels[4 * i], texels[4 * i + 1], texels[4 * i + 2]), 0.0f);
    radiance_.push_back(texel);
    total += solid_angle[i / std::size_t(width_)] * glm::dvec3(texel);
    brightest = std::max(brightest, float(sizeOf(texel)));
  }
  double disc_size = 0.0;
  for (const frame::DiscRow& disc : discs_) {
    total += discSolidAngle(disc) * glm::dvec3(disc.radiance);
    disc_size += discSolidAngle(disc) * sizeOf(disc.radiance);
  }
  // Half floats end at 65504: what a sun lost there goes back to the brightest texels.
  const glm::dvec3 lost = glm::dvec3(exact) - total;
  if (brightest > 0.0f && sizeOf(glm::vec3(lost)) > 0.005 * sizeOf(exact)) {
    double share = 0.0;
    const auto isBright = [&](std::size_t i) { return sizeOf(radiance_[i]) >= 0.5 * double(brightest); };
    for (std::size_t i = 0; i < radiance_.size(); ++i)
      share += isBright(i) ? solid_angle[i / std::size_t(width_)] : 0.0;
    std::vector<std::size_t> bright;
    for (std::size_t i = 0; i < radiance_.size(); ++i) {
      if (isBright(i)) bright.push_back(i);
    }
    for (const std::size_t i : bright) radiance_[i] += glm::max(glm::vec3(lost / share), -radiance_[i]);
    total += lost;
  }
  total_ = glm::vec3(total);
  // Importance, apart for all power and for power cut at the mean.
  const double all = sizeOf(total_), mean = all / (4.0 * std::numbers::pi);
  double cut = 0.0;
  for (std::size_t i = 0; i < radiance_.size(); ++i)
    cut += solid_angle[i / std::size_t(width_)] * std::min(sizeOf(radiance_[i]), mean);
  if (!(all > 0.0)) return;
  std::vector<double> rows, columns(static_cast<std::size_t>(width_));
  for (std::size_t y = 0; y < std::size_t(height_); ++y) {
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const double size = sizeOf(radiance_[y * columns.size() + x]);
      columns[x] = solid_angle[y] * (0.5 * size / all + (cut > 0.0 ? 0.5 * std::min(size, mean) / cut : 0.0));
    }
    columns_.emplace_back(columns);
    rows.push_back(columns_.back().total());
  }
  for (const frame::DiscRow& disc : discs_)
    rows.push_back(discSolidAngle(disc) * sizeOf(disc.radiance) * (cut > 0.0 ? 0.5 : 1.0) / all);
  rows_ = Choice(rows);
}

glm::vec3 EnvironmentTable::texelDirection(float column, float sine) const {
  const float angle = (column / float(width_) - 0.5f) * 2.0f * kPi;
  const float across = std::sqrt(std::max(0.0f, 1.0f - sine * sine));
  const float x = across * std::cos(angle), z = across * std::sin(angle);
  return {cos_rotation_ * x + sin_rotation_ * z, sine, cos_rotation_ * z - sin_rotation_ * x};
}

EnvironmentTable::Sample EnvironmentTable::sample(const glm::vec2& u) const {
  const Choice::Chosen row = rows_.choose(u.x);
  if (row.probability <= 0.0f) return {};
  if (row.index >= std::size_t(height_)) {
    const frame::DiscRow& disc = discs_[row.index - std::size_t(height_)];
    const glm::vec3 local = sampling::uniformCone({row.rest, u.y}, std::cos(disc.radius_rad));
    return {sampling::frame(disc.direction) * local,
            float(discSolidAngle(disc)) / row.probability * disc.radiance};
  }
  const Choice::Chosen column = columns_[row.index].choose(u.y);
  const double upper = upperEdge(int(row.index), height_), lower = upperEdge(int(row.index) + 1, height_);
  const double solid_angle = (upper - lower) * 2.0 * std::numbers::pi / double(width_);
  const glm::vec3 direction =
      texelDirection(float(column.index) + column.rest, float(upper + (lower - upper) * double(row.rest)));
  const glm::vec3& radiance = radiance_[row.index * std::size_t(width_) + column.index];
  return {direction, float(solid_angle / (double(row.probability) * double(column.probability))) * radiance};
}

}  // namespace gloam::vpls
