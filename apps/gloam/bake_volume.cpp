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
  VolumeBakeOptions options = choice.options;
  options.checkpoint = checkpoints.volumes();
  options.keep_checkpoint = true;
  Scene baked = bakeVolumes(scene, options, console.progress(), &report);
  console.endProgress();
  if (!console.json)
    console.remark(fmt::format(
        "{}: {} voxels in {}; the last of {} scatterings brought {:.1f} % of the light{}", volumeNames(baked),
        countText(report.filled), durationText(report.seconds), choice.options.scatterings,
        100.0 * report.last_order, report.resumed ? "; resumed" : ""));
  json = {{"volumes", report.volumes},
          {"filled_voxels", report.filled},
          {"scatterings", choice.options.scatterings},
          {"seconds", report.seconds},
          {"last_order", report.last_order},
          {"resumed", report.resumed}};
  return baked;
}

}  // namespace gloam::cli
