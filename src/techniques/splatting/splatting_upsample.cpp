// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 3.5, from coarse to fine; section 4.2, detail. The shaders say what differs.
#include <fmt/format.h>

#include "shaders/splatting_shaders.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {

gpu::ImageRef recordUpsampling(gpu::FrameGraph& graph, std::span<const Level> levels,
                               const Thresholds& thresholds, Upsampling upsampling, float detail,
                               gpu::BufferRef view, gpu::ImageRef normals) {
  const auto none = graph.create("splatting.none", gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT});
  graph.clear("splatting.none", none);
  const auto or_none = [&](gpu::ImageRef image) { return image ? image : none; };
  const auto result = [&](const Level& level, const std::string& name) {
    return graph.create(
        name, gpu::ImageDesc{
                  .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = level.width, .height = level.height});
  };
  const int way = upsampling == Upsampling::kBlocks ? 1 : (upsampling == Upsampling::kNaive ? 2 : 0);
  gpu::ImageRef coarse = none;
  for (std::size_t k = levels.size() - 1; k > 0; --k) {
    const Level& level = levels[k];
    const auto image = result(level, fmt::format("splatting.upsampled_{}", k));
    graph.compute("splatting.upsample", splatting_upsample_spv)
        .specialize("coarsest", k + 1 == levels.size())
        .specialize("along_surfaces", upsampling == Upsampling::kSurfaces)
        .specialize("way", way)
        .read("frame_view", view)
        .read("own", or_none(level.light))
        .read("coarse", coarse)
        .read("ranges", level.ranges)
        .write("result", image)
        .push(thresholds)
        .dispatchOver((level.width + 1) / 2, (level.height + 1) / 2);
    coarse = image;
  }
  const auto irradiance = result(levels[0], "splatting.irradiance");
  graph.compute("splatting.finish", splatting_finish_spv)
      .specialize("detail", detail)
      .specialize("way", way)
      .specialize("has_own", bool(levels[0].light))
      .read("frame_view", view)
      .read("own", or_none(levels[0].light))
      .read("coarse", coarse)
      .read("normals", normals)
      .write("result", irradiance)
      .dispatchOver((levels[0].width + 1) / 2, (levels[0].height + 1) / 2);
  return irradiance;
}

}  // namespace gloam::splatting
