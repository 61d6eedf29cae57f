// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "spheres_run.h"

#include <fmt/core.h>
#include <scene/scene_fingerprint.h>

#include <chrono>
#include <optional>

#include "cache_folder.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSearchVersion = 7;  // to be raised when the same options give other spheres

/// Changes with anything in the scene but its environment, with every option that changes the result, and with the version.
std::string keyOf(const Scene& scene, const SphereOptions& options) {
  Fingerprint key;
  addAll(key, std::string(GLOAM_VERSION), kSearchVersion, scene, options.count, options.seed, options.samples,
         options.effort);
  return key.text();
}

/// What was kept, or nothing; a file that cannot be read (damaged, a full disk then) is as good as none.
std::optional<SceneSpheres> readKept(const fs::path& file, const Scene& scene) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  try {
    return readSpheres(file, scene);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void addSpheresOption(CLI::App& app, std::string& file) {
  addText(app, "--spheres", file, "FILE",
          "sphere sets that gloam bake spheres wrote for this scene, in place of fitting any");
}

SceneSpheres spheresForDrawing(const Scene& scene, const std::string& place, bool use_cache, Console& console,
                               int count, BakeTime* time, const std::string& file_given) {
  if (!file_given.empty()) {
    SceneSpheres given = readSpheres(file_given, scene);
    console.remarks(place, given.warnings);
    if (time != nullptr) *time = {std::nullopt, "fitted before"};
    return given;
  }
  const SphereOptions options{.count = count};
  const std::optional<fs::path> folder = use_cache ? cacheFolder("spheres") : std::nullopt;
  fs::path file;
  if (folder) {
    file = *folder / (keyOf(scene, options) + ".spheres.json");
    if (std::optional<SceneSpheres> kept = readKept(file, scene)) {
      console.remark(fmt::format("{}: {} spheres taken from {}", place, kept->count(), file.string()));
      console.remarks(place, kept->warnings);
      if (time != nullptr) *time = readBakeTime(file);
      return *std::move(kept);
    }
  }
  console.remark(options.count > 0 ? fmt::format("{}: fitting {} spheres first", place, options.count)
                                   : fmt::format("{}: fitting spheres first", place));
  console.release();
  const auto started = std::chrono::steady_clock::now();
  SceneSpheres spheres = bakeSpheres(scene, options, console.progress());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  const BakeTime fitted{took.count(), ""};
  if (time != nullptr) *time = fitted;
  console.endProgress();
  console.remarks(place, spheres.warnings);
  if (folder) {
    try {
      writeSpheres(spheres, file);
      writeBakeTime(fitted, file);
      console.remark(fmt::format("spheres kept as {} (--no-cache keeps none)", file.string()));
    } catch (const Error& error) {
      console.remark(fmt::format("the spheres are not kept: {}", error.what()));
    }
  }
  return spheres;
}

}  // namespace gloam::cli
