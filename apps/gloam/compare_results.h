// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What `gloam compare` found, and how it is written: results.json (its shape is kept stable), results.csv.
#pragma once

#include <gloam/metrics.h>
#include <gloam/scene.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "json.h"

namespace gloam::cli {

/// The error of one layer's light; nothing where the technique is not to have such light.
using LayerError = std::optional<Metrics>;

struct TechniqueResult {
  std::string name, label;
  Json settings = Json::object();
  LayerError sum, direct, indirect;
  double device_ms = 0.0, frame_ms = 0.0;  ///< medians: of a frame's passes together, and by the clock
  Json passes = Json::array();
  std::size_t memory_bytes = 0;
  std::optional<double> bake_seconds;
  std::string bake_note;      ///< where the time of a bake is not known: why
  Coverage covers, missing;   ///< of the light that the scene has
  int bounces = 0;            ///< of the indirect light that it is held to; 0: none
  int own_bounces = 0;        ///< of the indirect light that it computes
  bool direct_alone = false;  ///< computes indirect light, but the reference has none: not measured
  /// The relative error that chance in what it is held to makes by itself; nothing where that is not known.
  std::optional<double> reference_noise;
  Warnings notes;
  std::filesystem::path file, reference_file;  ///< that were measured
  std::string command;                         ///< that prints the same measures
};

struct CompareResults {
  std::string scene, environment, size, device, command;
  int bounces = 0, environment_order = 0;
  std::filesystem::path reference_file;
  std::string reference_text;  ///< where it came from, for people
  std::optional<int> reference_samples;
  /// PathTracer::noise(), and the relative error of all light that noise alone makes.
  std::optional<double> reference_noise, reference_relative_noise;
  std::vector<TechniqueResult> techniques;
};

Json resultsJson(const CompareResults& results);
/// A line a technique and layer, under a line of names; empty where a measure does not apply.
std::string resultsCsv(const CompareResults& results);
/// What the reference's noise leaves open about the results, in one line; empty where it is well below all errors.
std::string noiseRemark(const CompareResults& results);
/// Who is held to fewer bounces than were traced, in one line; empty where nobody is.
std::string bouncesRemark(const CompareResults& results);
/// What techniques said of their pictures, a line each; what one said with all of its settings, once.
std::vector<std::string> noteLines(const CompareResults& results);
/// A table for people.
std::vector<std::string> resultsTable(const CompareResults& results);

}  // namespace gloam::cli
