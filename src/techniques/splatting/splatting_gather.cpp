// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 3.4: light of all subsplats. Differs: a first look by few merged lights, level by level from coarse
// to fine, so that the light itself may ask for finer texels (MS-10); then finer sets of lights where they are asked for (MS-9).
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
  const LightSets& lights;
  const GatherOptions& options;

  gpu::BufferRef arguments(int index) const {
    return subsplats.arguments.slice(std::size_t(index) * sizeof(Groups), sizeof(Groups));
  }
  void makeArguments(int of, int level, const LightSet& set) const {
    graph.compute("splatting.arguments", splatting_arguments_spv)
        .specialize("of", of)
        .readWrite("counts", subsplats.counts)
        .write("arguments", subsplats.arguments)
        .read("vpl_count", lights.count)
        .push(ArgumentsPush{level, set.chunks(), set.first_chunk})
        .dispatch(1);
  }
  /// Subsplats that ask for set s.
  gpu::BufferRef makeList(std::size_t s) const {
    return graph.create(fmt::format("splatting.list_{}", s), gpu::BufferDesc{.bytes = 4 * subsplats.most});
  }
};

/// The first look at level k. `next`: the set that those ask for whom it does not do.
void recordCoarse(const Step& step, int k, std::size_t next, gpu::BufferRef list) {
  struct Push {
    CoarsePush value;
    std::int32_t set;
  };
  const Level& level = step.levels[std::size_t(k)];
  const bool splits = k > step.plan.finest;
  const Level &finer = step.levels[std::size_t(splits ? k - 1 : k)],
              &means = step.levels[std::size_t(std::max(k, 1))];
  step.makeArguments(1, k, {});
  const bool shadowed = step.options.world != nullptr;
  auto& pass = step.graph.compute("splatting.coarse", splatting_coarse_spv)
                   .specialize("at_pixel", !splits)
                   .specialize("children_are_pixels", k == 1)
                   .specialize("merged", shadowed || next < step.lights.sets.size())
                   .specialize("bound_kind", step.options.bound_kind)
                   .read("lights", step.lights.chunk(step.lights.sets.size() - 1, 0))
                   .read("child_means", step.levels[std::size_t(std::max(k - 1, 1))].means)
                   .read("depth", step.inputs.gbuffer.depth)
                   .read("frame_view", step.inputs.view)
                   .read("normals", step.inputs.gbuffer.normals)
                   .read("means", means.means)
                   .readWrite("counts", step.subsplats.counts)
                   .readWrite("leaves", level.leaves)
                   .write("subsplats", step.subsplats.points)
                   .write("light", step.subsplats.light)
                   .write("list", list)
                   .push(Push{{k, splits ? step.options.light_threshold : 0.0f,
                               shadowed ? 0.0f : step.options.cluster_threshold},
                              std::int32_t(next)});
  pass.readWrite("children", splits ? finer.leaves : step.graph.findBuffer("splatting.nothing"));
  pass.dispatchIndirect(step.arguments(kOverFours + k));
}

/// All chunks of set s at the subsplats in `list`.
void recordSet(const Step& step, std::size_t s, gpu::BufferRef list) {
  const LightSet& set = step.lights.sets[s];
  const bool shadowed = step.options.world != nullptr;
  step.makeArguments(2, int(s), set);
  gpu::BufferRef visible = step.graph.findBuffer("splatting.nothing");
  if (shadowed)
    visible = step.graph.create("splatting.visible", gpu::BufferDesc{.bytes = 8 * step.subsplats.most});
  const auto places = std::make_shared<TracedPlaces>();
  for (int i = 0; i < set.chunks(); ++i) {
    if (shadowed)
      recordVisibility(step.graph, step.inputs, step.subsplats, step.lights, *step.options.world,
                       {i, list, visible}, places);
    auto& pass = step.graph.compute("splatting.gather", splatting_gather_spv);
    (i == 0 ? pass.write("light", step.subsplats.light) : pass.readWrite("light", step.subsplats.light))
        .specialize("first", i == 0)
        .specialize("merged", s > 0)
        .specialize("shadowed", shadowed)
        .specialize("bound_kind", step.options.bound_kind)
        .read("visible", visible)
        .read("lights", step.lights.chunk(s, i))
        .read("counts", step.subsplats.counts)
        .read("subsplats", step.subsplats.points)
        .read("list", list)
        .push(std::int32_t(s))
        .dispatchIndirect(step.arguments(kOverChunks + set.first_chunk + i));
  }
}

/// Those of set s's list for whom it does not do ask for set s - 1.
void recordSelection(const Step& step, std::size_t s, gpu::BufferRef list, gpu::BufferRef next_list) {
  struct Push {
    std::int32_t set;
    float cluster_threshold;
  };
  step.graph.compute("splatting.select", splatting_select_spv)
      .readWrite("counts", step.subsplats.counts)
      .read("light", step.subsplats.light)
      .read("list", list)
      .write("next_list", next_list)
      .push(Push{std::int32_t(s), step.options.cluster_threshold})
      .dispatchIndirect(step.arguments(kOverChunks + step.lights.sets[s].first_chunk));
}

void recordPlacing(const Step& step, int k) {
  Level& level = step.levels[std::size_t(k)];
  level.light = step.graph.create(
      fmt::format("splatting.light_{}", k),
      gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = level.width, .height = level.height});
  step.graph.clear("splatting.place", level.light);
  step.graph.compute("splatting.place", splatting_place_spv)
      .specialize("paints_levels", step.options.paints_levels)
      .read("counts", step.subsplats.counts)
      .read("leaves", level.leaves)
      .read("light", step.subsplats.light)
      .write("level_light", level.light)
      .read("frame_view", step.inputs.view)
      .read("normals", step.inputs.gbuffer.normals)
      .push(std::int32_t(k))
      .dispatchIndirect(step.arguments(k));
}

}  // namespace

void recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                  std::vector<Level>& levels, const Subsplats& subsplats, const LightSets& lights,
                  const GatherOptions& options) {
  const Step step{graph, inputs, plan, levels, subsplats, lights, options};
  const std::size_t sets = lights.sets.size();
  // Shadows are looked for toward every light; merged ones would stand beside what hides them.
  std::size_t next = options.world ? 0 : (sets > 1 ? sets - 2 : sets);
  gpu::BufferRef list =
      next < sets ? step.makeList(next) : graph.create("splatting.no_list", gpu::BufferDesc{.bytes = 4});
  for (int k = plan.coarsest; k >= plan.finest; --k) recordCoarse(step, k, next, list);
  while (next < sets) {
    recordSet(step, next, list);
    if (next == 0) break;
    const gpu::BufferRef next_list = step.makeList(next - 1);
    recordSelection(step, next, list, next_list);
    list = next_list;
    --next;
  }
  for (int k = plan.coarsest; k >= plan.finest; --k) {
    if (k > 0 || options.keeps_pixels) recordPlacing(step, k);
  }
}

void recordPixels(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Level& pixels,
                  const Subsplats& subsplats, float detail, gpu::ImageRef irradiance) {
  graph.compute("splatting.place", splatting_place_spv)
      .specialize("detail", detail)
      .read("counts", subsplats.counts)
      .read("leaves", pixels.leaves)
      .read("light", subsplats.light)
      .write("level_light", irradiance)
      .read("frame_view", inputs.view)
      .read("normals", inputs.gbuffer.normals)
      .push(std::int32_t(0))
      .dispatchIndirect(subsplats.arguments.slice(0, sizeof(Groups)));
}

}  // namespace gloam::splatting
