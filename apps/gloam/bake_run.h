// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking as both `gloam bake` and `gloam render` do it.
#pragma once

#include <gloam/bake.h>

#include "console.h"

namespace gloam::cli {

/// What a bake will take, in one line for people.
std::string estimateText(const BakeEstimate& estimate);

/// A scene without transfer, baked with default options as it stands at `time_s`. Finished bakes are kept under
/// $XDG_CACHE_HOME/gloam (~/.cache/gloam) by content and taken from there; `use_cache` false neither reads nor writes
/// them. Interrupted work goes on with the next call. Throws Error, Interrupted.
Scene bakeForDrawing(const Scene& scene, const std::string& place, float time_s, bool use_cache,
                     Console& console);

}  // namespace gloam::cli
