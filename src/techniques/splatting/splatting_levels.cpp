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

constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT, kHalves = VK_FORMAT_R16G16B16A16_SFLOAT;

struct RefinePush {
  Thresholds thresholds;
  std::int32_t level;
};
struct ArgumentsPush {
  std::int32_t level, finest, pixel_leaves, chunks;
};

gpu::BufferRef argumentsOf(const Subsplats& subsplats, int index) {
  return subsplats.arguments.slice(std::size_t(index) * sizeof(Groups), sizeof(Groups));
}

void recordArguments(gpu::FrameGraph& graph, const Subsplats& subsplats, const vpls::Vpls& vpls,
                     bool at_the_end, const ArgumentsPush& push) {
  graph.compute("splatting.arguments", splatting_arguments_spv)
      .specialize("at_the_end", at_the_end)
      .readWrite("counts", subsplats.counts)
      .write("arguments", subsplats.arguments)
      .read("vpl_count", vpls.count)
      .push(push)
      .dispatch(1);
}

void recordPoints(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                  std::span<const Level> levels, const Subsplats& subsplats) {
  for (int k = plan.coarsest; k >= plan.finest; --k) {
    const Level& level = levels[std::size_t(k)];
    const Level& means = levels[std::size_t(std::max(k, 1))];
    graph.compute("splatting.points", splatting_points_spv)
        .specialize("at_pixel", k == plan.finest)
        .read("frame_view", inputs.view)
        .read("depth", inputs.gbuffer.depth)
        .read("normals", inputs.gbuffer.normals)
        .read("positions", means.positions)
        .read("shadings", means.shadings)
        .read("counts", subsplats.counts)
        .read("leaves", level.leaves)
        .write("subsplats", subsplats.points)
        .push(std::int32_t(k))
        .dispatchIndirect(argumentsOf(subsplats, k));
  }
}

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
    const auto image = [&](const char* name, VkFormat format) {
      return graph.create(fmt::format("splatting.{}_{}", name, k),
                          gpu::ImageDesc{.format = format, .width = level.width, .height = level.height});
    };
    if (k > 0) {
      level.least = image("least", kHalves);
      level.greatest = image("greatest", kHalves);
      level.positions = image("positions", kFloats);
      level.shadings = image("shadings", kHalves);
      auto& pass = k == 1 ? graph.compute("splatting.ranges", splatting_ranges_first_spv)
                                .specialize("by_shading_normal", by_shading_normal)
                                .read("frame_view", inputs.view)
                                .read("depth", inputs.gbuffer.depth)
                                .read("normals", inputs.gbuffer.normals)
                          : graph.compute("splatting.ranges", splatting_ranges_next_spv)
                                .read("fine_least", levels.back().least)
                                .read("fine_greatest", levels.back().greatest)
                                .read("fine_positions", levels.back().positions)
                                .read("fine_shadings", levels.back().shadings);
      pass.write("least", level.least)
          .write("greatest", level.greatest)
          .write("positions", level.positions)
          .write("shadings", level.shadings)
          .dispatchOver(level.least);
    }
    levels.push_back(level);
  }
  return levels;
}

Subsplats recordRefinement(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           std::vector<Level>& levels, const Thresholds& thresholds, const vpls::Vpls& vpls) {
  const std::size_t pixels = std::size_t(levels[0].width) * std::size_t(levels[0].height);
  Subsplats subsplats;
  subsplats.counts = graph.create("splatting.counts", gpu::BufferDesc{.bytes = sizeof(Counts)});
  subsplats.arguments =
      graph.create("splatting.arguments",
                   gpu::BufferDesc{.bytes = (std::size_t(kMostLevels) + vpls.chunks()) * sizeof(Groups)});
  subsplats.points = graph.create("splatting.points", gpu::BufferDesc{.bytes = pixels * sizeof(Subsplat)});
  graph.clear("splatting.counts", subsplats.counts);
  const gpu::BufferRef nothing = graph.uploadOne("splatting.nothing", std::uint32_t(0));
  const auto places = [&](const char* name, int k) {
    const Level& level = levels[std::size_t(k)];
    return graph.create(fmt::format("splatting.{}_{}", name, k),
                        gpu::BufferDesc{.bytes = 4 * std::size_t(level.width) * std::size_t(level.height)});
  };
  gpu::BufferRef queue = nothing;
  for (int k = plan.coarsest; k >= std::max(plan.finest, 1); --k) {
    Level& level = levels[std::size_t(k)];
    const bool splits = k > plan.finest;
    level.leaves = places("leaves", k);
    const gpu::BufferRef children =
        splits ? places("queue", k - 1) : graph.create("splatting.unused", gpu::BufferDesc{.bytes = 4});
    auto& pass =
        graph.compute("splatting.refine", splatting_refine_spv)
            .specialize("coarsest", k == plan.coarsest)
            .specialize("splits", splits)
            .specialize("children_are_pixels", k == 1)
            .read("least", level.least)
            .read("greatest", level.greatest)
            .read("child_pixels", k == 1 ? inputs.gbuffer.depth : levels[std::size_t(k - 1)].positions)
            .readWrite("counts", subsplats.counts)
            .read("queue", queue)
            .write("leaves", level.leaves)
            .write("children", children)
            .push(RefinePush{thresholds, k});
    if (k == plan.coarsest)
      pass.dispatchOver(level.width * level.height);
    else
      pass.dispatchIndirect(argumentsOf(subsplats, k));
    if (!splits) break;
    queue = children;
    if (k - 1 > 0) recordArguments(graph, subsplats, vpls, false, {k - 1, 0, 0, 0});
  }
  const bool pixel_leaves = plan.finest == 0;
  if (pixel_leaves) levels[0].leaves = queue;
  recordArguments(graph, subsplats, vpls, true,
                  {plan.coarsest, plan.finest, pixel_leaves ? 1 : 0, std::int32_t(vpls.chunks())});
  recordPoints(graph, inputs, plan, levels, subsplats);
  return subsplats;
}

}  // namespace gloam::splatting
