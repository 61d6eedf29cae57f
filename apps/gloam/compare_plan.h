// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What `gloam compare` compares: techniques, each with settings, and the light that each is to be held to.
#pragma once

#include <gloam/renderer.h>
#include <scene/coverage.h>

#include <string>
#include <vector>

#include "technique_choice.h"

namespace gloam::cli {

/// One technique with its settings.
struct Contender {
  const TechniqueInfo* technique = nullptr;
  Settings settings;
  std::string label;  ///< "prt order=3 window=hann"
  std::string stem;   ///< of its files: "prt_order=3_window=hann"
};

/// Of "irradiance,prt,prt:order=3:window=hann". What a technique's own options on the command line say holds for all of its
/// contenders that do not say otherwise. Throws Error for unknown names, options and values, and for one that stands twice.
std::vector<Contender> planContenders(const std::string& list, const TechniqueChoice& common);
/// Every technique once.
std::vector<Contender> allContenders(const TechniqueChoice& common);

/// The light that a scene has at all. Without bounces nothing is indirect.
Coverage lightIn(const Scene& scene, const PosedScene& posed, const Environment& environment, int bounces);

/// The light that it computes with its options.
Coverage coverageOf(const Contender& contender);
bool anyDirect(const Coverage& coverage);
bool anyIndirect(const Coverage& coverage);

bool lights(const Contender& contender, const Coverage& in_scene);
/// Throws Error where a technique covers none of the light that the scene has.
void requireLight(const Contender& contender, const Coverage& in_scene);

}  // namespace gloam::cli
