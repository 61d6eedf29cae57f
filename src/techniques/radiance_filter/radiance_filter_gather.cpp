// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, sections 3.1 and 3.2 (rows RF-2, RF-3): the light of its set at each pixel. Points of one set stand together,
// so that their rays and their loops over virtual lights are alike.
#include "shaders/radiance_filter_shaders.h"
#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

constexpr VkFormat kValueFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

/// Steps of a sum over sets, as radiance_filter_gather.glsl knows them.
enum Step : int { kAlone, kFirst, kFurther, kLast };

struct Work {
  gpu::FrameGraph& graph;
  const frame::FrameInputs& inputs;
  const Plan& plan;
  const vpls::Walks& walks;
  gpu::BufferRef points;
  gpu::ImageRef values, sums;
  gpu::BufferRef host_values;  ///< where for_host; of `values` one texel is there then
  gpu::BufferRef exposure;
  bool for_host;
};

std::uint32_t pointsIn(const Interleaving& in) {
  return in.tile_width * in.tile_height * in.sets_x * in.sets_y;
}

/// Dispatches over points of all sets.
void overPoints(gpu::ComputePass& pass, const Interleaving& in) {
  pass.dispatchOver(int(in.tile_width), int(in.tile_height), int(in.sets_x * in.sets_y));
}

glm::uvec2 addressOf(gpu::BufferRef buffer) {
  const VkDeviceAddress address = buffer.buffer().address();
  return {std::uint32_t(address), std::uint32_t(address >> 32)};
}

void recordPoints(const Work& work, const Interleaving& in) {
  overPoints(work.graph.compute("radiance_filter.points", radiance_filter_points_spv)
                 .read("frame_view", work.inputs.view)
                 .read("depth", work.inputs.gbuffer.depth)
                 .read("normals", work.inputs.gbuffer.normals)
                 .write("points", work.points)
                 .push(in),
             in);
}

/// Light of one set at each point, or that of another set more.
void recordSet(const Work& work, visibility::Visibility& visibility, std::uint32_t set, Step step) {
  const Interleaving in = interleavingOf(work.plan, work.inputs.scene, set);
  recordPoints(work, in);
  if (step == kAlone || step == kFirst)
    work.graph.compute("radiance_filter.exposure", radiance_filter_exposure_spv)
        .read("points", work.points)
        .read("rows", work.walks.rows)
        .read("sets", work.walks.sets)
        .write("exposure", work.exposure)
        .push(pointsIn(in))
        .dispatch(1);
  const gpu::BufferRef visible = visibility.record(
      work.graph,
      step == kAlone ? "radiance_filter.visibility" : fmt::format("radiance_filter.visibility_{}", set),
      work.inputs.scene,
      {.points = work.points,
       .point_count = pointsIn(in),
       .lights = work.walks.rows,
       .light_bytes = sizeof(vpls::WalkVpl),
       .sets = work.walks.sets,
       .set_count = work.walks.set_count,
       .words = work.walks.words()},
      work.plan.means);
  const bool field = work.plan.keepsField();
  auto& pass = work.graph.compute("radiance_filter.gather",
                                  field ? radiance_filter_field_spv : radiance_filter_lobes_spv);
  if (!field)
    pass.read("frame_view", work.inputs.view)
        .read("normals", work.inputs.gbuffer.normals)
        .read("diffuse", work.inputs.gbuffer.diffuse);
  (step == kAlone || step == kFirst ? pass.write("sums", work.sums) : pass.readWrite("sums", work.sums))
      .write("values", work.values)
      .read("points", work.points)
      .read("rows", work.walks.rows)
      .read("sets", work.walks.sets)
      .read("visible", visible)
      .read("exposure", work.exposure)
      .specialize("step", int(step))
      .specialize("for_host", work.for_host)
      .specialize("parts", int(work.plan.parts.size()))
      .push(GatherParams{in, work.for_host ? addressOf(work.host_values) : glm::uvec2(0)});
  if (work.for_host) pass.writeByAddress(work.host_values);
  overPoints(pass, in);
}

/// Points and what they see are bound whole.
void checkSize(const gpu::Device& device, const Plan& plan, const vpls::Walks& walks) {
  const std::size_t each = std::max(sizeof(visibility::SightPoint), walks.words() * sizeof(std::uint32_t)),
                    most = device.limits().max_storage_bytes / each;
  if (plan.pixels() > most)
    throw Error("radiance_filter",
                fmt::format("a picture of {} x {} pixels; '{}' takes {} at {} virtual lights a set",
                            plan.width, plan.height, device.info().name, most, walks.stride));
}

}  // namespace

Interleaving interleavingOf(const Plan& plan, const frame::GpuScene& scene, std::uint32_t only_set) {
  const bool every = only_set == kEverySet;
  const std::uint32_t across = every ? std::uint32_t(plan.sets.x) : 1,
                      down = every ? std::uint32_t(plan.sets.y) : 1;
  const auto width = std::uint32_t(plan.width), height = std::uint32_t(plan.height);
  return {width,
          height,
          across,
          down,
          (width + across - 1) / across,
          (height + down - 1) / down,
          only_set,
          1e-5f * glm::distance(scene.boundsMin(), scene.boundsMax()),
          plan.bound};
}

gpu::ImageRef createValues(gpu::FrameGraph& graph, const Plan& plan, const std::string& name,
                           VkFormat format) {
  return graph.create(name, gpu::ImageDesc{.format = format,
                                           .width = plan.width,
                                           .height = plan.height,
                                           .layers = plan.layers() * int(plan.parts.size())});
}

Light recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                   const vpls::Walks& walks, visibility::Visibility& visibility) {
  checkSize(graph.device(), plan, walks);
  const bool sums = plan.brute() && walks.set_count > 1, for_host = filtersOnHost(graph.device(), plan);
  const Interleaving in = interleavingOf(plan, inputs.scene, plan.brute() ? 0 : kEverySet);
  const auto none = [&](const char* name, VkFormat format) {
    return graph.create(name, gpu::ImageDesc{.format = format, .layers = 2});
  };
  const auto shared = [&](const char* name, std::size_t bytes) {
    return graph.create(name, gpu::BufferDesc{.bytes = bytes, .host_visible = true});
  };
  const std::size_t halves = plan.pixels() * std::size_t(plan.layers()) * plan.parts.size() * 4;
  const Work work{
      graph,
      inputs,
      plan,
      walks,
      shared("radiance_filter.points", std::size_t(pointsIn(in)) * sizeof(visibility::SightPoint)),
      for_host ? none("radiance_filter.values_none", kValueFormat)
               : createValues(graph, plan, "radiance_filter.values_packed", kValueFormat),
      sums ? createValues(graph, plan, "radiance_filter.sums_packed", VK_FORMAT_R32G32B32A32_SFLOAT)
           : none("radiance_filter.sums_none", VK_FORMAT_R32G32B32A32_SFLOAT),
      for_host ? graph.create(
                     "radiance_filter.host_values",
                     gpu::BufferDesc{
                         .bytes = halves * sizeof(std::uint16_t), .host_visible = true, .by_address = true})
               : gpu::BufferRef(),
      shared("radiance_filter.exposure", sizeof(float)),
      for_host};
  if (!plan.brute()) {
    recordSet(work, visibility, kEverySet, kAlone);
  } else {
    for (std::uint32_t s = 0; s < walks.set_count; ++s)
      recordSet(work, visibility, s,
                !sums                      ? kAlone
                : s == 0                   ? kFirst
                : s + 1 == walks.set_count ? kLast
                                           : kFurther);
  }
  if (!for_host) return {.values = work.values, .exposure = work.exposure};
  Light light{.exposure = work.exposure, .points = work.points, .host_values = work.host_values};
  if (plan.views) {
    light.values = createValues(graph, plan, "radiance_filter.values_packed", kValueFormat);
    graph.copy("radiance_filter.views", light.host_values, light.values);
  }
  return light;
}

}  // namespace gloam::radiance_filter
