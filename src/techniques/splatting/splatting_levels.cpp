// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, sections 3.2, 3.3: min-max mipmaps and one list of subsplats for all lights. Differs: depth varies in
// proportion to itself, background is no discontinuity, texels receive at the mean of their pixels.
#include "techniques/splatting/splatting_levels.h"

#include <fmt/format.h>

#include "shaders/splatting_shaders.h"

namespace gloam::splatting {

namespace {

struct RefinePush {
  Thresholds thresholds;
  std::int32_t level;
};

}  // namespace

Plan planLevels(int width, int height, int coarsest_texels, int resolution) {
  const int shorter = std::min(width, height);
  Plan plan;
  while (plan.coarsest + 1 < kMostLevels && (shorter >> (plan.coarsest + 1)) >= coarsest_texels)
    ++plan.coarsest;
  while (resolution > 0 && plan.finest < plan.coarsest &&
         (shorter + (1 << plan.finest) - 1) >> plan.finest > resolution)
    ++plan.finest;
  return plan;
}

std::vector<Level> recordRanges(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                                bool by_shading_normal) {
  std::vector<Level> levels;
  for (int k = 0; k <= plan.coarsest; ++k) {
    Level level{.width = (inputs.gbuffer.width + (1 << k) - 1) >> k,
                .height = (inputs.gbuffer.height + (1 << k) - 1) >> k};
    const auto image = [&](const char* name) {
      return graph.create(
          fmt::format("splatting.{}_{}", name, k),
          gpu::ImageDesc{
              .format = VK_FORMAT_R32G32B32A32_UINT, .width = level.width, .height = level.height});
    };
    if (k > 0) {
      level.ranges = image("ranges");
      level.means = image("means");
      auto& pass = k == 1 ? graph.compute("splatting.ranges", splatting_ranges_first_spv)
                                .specialize("by_shading_normal", by_shading_normal)
                                .read("depth", inputs.gbuffer.depth)
                                .read("normals", inputs.gbuffer.normals)
                          : graph.compute("splatting.ranges", splatting_ranges_next_spv)
                                .read("fine_ranges", levels.back().ranges)
                                .read("fine_means", levels.back().means);
      pass.write("ranges", level.ranges).write("means", level.means).dispatchOver(level.ranges);
    }
    levels.push_back(level);
  }
  return levels;
}

void recordRangesToLookAt(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                          std::span<const Level> levels) {
  for (std::size_t k = 1; k < levels.size(); ++k) {
    const auto image = [&](const char* name) {
      return graph.create(
          fmt::format("splatting.{}_{}", name, k),
          gpu::ImageDesc{
              .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = levels[k].width, .height = levels[k].height});
    };
    const gpu::ImageRef least = image("least"), greatest = image("greatest");
    graph.compute("splatting.look", splatting_look_spv)
        .read("frame_view", inputs.view)
        .read("ranges", levels[k].ranges)
        .write("least", least)
        .write("greatest", greatest)
        .dispatchOver(least);
  }
}

Subsplats recordRefinement(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           std::vector<Level>& levels, const Thresholds& thresholds,
                           const LightSets& lights) {
  // Those that were split, coarser ones, are at most a third as many as pixels.
  Subsplats subsplats{.most = std::size_t(levels[0].width) * std::size_t(levels[0].height) * 4 / 3 + 4096};
  subsplats.counts = graph.create("splatting.counts", gpu::BufferDesc{.bytes = sizeof(Counts)});
  subsplats.arguments =
      graph.create("splatting.arguments",
                   gpu::BufferDesc{.bytes = std::size_t(kOverChunks + lights.chunks()) * sizeof(Groups)});
  subsplats.points =
      graph.create("splatting.points", gpu::BufferDesc{.bytes = subsplats.most * sizeof(Subsplat)});
  subsplats.light =
      graph.create("splatting.light", gpu::BufferDesc{.bytes = subsplats.most * sizeof(glm::vec4)});
  graph.clear("splatting.counts", subsplats.counts);
  const auto places = [&](const char* name, int k) {
    const Level& level = levels[std::size_t(k)];
    return graph.create(fmt::format("splatting.{}_{}", name, k),
                        gpu::BufferDesc{.bytes = 4 * std::size_t(level.width) * std::size_t(level.height)});
  };
  for (int k = plan.finest; k <= plan.coarsest; ++k) levels[std::size_t(k)].leaves = places("leaves", k);
  gpu::BufferRef queue = graph.uploadOne("splatting.nothing", std::uint32_t(0));
  for (int k = plan.coarsest; k >= std::max(plan.finest, 1); --k) {
    const Level& level = levels[std::size_t(k)];
    const bool splits = k > plan.finest;
    const gpu::BufferRef children = !splits  ? graph.create("splatting.unused", gpu::BufferDesc{.bytes = 4})
                                    : k == 1 ? levels[0].leaves
                                             : places("queue", k - 1);
    auto& pass = graph.compute("splatting.refine", splatting_refine_spv)
                     .specialize("coarsest", k == plan.coarsest)
                     .specialize("splits", splits)
                     .specialize("children_are_pixels", k == 1)
                     .read("frame_view", inputs.view)
                     .read("ranges", level.ranges)
                     .read("depth", inputs.gbuffer.depth)
                     .read("child_means", levels[std::size_t(std::max(k - 1, 1))].means)
                     .readWrite("counts", subsplats.counts)
                     .read("queue", queue)
                     .write("leaves", level.leaves)
                     .write("children", children)
                     .push(RefinePush{thresholds, k});
    if (k == plan.coarsest)
      pass.dispatchOver(level.width * level.height);
    else
      pass.dispatchIndirect(subsplats.arguments.slice(std::size_t(k) * sizeof(Groups), sizeof(Groups)));
    if (!splits || k == 1) break;
    queue = children;
    graph.compute("splatting.refine", splatting_arguments_spv)
        .specialize("of", 0)
        .readWrite("counts", subsplats.counts)
        .write("arguments", subsplats.arguments)
        .read("vpl_count", lights.count)
        .push(ArgumentsPush{k - 1, 0, 0})
        .dispatch(1);
  }
  return subsplats;
}

}  // namespace gloam::splatting
