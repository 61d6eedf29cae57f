// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A comparison under way, and the part of it that measures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare_folder.h"
#include "compare_page.h"
#include "compare_reference.h"
#include "compare_results.h"
#include "compare_run.h"
#include "compare_stage.h"
#include "emission_run.h"
#include "spheres_run.h"

namespace gloam::cli {

/// A stretch of the whole work.
Progress stretch(const Progress& whole, double from, double to);

struct Comparison {
  CompareChoice choice;
  std::vector<Contender> contenders;
  CompareStage stage;
  CompareFolder folder;
  ReferencePicture reference;
  CompareResults results;
  Page page;
  std::vector<std::optional<SceneSpheres>> spheres;    ///< of contenders that need them
  std::vector<std::optional<SceneEmission>> emission;  ///< what these send, likewise
  std::vector<BakeTime> sphere_times;                  ///< what fitting and sampling those took
  std::vector<std::string> dark_emitters;  ///< that have no spheres: what lives by these lacks their light
};

/// Every drawn picture against what its technique is held to, which is written beside it: measures, and pictures for the page.
void measureAll(Comparison& work, const Progress& progress);
/// For the page: one picture for each part of the light that a technique is held to, and one of all light where none is.
void addReferencePictures(Comparison& work);

}  // namespace gloam::cli
