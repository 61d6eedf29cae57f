// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_run.h"

#include <fmt/core.h>
#include <gloam/volume.h>
#include <scene/animation.h>
#include <techniques/prt/prt_bake_state.h>

#include <functional>
#include <optional>

#include "cache_folder.h"
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
Scene bakeResumed(const fs::path& checkpoint, const std::function<Scene()>& bake) {
  std::error_code ignored;
  try {
    try {
      return bake();
    } catch (const Error&) {
      if (!fs::remove(checkpoint, ignored)) throw;
      return bake();
    }
  } catch (const Interrupted&) {
    throw Interrupted(checkpoint.empty() ? "interrupted while baking"
                                         : "interrupted while baking; the same command goes on from here");
  }
}

BakeTime timeOf(const BakeReport& report) {
  if (report.resumed) return {std::nullopt, "interrupted and taken up again: not timed as a whole"};
  return {report.first_pass_s + report.bounces_s, ""};
}

/// Who draws a scene that is not baked did not ask for more memory than this: its gloss stays unshadowed then.
constexpr std::size_t kUnaskedBytes = std::size_t(1) << 30;

}  // namespace

std::string estimateText(const BakeEstimate& estimate) {
  const std::string matrices = estimate.glossy_vertices > 0 ? fmt::format(", {} of them with matrices",
                                                                          countText(estimate.glossy_vertices))
                                                            : "";
  const std::string texels =
      estimate.texels > 0 ? fmt::format(", {} texels", countText(estimate.texels)) : "";
  return fmt::format(
      "{} vertices{}{}, {} triangles; {:.3g} rays in the first pass; at most {} of memory and a file of {}",
      countText(estimate.vertices), matrices, texels, countText(estimate.triangles), double(estimate.rays),
      bytesText(double(estimate.memory_bytes)), bytesText(double(estimate.file_bytes)));
}

void remarkMotion(const Scene& scene, Console& console) {
  if (!movesApart(scene)) return;
  console.remark(
      "animation moves meshes against one another: their transfer holds for the instant of the bake "
      "(--time)");
}

BakeOptions drawingBake(const Scene& scene, float time_s, int bounces) {
  BakeOptions options;
  options.time_s = time_s;
  options.kind = bounces > 0 ? TransferKind::kInterreflected : TransferKind::kShadowed;
  if (bounces > 0) options.bounces = bounces;
  options.glossy = GlossyMeshes::kShiny;
  if (estimateBake(scene, options).memory_bytes > kUnaskedBytes) options.glossy = GlossyMeshes::kNone;
  return options;
}

bool bakesApart(const TechniqueInfo& technique, const Settings& settings) {
  const Coverage covers = coverageWith(technique, settings);
  return technique.needs_bake && (covers.local_indirect || covers.emitter_indirect);
}

Scene bakeForDrawing(const Scene& scene, const std::string& place, float time_s, bool use_cache,
                     Console& console, bool apart) {
  BakeTime unused;
  BakeOptions options = drawingBake(scene, time_s);
  options.apart = apart;
  return bakeForDrawing(scene, place, options, use_cache, console, &unused);
}

Scene bakeForDrawing(const Scene& scene, const std::string& place, BakeOptions options, bool use_cache,
                     Console& console, BakeTime* time) {
  const BakeEstimate estimate = estimateBake(scene, options);
  const std::optional<fs::path> folder = use_cache ? cacheFolder("bakes") : std::nullopt;
  fs::path file;
  if (folder) {
    const std::string key = bakeKey(scene, options);
    file = *folder / (key + ".glb");
    if (std::optional<Scene> kept = readKept(file)) {
      kept->name = scene.name;
      kept->environment = scene.environment;
      *time = readBakeTime(file);
      console.remark(fmt::format("{}: transfer taken from {}", place, file.string()));
      return *std::move(kept);
    }
    options.checkpoint = *folder / (key + ".checkpoint");
  }
  console.remark(fmt::format("{} is not baked; baking it first: {}", place, estimateText(estimate)));
  if (!options.apart) remarkMotion(scene, console);
  console.release();
  BakeReport report;
  VolumeReport clouds;
  Scene cloudy = scene;
  VolumeBakeOptions volumes = {.order = options.order, .time_s = options.time_s};
  if (folder) volumes.checkpoint = options.checkpoint.string() + ".volumes";
  volumes.keep_checkpoint = true;  // until transfer is done, too
  if (carriesUnbakedVolumes(scene))
    cloudy = bakeResumed(volumes.checkpoint,
                         [&] { return bakeVolumes(scene, volumes, console.progress(), &clouds); });
  Scene baked = bakeResumed(options.checkpoint,
                            [&] { return bakeTransfer(cloudy, options, console.progress(), &report); });
  if (std::error_code ignored; folder) fs::remove(volumes.checkpoint, ignored);
  report.resumed = report.resumed || clouds.resumed;
  report.bounces_s += clouds.seconds;
  *time = timeOf(report);
  console.endProgress();
  for (const std::string& warning : report.warnings) console.remark(warning);
  baked.environment = scene.environment;
  if (folder) {
    try {
      writeGlb(baked, file);
      writeBakeTime(*time, file);
      console.remark(fmt::format("bake kept as {} (--no-cache keeps none)", file.string()));
    } catch (const Error& error) {
      console.remark(fmt::format("the bake is not kept: {}", error.what()));
    }
  }
  return baked;
}

}  // namespace gloam::cli
