// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking as both `gloam bake` and `gloam render` do it.
#pragma once

#include <gloam/bake.h>
#include <gloam/renderer.h>

#include <string>

#include "bake_time.h"
#include "console.h"

namespace gloam::cli {

/// What a bake will take, in one line for people.
std::string estimateText(const BakeEstimate& estimate);

/// Says so where transfer holds for the instant of the bake alone: animation moves baked meshes against one another.
void remarkMotion(const Scene& scene, Console& console);

/// Whether a technique's bake is to be of objects apart: where it covers light that comes from one to another.
bool bakesApart(const TechniqueInfo& technique, const Settings& settings);

/// A scene without transfer, baked with default options as it stands at `time_s`, its objects `apart` or as one. Finished bakes are kept under
/// $XDG_CACHE_HOME/gloam (~/.cache/gloam) by content and taken from there; `use_cache` false neither reads nor writes
/// them. Interrupted work goes on with the next call. Throws Error, Interrupted.
Scene bakeForDrawing(const Scene& scene, const std::string& place, float time_s, bool use_cache,
                     Console& console, bool apart = false);

/// How a scene is baked that nobody baked beforehand: the defaults of `gloam bake`, gloss where it shows and memory allows,
/// as the scene stands at `time_s`. Without bounces only its shadows.
BakeOptions drawingBake(const Scene& scene, float time_s, int bounces = BakeOptions{}.bounces);

/// The same with options of one's own; `options.checkpoint` is the cache's. Kept bakes bring their time along.
Scene bakeForDrawing(const Scene& scene, const std::string& place, BakeOptions options, bool use_cache,
                     Console& console, BakeTime* time);

}  // namespace gloam::cli
