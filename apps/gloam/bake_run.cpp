// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_run.h"

#include <fmt/core.h>
#include <techniques/prt/prt_bake_state.h>

#include <cstdlib>
#include <optional>

#include "technique_choice.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

/// Names the bake that is kept of a scene: changes with anything in it but its environment, which no bake sees, with every
/// option that changes the result, and with the version of gloam.
std::string bakeKey(const Scene& scene, const BakeOptions& options) {
  Fingerprint key = prt::fingerprintOf(scene, options);
  add(key, std::string(GLOAM_VERSION));
  return key.text();
}

/// Where bakes are kept; nothing where there is no home or it cannot be written.
std::optional<fs::path> cacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (cache != nullptr && fs::path(cache).is_absolute()) {
    folder = cache;
  } else if (home != nullptr && *home != '\0') {
    folder = fs::path(home) / ".cache";
  } else {
    return std::nullopt;
  }
  folder = folder / "gloam" / "bakes";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return std::nullopt;
  return folder;
}

/// A bake that was kept, or nothing; a file that cannot be read (an older gloam, a full disk then) is as good as none.
std::optional<Scene> readKept(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  try {
    Scene kept = loadScene(file.string());
    if (carriesTransfer(kept)) return kept;
  } catch (const Error&) {
  }
  return std::nullopt;
}

/// A checkpoint that cannot be used (of an older gloam, damaged) is nobody's but the cache's: it goes, the bake begins anew.
Scene bakeResumed(const Scene& scene, const BakeOptions& options, Console& console) {
  std::error_code ignored;
  try {
    try {
      return bakeTransfer(scene, options, console.progress());
    } catch (const Error&) {
      if (!fs::remove(options.checkpoint, ignored)) throw;
      return bakeTransfer(scene, options, console.progress());
    }
  } catch (const Interrupted&) {
    throw Interrupted(options.checkpoint.empty()
                          ? "interrupted while baking"
                          : "interrupted while baking; the same command goes on from here");
  }
}

}  // namespace

std::string estimateText(const BakeEstimate& estimate) {
  return fmt::format("{} vertices, {} triangles; {:.3g} rays in the first pass; {} of memory, a file of {}",
                     countText(estimate.vertices), countText(estimate.triangles), double(estimate.rays),
                     bytesText(double(estimate.memory_bytes)), bytesText(double(estimate.file_bytes)));
}

Scene bakeForDrawing(const Scene& scene, const std::string& place, float time_s, bool use_cache,
                     Console& console) {
  BakeOptions options;
  options.time_s = time_s;
  const BakeEstimate estimate = estimateBake(scene, options);
  const std::optional<fs::path> folder = use_cache ? cacheFolder() : std::nullopt;
  fs::path file;
  if (folder) {
    const std::string key = bakeKey(scene, options);
    file = *folder / (key + ".glb");
    if (std::optional<Scene> kept = readKept(file)) {
      kept->name = scene.name;
      kept->environment = scene.environment;
      console.remark(fmt::format("{}: transfer taken from {}", place, file.string()));
      return *std::move(kept);
    }
    options.checkpoint = *folder / (key + ".checkpoint");
  }
  console.remark(fmt::format("{} is not baked; baking it first: {}", place, estimateText(estimate)));
  console.release();
  Scene baked = bakeResumed(scene, options, console);
  console.endProgress();
  baked.environment = scene.environment;
  if (folder) {
    try {
      writeGlb(baked, file);
      console.remark(fmt::format("bake kept as {} (--no-cache keeps none)", file.string()));
    } catch (const Error& error) {
      console.remark(fmt::format("the bake is not kept: {}", error.what()));
    }
  }
  return baked;
}

}  // namespace gloam::cli
