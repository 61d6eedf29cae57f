// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What spheres send, as every verb that draws has it.
#pragma once

#include <gloam/renderer.h>
#include <gloam/spherical_lights.h>

#include <string>

#include "bake_time.h"
#include "console.h"

namespace gloam::cli {

/// Finished ones are kept under $XDG_CACHE_HOME/gloam/emission (~/.cache/gloam/emission) by content and taken from there; `use_cache`
/// false neither reads nor writes them. `time`: what sampling took is added to it. Throws Error, Interrupted.
SceneEmission emissionForDrawing(const Scene& scene, const SceneSpheres& spheres, const std::string& place,
                                 bool use_cache, Console& console, BakeTime* time = nullptr);

/// Hands a technique what it needs of spheres that are there: the sets, and what they send.
void giveSpheres(Renderer& renderer, const TechniqueInfo& info, const Scene& scene,
                 const SceneSpheres& spheres, const std::string& place, bool use_cache, Console& console);

}  // namespace gloam::cli
