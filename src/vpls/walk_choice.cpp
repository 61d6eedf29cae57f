// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "vpls/walk_choice.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace gloam::vpls {

namespace {

constexpr double kBlind = 0.2;

/// What a light adds to the light at a point, the mean of the colours; 0 where it is not seen.
float addedAt(const visibility::SightPoint& point, const WalkVpl& row,
              const visibility::WorldTracer& tracer) {
  if (!sends(row)) return 0.0f;
  glm::vec3 way;
  const glm::vec3 light = walkIrradiance(row, point.position, way);
  const float size = light.r + light.g + light.b;
  if (!(size > 0.0f) || glm::dot(way, point.normal) <= 0.0f) return 0.0f;
  const glm::vec3 origin = point.position + point.offset * point.normal;
  trace::Ray ray{origin, way, 0.0f, std::numeric_limits<float>::infinity()};
  if (row.end.kind != visibility::kSightDirectional)
    ray.t_far = std::max(0.0f, glm::distance(origin, row.end.position) - 4.0f * row.end.offset);
  return tracer.occluded(ray) ? 0.0f : size;
}

/// The share of each row in what is seen, summed over the points.
std::vector<float> sharesOf(std::span<const WalkVpl> rows, const visibility::WorldTracer& tracer,
                            std::span<const visibility::SightPoint> seen) {
  const std::size_t count = seen.size();
  std::vector<float> added(rows.size() * count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      for (std::size_t p = 0; p < count; ++p) added[i * count + p] = addedAt(seen[p], rows[i], tracer);
    }
  });
  std::vector<double> totals(count, 0.0);
  for (std::size_t i = 0; i < added.size(); ++i) totals[i % count] += double(added[i]);
  std::vector<float> shares(rows.size(), 0.0f);
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (added[i] > 0.0f) shares[i / count] += float(double(added[i]) / totals[i % count]);
  }
  return shares;
}

/// Systematic resampling: `offset` in [0, 1), then every total / to.size().
void choose(std::span<const WalkVpl> rows, std::span<const float> shares, double offset,
            std::span<WalkVpl> to) {
  std::size_t sending = 0;
  double seen = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!sends(rows[i])) continue;
    ++sending;
    seen += double(shares[i]);
  }
  if (sending == 0 || to.empty()) return;
  // Of each row: its part of what is seen, and its part of the blind choice.
  const double blind = seen > 0.0 ? kBlind : 1.0;
  double sum = offset;
  std::size_t place = 0, drawn = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!sends(rows[i])) continue;
    const double part =
        (seen > 0.0 ? (1.0 - blind) * double(shares[i]) / seen : 0.0) + blind / double(sending);
    const double expected = part * double(to.size());
    sum += expected;
    const auto reached = std::min(std::size_t(sum), to.size());
    if (reached == drawn) continue;
    const auto factor = float(double(reached - drawn) / expected);
    drawn = reached;
    to[place] = rows[i];
    to[place].light *= factor;
    to[place].bound *= std::max(factor, 1.0f);
    ++place;
  }
}

}  // namespace

std::vector<WalkVpl> chooseRows(const WalkPlan& from, std::span<const WalkVpl> candidates, const WalkPlan& to,
                                const visibility::WorldTracer& tracer,
                                std::span<const visibility::SightPoint> seen) {
  // Rows for sources are even as they are: choosing among them made them less so, and light worse.
  const auto fixed = std::size_t(to.lamps + to.direct);
  std::vector<WalkVpl> lit;
  for (std::size_t s = 0; s < std::size_t(to.sets); ++s) {
    const auto own = candidates.subspan(s * from.stride() + fixed, std::size_t(from.indirect()));
    lit.insert(lit.end(), own.begin(), own.end());
  }
  const std::vector<float> shares = sharesOf(lit, tracer, seen);
  std::vector<WalkVpl> rows(std::size_t(to.sets) * to.stride(), emptyRow());
  for (std::size_t s = 0; s < std::size_t(to.sets); ++s) {
    const auto kept = std::span(rows).subspan(s * to.stride(), to.stride());
    const auto each = std::size_t(from.indirect());
    const double offset = std::fmod((double(s) + 0.5) * 0.6180339887498949, 1.0);
    std::copy_n(candidates.begin() + std::ptrdiff_t(s * from.stride()), fixed, kept.begin());
    choose(std::span(lit).subspan(s * each, each), std::span(shares).subspan(s * each, each), offset,
           kept.subspan(fixed, std::size_t(to.indirect())));
  }
  return rows;
}

}  // namespace gloam::vpls
