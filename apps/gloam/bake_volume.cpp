// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_volume.h"

#include <fmt/format.h>

#include "arguments.h"

namespace gloam::cli {

void addVolumeOptions(CLI::App& app, VolumeChoice& choice) {
  choice.scatterings_option = addInteger(app, "--scatterings", choice.options.scatterings, {1, 256}, "N",
                                         "orders of scattering in volumes; 1: light scattered once")
                                  ->default_str(std::to_string(choice.options.scatterings))
                                  ->group("Volumes");
}

Json estimateVolumes(const Scene& scene, VolumeChoice& choice, const BakeOptions& bake, Console& console,
                     bool print) {
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
  const std::string line =
      fmt::format("{}: {} of {} voxels hold something; {} of memory, {} in the file", volumeNames(scene),
                  countText(estimate.filled), countText(estimate.voxels),
                  bytesText(double(estimate.memory_bytes)), bytesText(double(estimate.file_bytes)));
  if (!print) {
    console.remark(line);
  } else if (!console.json) {
    console.print(line);
  }
  return {{"volumes", estimate.volumes},
          {"voxels", estimate.voxels},
          {"filled_voxels", estimate.filled},
          {"memory_bytes", estimate.memory_bytes},
          {"file_bytes", estimate.file_bytes}};
}

Scene bakeVolumesAsChosen(Scene scene, const VolumeChoice& choice, Console& console, Json& json) {
  json = nullptr;
  if (!carriesVolumes(scene)) return scene;
  VolumeReport report;
  Scene baked = bakeVolumes(scene, choice.options, console.progress(), &report);
  console.endProgress();
  if (!console.json)
    console.remark(
        fmt::format("{}: {} voxels in {}; the last of {} scatterings brought {:.1f} % of the light",
                    volumeNames(scene), countText(report.filled), durationText(report.seconds),
                    choice.options.scatterings, 100.0 * report.last_order));
  json = {{"volumes", report.volumes},
          {"filled_voxels", report.filled},
          {"scatterings", choice.options.scatterings},
          {"seconds", report.seconds},
          {"last_order", report.last_order}};
  return baked;
}

}  // namespace gloam::cli
