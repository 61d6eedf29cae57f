// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_directions.h"

#include <gloam/sh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "math/sampling.h"

namespace gloam::prt {
namespace {

// Place along a Hilbert curve of 2^16 cells a side (Warren, Hacker's Delight, 16.2).
std::uint32_t hilbertIndex(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t s = 1u << 15; s > 0; s >>= 1) {
    const std::uint32_t right = (x & s) ? 1u : 0u, upper = (y & s) ? 1u : 0u;
    index = (index << 2) | ((3u * right) ^ upper);
    if (upper == 0) {
      if (right == 1) {
        x = 0xffffu - x;
        y = 0xffffu - y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

// Octahedral map of the sphere onto a square, then the curve.
std::uint32_t placeOnSphere(glm::vec3 axis) {
  axis /= std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z);
  glm::vec2 p(axis.x, axis.y);
  if (axis.z < 0.0f) {
    p = (glm::vec2(1.0f) - glm::abs(glm::vec2(p.y, p.x))) *
        glm::vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
  }
  const glm::vec2 cell = glm::clamp(p * 0.5f + 0.5f, 0.0f, 1.0f) * 65535.0f;
  return hilbertIndex(std::uint32_t(cell.x), std::uint32_t(cell.y));
}

int levelsFor(int count, int bounce_count) {
  int levels = 1;
  while (levels < 8 && bounce_count * 3 < (count >> (levels - 1)) * 2) ++levels;
  return levels;
}

int stepsFor(int count) {
  int steps = 1;
  while (steps < 10 && (count >> steps) >= kLeastDirectionsOfError / 2) ++steps;
  return steps;
}

int nearestPrefix(const std::vector<int>& prefixes, int wanted) {
  int best = prefixes.back();
  for (const int p : prefixes) {
    if (std::abs(p - wanted) < std::abs(best - wanted)) best = p;
  }
  return best;
}

void fillTile(const sampling::TiledDirections& set, int source, int tile, std::size_t cone_place,
              DirectionTables& tables) {
  float* directions = tables.directions.get() + std::size_t(tile) * 3 * kTileSize;
  float* basis = tables.basis.get() + std::size_t(tile) * std::size_t(tables.coefficients) * kTileSize;
  for (int k = 0; k < kTileSize; ++k) {
    const glm::vec3 s = set.direction(source * kTileSize + k);
    const sh::Sh y = sh::evaluate(tables.order, s);
    for (int axis = 0; axis < 3; ++axis) directions[axis * kTileSize + k] = s[axis];
    for (int i = 0; i < tables.coefficients; ++i) basis[i * kTileSize + k] = y[i];
  }
  const auto& cone = set.cones[std::size_t(source)];
  float* row = tables.cones.get() + cone_place;
  for (int axis = 0; axis < 3; ++axis) row[std::size_t(axis) * tables.cone_stride] = cone.axis[axis];
  row[3 * tables.cone_stride] = std::sqrt(std::max(0.0f, 1.0f - cone.cos_half_angle * cone.cos_half_angle));
}

}  // namespace

float DirectionTables::solidAngle(std::size_t tile_count) {
  return sampling::TiledDirections::solidAngle(int(tile_count));
}

std::size_t DirectionTables::memoryBytes() const {
  return std::size_t(tiles) * kTileSize * std::size_t(3 + coefficients) * sizeof(float);
}

DirectionTables makeDirectionTables(int order, int count, int bounce_count, bool in_steps) {
  const auto set =
      sampling::makeTiledDirections(count, in_steps ? stepsFor(count) : levelsFor(count, bounce_count));
  static_assert(sampling::TiledDirections::kTileSize == kTileSize);
  DirectionTables tables;
  tables.order = order;
  tables.coefficients = sh::coefficientCount(order);
  tables.tiles = set.tiles();
  tables.bounce_tiles = nearestPrefix(set.even_prefixes, (bounce_count + kTileSize - 1) / kTileSize);
  const std::vector<int> ends = in_steps ? set.even_prefixes : std::vector<int>{tables.tiles};
  for (const int end : ends) {
    DirectionBatch& batch = tables.batches.emplace_back();
    batch.first = tables.batches.size() > 1 ? tables.batches[tables.batches.size() - 2].end : 0;
    batch.end = end;
    batch.first_cone = tables.cone_stride;
    tables.cone_stride += std::size_t(end - batch.first + 15) / 16 * 16;
  }
  const std::size_t tiles = std::size_t(tables.tiles);
  tables.directions = hwy::AllocateAligned<float>(tiles * 3 * kTileSize);
  tables.basis = hwy::AllocateAligned<float>(tiles * std::size_t(tables.coefficients) * kTileSize);
  tables.cones = hwy::AllocateAligned<float>(4 * tables.cone_stride);
  if (!tables.directions || !tables.basis || !tables.cones) throw std::bad_alloc();
  std::fill_n(tables.cones.get(), 4 * tables.cone_stride, 0.0f);

  std::vector<std::uint32_t> place(tiles);
  for (std::size_t t = 0; t < tiles; ++t) place[t] = placeOnSphere(set.cones[t].axis);
  std::vector<int> order_of_tracing(tiles);
  std::iota(order_of_tracing.begin(), order_of_tracing.end(), 0);
  for (DirectionBatch& batch : tables.batches) {
    batch.first_bounce = tables.bounce_tile.size();
    std::stable_sort(order_of_tracing.begin() + batch.first, order_of_tracing.begin() + batch.end,
                     [&](int a, int b) { return place[std::size_t(a)] < place[std::size_t(b)]; });
    for (int t = batch.first; t < batch.end; ++t) {
      const int source = order_of_tracing[std::size_t(t)];
      fillTile(set, source, t, batch.first_cone + std::size_t(t - batch.first), tables);
      if (source < tables.bounce_tiles) tables.bounce_tile.push_back(t);
    }
    batch.end_bounce = tables.bounce_tile.size();
  }
  return tables;
}

}  // namespace gloam::prt
