// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What light a scene has at all, which is held against what a technique covers.
#pragma once

#include <gloam/renderer.h>
#include <gloam/scene.h>

#include <vector>

#include "console.h"

namespace gloam::cli {

/// Whether a mesh shines itself.
bool glows(const Scene& scene, int index);

/// The light that a scene has at all. Without bounces nothing is indirect.
Coverage lightIn(const Scene& scene, const PosedScene& posed, const Environment& environment, int bounces);

/// For each of PosedScene::instances, whether it shines itself.
std::vector<bool> glowingInstances(const Scene& scene, const PosedScene& posed);

/// A line where a picture will be black: nothing shines, or nothing of what the technique covers.
void remarkDark(const TechniqueInfo& technique, const Settings& settings, const Coverage& in_scene,
                Console& console);

}  // namespace gloam::cli
