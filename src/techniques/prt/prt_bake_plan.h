// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake is going to be: options that are good, the sizes that follow from them, what it takes.
#pragma once

#include <gloam/bake.h>

#include "techniques/prt/prt_bake_directions.h"

namespace gloam::prt {

/// Throws Error for options out of range.
void checkOptions(const BakeOptions& options);

/// Options with `bounce_directions` chosen where it is 0.
BakeOptions withBounceDirections(const Scene& scene, BakeOptions options);

/// Interreflection passes.
int bouncesOf(const BakeOptions& options);
DirectionTables tablesFor(const BakeOptions& options);
/// Whether light is followed by way of mirrors.
bool followsMirrors(const Scene& scene, const PosedScene& posed, const BakeOptions& options);

/// What may be spent on hits that later bounces need not trace again. Throws Error where even without them the bake takes
/// more than options.memory_bytes.
std::size_t keptHitsBytes(std::size_t least_memory_bytes, const BakeOptions& options);
/// BakeEstimate::least_memory_bytes, as quick as that.
std::size_t leastMemory(const Scene& scene, const BakeOptions& options);

}  // namespace gloam::prt
