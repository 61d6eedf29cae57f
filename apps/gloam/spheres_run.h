// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sphere sets as both `gloam bake spheres` and `gloam render` make them.
#pragma once

#include <gloam/spheres.h>

#include <string>

#include "arguments.h"
#include "bake_time.h"
#include "console.h"

namespace gloam::cli {

/// --spheres FILE: sets that `gloam bake spheres` wrote, in place of fitting any.
void addSpheresOption(CLI::App& app, std::string& file);

/// Those of `file`, where one is named: throws Error where they are another model's. Else sets with default options
/// but their number. Finished ones are kept under $XDG_CACHE_HOME/gloam/spheres (~/.cache/gloam/spheres) by content and
/// taken from there; `use_cache` false neither reads nor writes them. `time`: what fitting them took. Throws Error, Interrupted.
SceneSpheres spheresForDrawing(const Scene& scene, const std::string& place, bool use_cache, Console& console,
                               int count = SphereOptions{}.count, BakeTime* time = nullptr,
                               const std::string& file = {});

}  // namespace gloam::cli
