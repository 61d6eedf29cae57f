// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "visibility/visibility_shared.h"
#include "visibility/world_tracer.h"

namespace gloam::visibility {

/// Rows of lights in memory, a SightEnd at the start of each.
struct LightRows {
  const std::byte* first = nullptr;
  std::size_t stride = sizeof(SightEnd), count = 0;
};

/// Fills visible[word * points.size() + p] (visibility.h) on all cores; returns the number of rays. Bits do not depend on the
/// number of threads. What sets say beyond the rows is not looked at.
std::uint64_t traceSight(const WorldTracer& tracer, std::span<const SightPoint> points,
                         const LightRows& lights, std::span<const SightSet> sets, std::uint32_t words,
                         std::span<std::uint32_t> visible);

/// The rays that it traces, for measurements.
std::vector<trace::LoggedRay> sightRays(std::span<const SightPoint> points, const LightRows& lights,
                                        std::span<const SightSet> sets, std::uint32_t words);

}  // namespace gloam::visibility
