// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 3.4: light of all subsplats. Differs: levels one after the other, from coarse to fine, so that the
// light itself may ask for finer texels (MS-10).
#include <fmt/format.h>

#include "shaders/splatting_shaders.h"
#include "techniques/splatting/splatting_levels.h"
#include "techniques/splatting/splatting_visibility.h"

namespace gloam::splatting {

namespace {

struct Step {
  gpu::FrameGraph& graph;
  const frame::FrameInputs& inputs;
  const Plan& plan;
  std::vector<Level>& levels;
  const Subsplats& subsplats;
  const vpls::Vpls& vpls;
  const GatherOptions& options;

  gpu::BufferRef arguments(std::size_t index) const {
    return subsplats.arguments.slice(index * sizeof(Groups), sizeof(Groups));
  }
};

void recordPoints(const Step& step, int k) {
  const Level& level = step.levels[std::size_t(k)];
  const Level& means = step.levels[std::size_t(std::max(k, 1))];
  step.graph.compute("splatting.points", splatting_points_spv)
      .specialize("at_pixel", k == step.plan.finest)
      .read("frame_view", step.inputs.view)
      .read("depth", step.inputs.gbuffer.depth)
      .read("normals", step.inputs.gbuffer.normals)
      .read("positions", means.positions)
      .read("shadings", means.shadings)
      .read("counts", step.subsplats.counts)
      .read("leaves", level.leaves)
      .write("subsplats", step.subsplats.points)
      .push(std::int32_t(k))
      .dispatchIndirect(step.arguments(std::size_t(k)));
}

void recordLight(const Step& step, int k, bool measures) {
  const Level& level = step.levels[std::size_t(k)];
  const bool shadowed = step.options.rays != nullptr;
  gpu::BufferRef visible = step.graph.findBuffer("splatting.nothing");
  if (shadowed)
    visible =
        step.graph.create(fmt::format("splatting.visible_{}", k),
                          gpu::BufferDesc{.bytes = 8 * std::size_t(level.width) * std::size_t(level.height)});
  const auto shared = std::make_shared<LevelPlaces>();
  for (std::uint32_t i = 0; i < step.vpls.chunks(); ++i) {
    if (shadowed)
      recordVisibility(step.graph, step.inputs, step.subsplats, step.vpls, *step.options.rays,
                       {k, i, visible}, shared);
    auto& pass = step.graph.compute("splatting.gather", splatting_gather_spv);
    (i == 0 ? pass.write("light", step.subsplats.light) : pass.readWrite("light", step.subsplats.light))
        .specialize("first", i == 0)
        .specialize("measures", measures)
        .specialize("shadowed", shadowed)
        .specialize("bound_kind", step.options.bound_kind)
        .read("visible", visible)
        .read("vpls", step.vpls.chunk(i))
        .read("counts", step.subsplats.counts)
        .read("subsplats", step.subsplats.points)
        .push(std::int32_t(k))
        .dispatchIndirect(step.arguments(kMostLevels + std::size_t(k) * step.vpls.chunks() + i));
  }
}

void recordConvergence(const Step& step, int k) {
  const Level &level = step.levels[std::size_t(k)], &finer = step.levels[std::size_t(k - 1)];
  step.graph.compute("splatting.converge", splatting_converge_spv)
      .specialize("children_are_pixels", k == 1)
      .read("frame_view", step.inputs.view)
      .read("child_pixels", k == 1 ? step.inputs.gbuffer.depth : finer.positions)
      .readWrite("counts", step.subsplats.counts)
      .read("subsplats", step.subsplats.points)
      .read("light", step.subsplats.light)
      .readWrite("leaves", level.leaves)
      .readWrite("children", finer.leaves)
      .push(LevelPush{k, step.plan.finest, 0, step.options.light_threshold})
      .dispatchIndirect(step.arguments(std::size_t(k)));
}

void recordPlacing(const Step& step, int k) {
  Level& level = step.levels[std::size_t(k)];
  level.light = step.graph.create(
      fmt::format("splatting.light_{}", k),
      gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = level.width, .height = level.height});
  step.graph.clear("splatting.place", level.light);
  step.graph.compute("splatting.place", splatting_place_spv)
      .read("counts", step.subsplats.counts)
      .specialize("paints_levels", step.options.paints_levels)
      .read("leaves", level.leaves)
      .read("light", step.subsplats.light)
      .write("level_light", level.light)
      .push(std::int32_t(k))
      .dispatchIndirect(step.arguments(std::size_t(k)));
}

}  // namespace

void recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                  std::vector<Level>& levels, const Subsplats& subsplats, const vpls::Vpls& vpls,
                  const GatherOptions& options) {
  const Step step{graph, inputs, plan, levels, subsplats, vpls, options};
  for (int k = plan.coarsest; k >= plan.finest; --k) {
    graph.compute("splatting.arguments", splatting_arguments_spv)
        .specialize("of_leaves", true)
        .readWrite("counts", subsplats.counts)
        .write("arguments", subsplats.arguments)
        .read("vpl_count", vpls.count)
        .push(LevelPush{k, plan.finest, std::int32_t(vpls.chunks()), 0.0f})
        .dispatch(1);
    const bool converges = options.light_threshold > 0.0f && k > plan.finest;
    recordPoints(step, k);
    recordLight(step, k, converges);
    if (converges) recordConvergence(step, k);
    recordPlacing(step, k);
  }
}

}  // namespace gloam::splatting
