// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Cells that the surface crosses take the share of 2^3 points inside by winding number; others one point, whole blocks of
// them at once where the surface is closed.
#include "spheres/occupancy.h"

#include <gloam/error.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace gloam::spheres {
namespace {

constexpr int kBlock = 4;
constexpr int kSubdivisions = 2;  // of a surface cell each way
constexpr int kMargin = 1;        // empty cells around the solid
constexpr float kRowsPerRadius = 6.0f;

}  // namespace

Occupancy::Occupancy(const Soup& soup, const WindingTree& winding, int cells, bool closed, bool shell,
                     const std::function<bool()>& should_stop) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const std::uint32_t i : soup.indices) {
    low = glm::min(low, soup.positions[i]), high = glm::max(high, soup.positions[i]);
  }
  const glm::vec3 extent = high - low;
  cell_ = std::max({extent.x, extent.y, extent.z}) / float(cells);
  size_ = glm::ivec3(glm::ceil(extent / cell_)) + 2 * kMargin;
  low_ = (low + high) * 0.5f - glm::vec3(size_) * (0.5f * cell_);
  const std::size_t count = std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z);
  shares_.assign(count, 0.0f);
  std::vector<std::uint8_t> surface(count, 0);
  markSurface(soup, surface);
  if (shell) {
    std::copy(surface.begin(), surface.end(), shares_.begin());
  } else {
    const glm::ivec3 blocks = (size_ + kBlock - 1) / kBlock;
    std::atomic<bool> stopped{false};
    tbb::parallel_for(0, blocks.z * blocks.y, [&](int row) {
      if (stopped) return;
      if (should_stop && should_stop()) stopped = true;
      for (int x = 0; x < blocks.x; ++x)
        fillBlock({x, row % blocks.y, row / blocks.y}, winding, surface, closed);
    });
    if (stopped) throw Interrupted("interrupted: no sphere set");
  }
  sumRows();
}

std::vector<glm::vec3> Occupancy::fullCells() const {
  std::vector<glm::vec3> centers;
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      for (int x = 0; x < size_.x; ++x) {
        if (share({x, y, z}) >= 0.999f) centers.push_back(low_ + (glm::vec3(x, y, z) + 0.5f) * cell_);
      }
    }
  }
  return centers;
}

void Occupancy::markSurface(const Soup& soup, std::vector<std::uint8_t>& surface) const {
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    markTriangle((soup.corner(t, 0) - low_) / cell_, (soup.corner(t, 1) - low_) / cell_,
                 (soup.corner(t, 2) - low_) / cell_, surface);
  }
}

// In cells. Long triangles are halved until the box round each holds few cells.
void Occupancy::markTriangle(glm::vec3 a, glm::vec3 b, glm::vec3 c,
                             std::vector<std::uint8_t>& surface) const {
  const glm::vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
  const glm::vec3 extent = high - low;
  if (std::max({extent.x, extent.y, extent.z}) > 4.0f) {
    const float ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    if (bc >= ab && bc >= ca) std::swap(a, c), std::swap(a, b);  // the longest edge becomes a-b
    if (ca > ab && ca > bc) std::swap(b, c);
    const glm::vec3 middle = 0.5f * (a + b);
    markTriangle(a, middle, c, surface);
    markTriangle(middle, b, c, surface);
    return;
  }
  const glm::vec3 normal = glm::cross(b - a, c - a);
  const float length = glm::length(normal);
  const glm::ivec3 first = glm::clamp(glm::ivec3(glm::floor(low)), glm::ivec3(0), size_ - 1);
  const glm::ivec3 last = glm::clamp(glm::ivec3(glm::floor(high)), glm::ivec3(0), size_ - 1);
  const float reach = 0.5f * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)) + 1e-4f * length;
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const glm::vec3 middle = glm::vec3(x, y, z) + 0.5f;
        if (std::abs(glm::dot(normal, middle - a)) <= reach) surface[index({x, y, z})] = 1;
      }
    }
  }
}

float Occupancy::sampledShare(const glm::ivec3& at, const WindingTree& winding) const {
  int inside = 0;
  for (int i = 0; i < kSubdivisions * kSubdivisions * kSubdivisions; ++i) {
    const glm::ivec3 part(i % kSubdivisions, i / kSubdivisions % kSubdivisions,
                          i / kSubdivisions / kSubdivisions);
    const glm::vec3 offset = (glm::vec3(part) + 0.5f) / float(kSubdivisions);
    inside += winding.inside(low_ + (glm::vec3(at) + offset) * cell_) ? 1 : 0;
  }
  return float(inside) / float(kSubdivisions * kSubdivisions * kSubdivisions);
}

void Occupancy::fillBlock(const glm::ivec3& block, const WindingTree& winding,
                          const std::vector<std::uint8_t>& surface, bool whole_blocks) {
  const glm::ivec3 first = block * kBlock, last = glm::min(first + kBlock, size_);
  const auto eachCell = [&](const auto& visit) {
    for (int z = first.z; z < last.z; ++z) {
      for (int y = first.y; y < last.y; ++y) {
        for (int x = first.x; x < last.x; ++x) visit(glm::ivec3(x, y, z));
      }
    }
  };
  bool touched = false;
  eachCell([&](const glm::ivec3& at) { touched = touched || surface[index(at)] != 0; });
  if (!touched && whole_blocks) {
    const float share = winding.inside(low_ + glm::vec3(first + last) * (0.5f * cell_)) ? 1.0f : 0.0f;
    eachCell([&](const glm::ivec3& at) { shares_[index(at)] = share; });
    return;
  }
  eachCell([&](const glm::ivec3& at) {
    const std::size_t i = index(at);
    shares_[i] = surface[i] != 0 ? sampledShare(at, winding)
                                 : (winding.inside(low_ + (glm::vec3(at) + 0.5f) * cell_) ? 1.0f : 0.0f);
  });
}

void Occupancy::sumRows() {
  const std::size_t rows = std::size_t(size_.y) * std::size_t(size_.z), width = std::size_t(size_.x);
  outside_before_.resize(rows * (width + 1));
  double inside = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    float* sums = &outside_before_[row * (width + 1)];
    sums[0] = 0.0f;
    for (std::size_t x = 0; x < width; ++x) {
      sums[x + 1] = sums[x] + 1.0f - shares_[row * width + x];
      inside += double(shares_[row * width + x]);
    }
  }
  volume_ = float(inside * double(cell_) * double(cell_) * double(cell_));
}

float Occupancy::outsideBefore(const float* row, float x) const {
  const auto width = float(size_.x);
  if (x <= 0.0f) return x;
  if (x >= width) return row[size_.x] + (x - width);
  const int i = int(x);
  return row[i] + (row[i + 1] - row[i]) * (x - float(i));
}

float Occupancy::outsideVolume(const glm::vec3& center, float radius) const {
  const glm::vec3 c = (center - low_) / cell_;
  const float r = radius / cell_, r2 = r * r;
  // A ball of few cells falls between rows: one row through its middle speaks for all.
  if (r < 1.0f) {
    const glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor(c)), glm::ivec3(0), size_ - 1);
    const bool within =
        glm::all(glm::greaterThanEqual(c, glm::vec3(0.0f))) && glm::all(glm::lessThan(c, glm::vec3(size_)));
    return ballVolume(radius) * (within ? 1.0f - share(at) : 1.0f);
  }
  // Large balls take every second or third row, starting at a multiple of that.
  const int step = std::max(1, int(r / kRowsPerRadius));
  const auto firstRow = [&](float low) {
    const int first = int(std::ceil(low - 0.5f));
    return first + ((-first) % step + step) % step;
  };
  float sum = 0.0f;
  const int z_last = int(std::floor(c.z + r - 0.5f));
  for (int z = firstRow(c.z - r); z <= z_last; z += step) {
    const float dz = float(z) + 0.5f - c.z;
    const float slice2 = r2 - dz * dz;
    if (slice2 <= 0.0f) continue;
    const float slice = std::sqrt(slice2);
    const int y_last = int(std::floor(c.y + slice - 0.5f));
    for (int y = firstRow(c.y - slice); y <= y_last; y += step) {
      const float dy = float(y) + 0.5f - c.y;
      const float half = std::sqrt(std::max(0.0f, slice2 - dy * dy));
      if (y < 0 || z < 0 || y >= size_.y || z >= size_.z) {
        sum += 2.0f * half;
        continue;
      }
      const float* row = &outside_before_[(std::size_t(z) * std::size_t(size_.y) + std::size_t(y)) *
                                          (std::size_t(size_.x) + 1)];
      sum += outsideBefore(row, c.x + half) - outsideBefore(row, c.x - half);
    }
  }
  return sum * float(step * step) * cell_ * cell_ * cell_;
}

}  // namespace gloam::spheres
