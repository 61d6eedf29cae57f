// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The norm of a difference of transfer vectors is the root mean square of the difference of irradiance over directional
// lights from everywhere, times sqrt(4 pi): errors are told as shares of the norm of unshadowed transfer.
#include "techniques/prt/prt_tessellate_error.h"

#include <fmt/format.h>
#include <gloam/sh.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>

#include "techniques/prt/prt_bake_passes.h"

namespace gloam::prt {
namespace {

constexpr int kMostAcross = 64;  // places along the longest edge of a triangle

int directionsFor(const TessellateOptions& options) {
  if (options.directions > 0) return options.directions;
  // A shadow's edge across the hemisphere is measured to about 8 / directions^0.75 of full irradiance: a third of the bound.
  return std::clamp(int(std::pow(24.0 / double(options.error), 4.0 / 3.0) / 8.0), 512, 8192);
}

/// Bounced light is smoother, its rays are dearer, and all places have the same ones: what they miss is missed everywhere.
int bounceDirectionsFor(const TessellateOptions& options) {
  return std::max(256, directionsFor(options) / 4);
}

std::array<std::uint32_t, 6> keyOf(const glm::vec3& position, const glm::vec3& normal) {
  const glm::vec3 p = position + 0.0f, n = normal + 0.0f;
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
          std::bit_cast<std::uint32_t>(p.z), std::bit_cast<std::uint32_t>(n.x),
          std::bit_cast<std::uint32_t>(n.y), std::bit_cast<std::uint32_t>(n.z)};
}

}  // namespace

std::size_t TessellationError::KeyHash::operator()(const std::array<std::uint32_t, 6>& key) const {
  std::uint64_t h = 0x9e3779b97f4a7c15ull;
  for (const std::uint32_t word : key) {
    h = (h ^ word) * 0xff51afd7ed558ccdull;
    h ^= h >> 32;
  }
  return std::size_t(h);
}

TessellationError::TessellationError(const TessellateOptions& options, float spacing)
    : tables_(makeDirectionTables(options.order, directionsFor(options), bounceDirectionsFor(options))),
      spacing_(spacing) {
  double squared = 0.0;
  const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(options.order), {0, 1, 0});
  for (const float c : cosine.coefficients()) squared += double(c) * double(c);
  unshadowed_ = float(std::sqrt(squared));
}

/// Which triangles each sample counts for; an edge's middle counts for both sides.
struct TessellationError::Samples {
  struct Use {
    std::uint32_t point, instance, triangle;
    glm::vec2 share;
  };
  std::vector<Use> uses;
};

TessellationError::Samples TessellationError::placeSamples(
    BakePoints& points, std::size_t most, const std::vector<std::vector<float>>& errors) const {
  Samples samples;
  const std::size_t vertices = points.size();
  std::unordered_map<std::uint64_t, std::uint32_t> middles;  // by the edge's points
  for (std::uint32_t i = 0; i < errors.size(); ++i) {
    for (std::uint32_t t = 0; t < errors[i].size(); ++t) {
      if (errors[i][t] != kUnknown) continue;
      if (points.size() - vertices >= most) return samples;
      const std::uint32_t triangle = points.first_triangle[i] + t;
      const glm::uvec3 at = points.triangles[triangle];
      float longest = 0.0f;
      for (int k = 0; k < 3; ++k)
        longest =
            std::max(longest, glm::distance(points.positions[at[k]], points.positions[at[(k + 1) % 3]]));
      const int across = std::clamp(int(std::ceil(longest / spacing_)), 2, kMostAcross);
      const float own = longest / float(across);
      const auto add = [&](const glm::vec2& share) {
        addFacePoint(points, {.triangle = triangle, .share = share, .spacing = own});
        return std::uint32_t(points.size() - 1);
      };
      constexpr glm::vec2 kCorners[3] = {{0, 0}, {1, 0}, {0, 1}};
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = at[k], b = at[(k + 1) % 3];
        const glm::vec2 share = 0.5f * (kCorners[k] + kCorners[(k + 1) % 3]);
        const auto [found, is_new] =
            middles.try_emplace(std::uint64_t(std::min(a, b)) << 32 | std::max(a, b), 0u);
        if (is_new) found->second = add(share);
        samples.uses.push_back({found->second, i, t, share});
      }
      for (int y = 1; y < across; ++y) {
        for (int x = 1; x + y < across; ++x) {
          const glm::vec2 share = glm::vec2(float(x), float(y)) / float(across);
          samples.uses.push_back({add(share), i, t, share});
        }
      }
    }
  }
  return samples;
}

std::size_t TessellationError::measure(const Scene& scene, const PosedScene& posed, const Progress& progress,
                                       glm::vec2 fractions, std::size_t rays,
                                       std::vector<std::vector<float>>& errors) const {
  BakePoints points = makeBakePoints(scene, posed);
  const std::size_t vertices = points.size(), count = std::size_t(tables_.coefficients);
  const Samples samples = placeSamples(points, rays / std::size_t(directions() / 2), errors);
  const trace::Tracer tracer(scene, posed, {.reproducible = true, .rigid_only = true}, progress);
  BakePasses passes(scene, posed, points, tracer, tables_, {.bounces = 1, .kept_bytes = 0});
  BakeState state = makeBakeState(points.size(), tables_, 1);
  std::vector<std::uint32_t> known(points.size(), ~0u);
  for (std::size_t p = 0; p < vertices; ++p) {
    const auto found = known_.find(keyOf(points.positions[p], points.normals[p]));
    if (found != known_.end()) known[p] = found->second;
  }
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> traced{0}, done{0};
  std::mutex telling;
  // All blocks with a point that is not known.
  const auto run = [&](const auto& work) {
    tbb::parallel_for(std::size_t(0), state.blocks, [&](std::size_t block) {
      const auto begin = known.begin() + std::ptrdiff_t(state.blockBegin(block)),
                 end = known.begin() + std::ptrdiff_t(state.blockEnd(block));
      ++done;
      if (stop || std::find(begin, end, ~0u) == end) return;
      traced += work(block);
      const std::unique_lock lock(telling, std::try_to_lock);
      if (!lock || done % 64 != 1) return;
      if (progress.stopRequested()) stop = true;
      progress.report(double(glm::mix(fractions.x, fractions.y, float(done) / float(2 * state.blocks))),
                      fmt::format("splitting triangles: {} vertices", vertices));
    });
    if (stop) throw Interrupted("interrupted while splitting triangles");
  };
  const std::size_t numbers = count + state.row;  // of a vertex that is known
  run([&](std::size_t block) { return passes.shadowBlock(block, state); });
  for (std::size_t p = 0; p < vertices; ++p) {
    if (known[p] == ~0u) continue;
    std::copy_n(&rows_[known[p] * numbers], count, &state.direct[p * count]);
    state.sites[p].place = Place::kOpen;
  }
  passes.fillHidden(state, {state.direct, count});
  state.finishPass();
  run([&](std::size_t block) { return passes.bounceBlock(block, state); });
  for (std::size_t p = 0; p < vertices; ++p) {
    float* bounced = &state.next[p * state.row];
    if (known[p] != ~0u) {
      std::copy_n(&rows_[known[p] * numbers + count], state.row, bounced);
    } else if (state.sites[p].place == Place::kOpen) {
      known_.emplace(keyOf(points.positions[p], points.normals[p]), std::uint32_t(rows_.size() / numbers));
      rows_.insert(rows_.end(), &state.direct[p * count], &state.direct[p * count] + count);
      rows_.insert(rows_.end(), bounced, bounced + state.row);
    }
  }
  passes.fillHidden(state, {state.next, state.row});
  for (const Samples::Use& use : samples.uses) {
    float& error = errors[use.instance][use.triangle];
    error = std::max(error, 0.0f);
    if (state.sites[use.point].place != Place::kOpen) continue;
    const glm::uvec3& at = points.triangles[points.first_triangle[use.instance] + use.triangle];
    const float weights[3] = {1.0f - use.share.x - use.share.y, use.share.x, use.share.y};
    const auto offAt = [&](const std::vector<float>& numbers_of, std::size_t stride, std::size_t c) {
      double off = double(numbers_of[use.point * stride + c]);
      for (int k = 0; k < 3; ++k) off -= double(weights[k] * numbers_of[at[k] * stride + c]);
      return off;
    };
    double squared[3] = {};
    for (std::size_t c = 0; c < count; ++c) {
      const double direct = offAt(state.direct, count, c);
      for (std::size_t color = 0; color < 3; ++color) {
        const double off = direct + offAt(state.next, state.row, color * (state.row / 3) + c);
        squared[color] += off * off;
      }
    }
    error = std::max(error, float(std::sqrt(std::max({squared[0], squared[1], squared[2]}))) / unshadowed_);
  }
  return traced;
}

}  // namespace gloam::prt
