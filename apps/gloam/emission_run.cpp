// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "emission_run.h"

#include <fmt/core.h>
#include <scene/scene_fingerprint.h>

#include <chrono>
#include <optional>

#include "cache_folder.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSamplingVersion = 2;  // to be raised when the same spheres give other samples

std::string keyOf(const Scene& scene, const SceneSpheres& spheres, const EmissionOptions& options) {
  Fingerprint key;
  addAll(key, std::string(GLOAM_VERSION), kSamplingVersion, scene, options.albedo_directions);
  for (const SphereSet& set : spheres.sets) {
    addAll(key, set.geometry, set.shape_from_object, std::uint64_t(set.spheres.size()));
    for (const Sphere& sphere : set.spheres) addAll(key, sphere.center, sphere.radius);
  }
  return key.text();
}

/// What was kept, or nothing; a file that cannot be read is as good as none.
std::optional<SceneEmission> readKept(const fs::path& file, const Scene& scene, const SceneSpheres& spheres) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  try {
    return readEmission(file, scene, spheres);
  } catch (const Error&) {
    return std::nullopt;
  }
}

void addTime(BakeTime* time, const BakeTime& more) {
  if (time == nullptr) return;
  if (!more.note.empty()) time->note = more.note;
  if (time->seconds && more.seconds) time->seconds = *time->seconds + *more.seconds;
}

}  // namespace

SceneEmission emissionForDrawing(const Scene& scene, const SceneSpheres& spheres, const std::string& place,
                                 bool use_cache, Console& console, BakeTime* time) {
  const EmissionOptions options;
  const std::optional<fs::path> folder = use_cache ? cacheFolder("emission") : std::nullopt;
  fs::path file;
  if (folder) {
    file = *folder / (keyOf(scene, spheres, options) + ".emission");
    if (std::optional<SceneEmission> kept = readKept(file, scene, spheres)) {
      console.remarks(place, kept->warnings);
      addTime(time, readBakeTime(file));
      return *std::move(kept);
    }
  }
  const auto started = std::chrono::steady_clock::now();
  SceneEmission emission = sampleEmission(scene, spheres, options, console.progress());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  const BakeTime sampled{took.count(), ""};
  addTime(time, sampled);
  console.endProgress();
  console.remark(
      fmt::format("{}: {} of samples of {} spheres, in {} (32 to 150 KB an object in the paper of 2008)",
                  place, bytesText(double(emission.bytes())), spheres.count(), durationText(took.count())));
  console.remarks(place, emission.warnings);
  if (folder) {
    try {
      writeEmission(emission, file);
      writeBakeTime(sampled, file);
    } catch (const Error& error) {
      console.remark(fmt::format("what spheres send is not kept: {}", error.what()));
    }
  }
  return emission;
}

void giveSpheres(Renderer& renderer, const TechniqueInfo& info, const Scene& scene,
                 const SceneSpheres& spheres, const std::string& place, bool use_cache, Console& console) {
  if (!info.needs_spheres) return;
  renderer.setSpheres(scene, spheres);
  if (info.needs_emission)
    renderer.setEmission(scene, emissionForDrawing(scene, spheres, place, use_cache, console));
}

}  // namespace gloam::cli
