// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_volume.h"

#include <fmt/format.h>
#include <scene/checkpoint_file.h>

#include "arguments.h"

namespace gloam::cli {
namespace {

constexpr CheckpointKind kVolumes{{'g', 'l', 'o', 'a', 'm', 'v', 'o', 'l'}, 1, "volumes"};

Fingerprint fingerprintOf(const Scene& scene, const VolumeBakeOptions& options) {
  Fingerprint print;
  add(print, scene);
  const auto& [order, scatterings, directions, scatter_directions, threads, time_s, memory_bytes] = options;
  addAll(print, order, scatterings, directions, scatter_directions, time_s);
  return print;
}

void keep(const Scene& scene, const VolumeReport& report, const std::filesystem::path& path,
          const Fingerprint& fingerprint) {
  CheckpointWriter file(path, kVolumes, fingerprint);
  file.write(&report, sizeof report);
  for (const Node& node : scene.nodes) {
    const bool baked = node.volume && node.volume->transfer;  // not where no root leads to it
    file.write(&baked, sizeof baked);
    if (!baked) continue;
    const Transfer& transfer = *node.volume->transfer;
    file.write(transfer.direct.data(), transfer.direct.size() * sizeof(float));
    file.write(transfer.indirect.data(), transfer.indirect.size() * sizeof(float));
  }
  file.commit();
}

/// False where nothing was kept. Throws Error where the file is not that of these volumes.
bool takeKept(Scene& scene, const VolumeBakeOptions& options, const std::filesystem::path& path,
              const Fingerprint& fingerprint, VolumeReport& report) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  CheckpointReader file(path, kVolumes, fingerprint);
  file.read(&report, sizeof report);
  for (Node& node : scene.nodes) {
    bool baked = false;
    file.read(&baked, sizeof baked);
    if (!baked || !node.volume) continue;
    auto transfer = std::make_shared<Transfer>();
    transfer->order = options.order;
    transfer->bounces = options.scatterings - 1;
    transfer->directions = options.directions;
    transfer->direct.resize(node.volume->voxels() * std::size_t(options.order * options.order));
    if (transfer->bounces > 0) transfer->indirect.resize(3 * transfer->direct.size());
    file.read(transfer->direct.data(), transfer->direct.size() * sizeof(float));
    file.read(transfer->indirect.data(), transfer->indirect.size() * sizeof(float));
    auto volume = std::make_shared<Volume>(*node.volume);
    volume->transfer = std::move(transfer);
    node.volume = std::move(volume);
  }
  file.finish();
  return true;
}

}  // namespace

void addVolumeOptions(CLI::App& app, VolumeChoice& choice) {
  choice.scatterings_option = addInteger(app, "--scatterings", choice.options.scatterings, {1, 256}, "N",
                                         "orders of scattering in volumes; 1: light scattered once")
                                  ->default_str(std::to_string(choice.options.scatterings))
                                  ->group("Volumes");
}

Json estimateVolumes(const Scene& scene, VolumeChoice& choice, const BakeOptions& bake, bool half_float,
                     Console& console, bool print) {
  if (!carriesVolumes(scene)) {
    if (choice.scatterings_option->count() > 0)
      console.remark("--scatterings has no effect: the scene holds no volume");
    return nullptr;
  }
  choice.options.order = bake.order;
  choice.options.threads = bake.threads;
  choice.options.time_s = bake.time_s;
  choice.options.memory_bytes = bake.memory_bytes;
  const VolumeEstimate estimate = gloam::estimateVolumes(scene, choice.options);
  const std::size_t file_bytes = estimate.file_bytes / (half_float ? 2 : 1);
  const std::string line =
      fmt::format("{}: {} of {} voxels hold something; at most {} of memory, {} in the file",
                  volumeNames(scene), countText(estimate.filled), countText(estimate.voxels),
                  bytesText(double(estimate.memory_bytes)), bytesText(double(file_bytes)));
  if (!print) {
    console.remark(line);
  } else if (!console.json) {
    console.print(line);
  }
  return {{"volumes", estimate.volumes},
          {"voxels", estimate.voxels},
          {"filled_voxels", estimate.filled},
          {"memory_bytes", estimate.memory_bytes},
          {"file_bytes", file_bytes}};
}

Scene bakeVolumesAsChosen(Scene scene, const VolumeChoice& choice, const BakeCheckpoints& checkpoints,
                          Console& console, Json& json) {
  json = nullptr;
  if (!carriesVolumes(scene)) return scene;
  VolumeReport report;
  const Fingerprint fingerprint = fingerprintOf(scene, choice.options);
  const bool resumed = takeKept(scene, choice.options, checkpoints.volumes(), fingerprint, report);
  Scene baked = resumed ? std::move(scene) : bakeVolumes(scene, choice.options, console.progress(), &report);
  console.endProgress();
  if (!resumed) keep(baked, report, checkpoints.volumes(), fingerprint);
  if (!console.json)
    console.remark(
        fmt::format("{}: {} voxels in {}; the last of {} scatterings brought {:.1f} % of the light{}",
                    volumeNames(baked), countText(report.filled), durationText(report.seconds),
                    choice.options.scatterings, 100.0 * report.last_order, resumed ? "; resumed" : ""));
  json = {{"volumes", report.volumes},
          {"filled_voxels", report.filled},
          {"scatterings", choice.options.scatterings},
          {"seconds", report.seconds},
          {"last_order", report.last_order},
          {"resumed", resumed}};
  return baked;
}

}  // namespace gloam::cli
