// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_state.h"

#include <algorithm>

#include "techniques/prt/prt_bake_kernels.h"

namespace gloam::prt {

std::size_t BakeState::blocksDone() const {
  std::size_t done = 0;
  for (std::size_t b = 0; b < blocks; ++b) done += block_done[b].load(std::memory_order_acquire);
  return done;
}

void BakeState::finishPass() {
  if (pass > 0) {
    for (std::size_t i = 0; i < indirect.size(); ++i) indirect[i] += next[i];
    previous.swap(next);
    if (!earlier.empty()) {
      std::rotate(earlier.begin(), earlier.end() - 1, earlier.end());
      earlier[0].swap(next);
    }
  } else if (bounces > 0) {
    const std::size_t stride = rowStride(coefficients);
    const std::size_t count = std::size_t(coefficients);
    for (std::size_t p = 0; p < points; ++p) {
      for (std::size_t color = 0; color < 3; ++color) {
        std::copy_n(&direct[p * count], count, &previous[p * row + color * stride]);
      }
    }
  }
  glossy.finishPass(pass);
  ++pass;
  for (std::size_t b = 0; b < blocks; ++b) block_done[b].store(0, std::memory_order_relaxed);
}

namespace {

// M^0 stands in `direct`, M^{b-1} in `previous`.
std::size_t earlierPasses(int bounces, bool mirrors) {
  return mirrors ? std::size_t(std::clamp(bounces - 2, 0, kMostMirrors)) : 0;
}

}  // namespace

BakeState makeBakeState(std::size_t points, const DirectionTables& tables, int bounces, bool mirrors) {
  BakeState state;
  state.points = points;
  state.blocks = (points + kBlockSize - 1) / kBlockSize;
  state.coefficients = tables.coefficients;
  state.row = 3 * rowStride(tables.coefficients);
  state.bounces = bounces;
  state.block_done = std::make_unique<std::atomic<std::uint8_t>[]>(state.blocks);
  state.direct.resize(points * std::size_t(tables.coefficients) + kRowPadding);
  state.sites.resize(points);
  if (bounces > 0) {
    state.bounce_tiles = std::size_t(tables.bounce_tiles);
    state.blocked.resize(points * state.bounce_tiles);
    state.previous.resize(points * state.row + kRowPadding);
    state.next.resize(points * state.row + kRowPadding);
    state.indirect.resize(points * state.row);
    state.earlier.resize(earlierPasses(bounces, mirrors));
    for (std::vector<float>& rows : state.earlier) rows.resize(points * state.row + kRowPadding);
    if (tables.batches.size() > 1) state.bounce_used.resize(points);
  }
  return state;
}

std::size_t bakeStateBytes(std::size_t points, const DirectionTables& tables, int bounces, bool mirrors) {
  const std::size_t direct = sizeof(RaySite) + std::size_t(tables.coefficients) * sizeof(float);
  const std::size_t indirect =
      std::size_t(tables.bounce_tiles) * sizeof(std::uint16_t) +
      (9 + 3 * earlierPasses(bounces, mirrors)) * rowStride(tables.coefficients) * sizeof(float) +
      (tables.batches.size() > 1 ? sizeof(std::uint32_t) : 0);
  return points * (direct + (bounces > 0 ? indirect : 0));
}

Fingerprint fingerprintOf(const Scene& scene, const BakeOptions& options) {
  Fingerprint print;
  add(print, scene);
  const auto& [kind, order, bounces, directions, bounce_directions, threads, time_s, glossy, glossy_order,
               glossy_light_order, glossy_exponent, texels, texels_per_metre, uv_set, caustics, error,
               memory_bytes, apart, checkpoint, keep_checkpoint] = options;
  addAll(print, kind, order, bounces, directions, bounce_directions, time_s, glossy, glossy_order,
         glossy_light_order, glossy_exponent, texels, texels_per_metre, uv_set, caustics, error, apart);
  return print;
}

Fingerprint fingerprintOf(const Scene& scene, const BakePoints& points, const BakeOptions& options) {
  Fingerprint print = fingerprintOf(scene, options);
  addAll(print, std::string(kernelTarget()), points.positions, points.normals, points.triangles,
         points.facing);
  return print;
}

}  // namespace gloam::prt
