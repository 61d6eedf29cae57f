// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What `gloam compare` compares: techniques, each with settings, and the light that each is to be held to.
#pragma once

#include <gloam/renderer.h>
#include <gloam/spheres.h>
#include <scene/coverage.h>

#include <string>
#include <vector>

#include "console.h"
#include "scene_light.h"
#include "technique_choice.h"

namespace gloam::cli {

/// One technique with its settings.
struct Contender {
  const TechniqueInfo* technique = nullptr;
  Settings settings;
  std::string label;  ///< "prt order=3 window=hann"
  std::string stem;   ///< of its files: "prt_order=3_window=hann"
  bool named = true;  ///< asked for by name; others are left out where they cannot draw the scene
};

/// Of "irradiance,prt,prt:order=3:window=hann". What a technique's own options on the command line say holds for all of its
/// contenders that do not say otherwise; "all" stands for allContenders(). Throws Error for unknown names, options and
/// values, and for one that stands twice.
std::vector<Contender> planContenders(const std::string& list, const TechniqueChoice& common);
/// Every technique once, none of them named.
std::vector<Contender> allContenders(const TechniqueChoice& common);

/// Names of things that glow, have no spheres and deform: what lives by spheres has nothing of their light (that of rigid ones is
/// sent by rectangles).
std::vector<std::string> emittersWithoutSpheres(const Scene& scene, const SceneSpheres& spheres);

/// The light that it computes with its options.
Coverage coverageOf(const Contender& contender);
/// Bounces of its light: of the bake where it needs one, of its own option "bounces" where it has that, else one.
int bouncesOf(const Contender& contender, int baked);
bool anyDirect(const Coverage& coverage);
bool anyIndirect(const Coverage& coverage);
Coverage directOf(const Coverage& coverage);

bool lights(const Contender& contender, const Coverage& in_scene);
/// Takes out those that nobody named and that cover none of the light, or would bake for nothing, with a line; all stay where none
/// would be left.
void leaveOutDark(std::vector<Contender>& contenders, const Coverage& in_scene, Console& console);
/// The same for those that need a bake, where the scene holds nothing rigid that could be baked. Throws Error where one was
/// named.
void leaveOutUnbakeable(std::vector<Contender>& contenders, const Scene& scene, const PosedScene& posed,
                        Console& console);
/// Throws Error where a technique covers none of the light that the scene has.
void requireLight(const Contender& contender, const Coverage& in_scene);

}  // namespace gloam::cli
