// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, sections 2.3 and 3 (rows RF-4, RF-5): averages over a window that holds each set once, then shading.
#include "shaders/radiance_filter_shaders.h"
#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

/// Pixels that one invocation filters along its axis: on software drivers neighbours share what they load, GPUs have caches.
/// All is unrolled, which takes those drivers seconds at first use if there is much of it.
int runOf(const gpu::Device& device, int taps) {
  return !device.info().software || taps > kMostTapsReplaced ? 1 : (taps > 8 ? 4 : 8);
}

FilterLimits limitsOf(const Plan& plan, int axis = 0) {
  return {std::uint32_t(plan.width), std::uint32_t(plan.height),
          plan.depth_threshold * float(std::max(plan.taps.x, plan.taps.y)), std::uint32_t(axis),
          plan.normal_threshold};
}

template <class Pass>
Pass& readSurface(Pass& pass, const frame::FrameInputs& inputs, const Plan& plan) {
  return pass.read("frame_view", inputs.view)
      .read("depth", inputs.gbuffer.depth)
      .read("ids", inputs.gbuffer.ids)
      .read("normals", inputs.gbuffer.normals)
      .specialize("tests_normals", plan.mode == Mode::kIrradianceNormals);
}

/// One axis of the separable filter over planes of words.
struct Axis {
  int number, taps, run;
  const Plan& plan;

  /// Runs along the axis, by lines.
  void over(gpu::ComputePass& pass, int planes) const {
    const auto runs = [&](int side) { return (side + run - 1) / run; };
    pass.specialize("taps", taps).specialize("run", run);
    pass.dispatchOver(number == 0 ? runs(plan.width) : plan.width,
                      number == 0 ? plan.height : runs(plan.height), planes);
  }
};

/// Bits of taps along both axes.
struct Masks {
  gpu::BufferRef across, down;
  gpu::BufferRef of(int axis) const { return axis == 0 ? across : down; }
};

Axis axisOf(const gpu::Device& device, const Plan& plan, int axis) {
  return {axis, plan.taps[axis], runOf(device, plan.taps[axis]), plan};
}

Masks recordMasks(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan) {
  const auto of = [&](int axis) {
    const auto masks = graph.create(fmt::format("radiance_filter.masks_{}", axis == 0 ? "across" : "down"),
                                    gpu::BufferDesc{.bytes = plan.pixels() * sizeof(std::uint32_t)});
    auto& weights = graph.compute("radiance_filter.weights", radiance_filter_weights_spv);
    axisOf(graph.device(), plan, axis)
        .over(readSurface(weights, inputs, plan).write("masks", masks).push(limitsOf(plan, axis)), 1);
    return masks;
  };
  return {of(0), of(1)};
}

void recordTwoPasses(gpu::FrameGraph& graph, const Plan& plan, const Masks& masks, gpu::ImageRef values,
                     gpu::ImageRef filtered) {
  const gpu::ImageRef halfway = createValues(graph, plan, "radiance_filter.halfway_packed", values.format());
  for (int axis = 0; axis < 2; ++axis) {
    auto& filter = graph.compute("radiance_filter.filter", radiance_filter_filter_spv);
    filter.read("masks", masks.of(axis))
        .read("before", axis == 0 ? values : halfway)
        .write("after", axis == 0 ? halfway : filtered)
        .push(axis);
    axisOf(graph.device(), plan, axis).over(filter, values.range().layers);
  }
}

}  // namespace

gpu::ImageRef recordFilter(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           const Light& light) {
  if (plan.filter == Filter::kNone || plan.taps == glm::ivec2(1)) return light.values;
  const gpu::ImageRef filtered =
      createValues(graph, plan, "radiance_filter.filtered_packed", light.values.format());
  const Masks masks = recordMasks(graph, inputs, plan);
  const bool one_pass = plan.filter == Filter::kOnePass;
  if (!one_pass) recordTwoPasses(graph, plan, masks, light.values, filtered);
  const auto shifts =
      graph.create("radiance_filter.shifts", gpu::BufferDesc{.bytes = plan.pixels() * sizeof(glm::vec2)});
  auto& once = readSurface(graph.compute("radiance_filter.once", radiance_filter_once_spv), inputs, plan)
                   .read("before", light.values)
                   .read("masks_across", masks.across)
                   .read("masks_down", masks.down)
                   .write("shifts", shifts);
  (one_pass ? once.write("after", filtered) : once.readWrite("after", filtered))
      .specialize("layers", plan.layers())
      .specialize("parts", int(plan.parts.size()))
      .specialize("taps_x", plan.taps.x)
      .specialize("taps_y", plan.taps.y)
      .specialize("every_pixel", one_pass)
      .push(limitsOf(plan))
      .dispatchOver(plan.width, plan.height, 1);
  if (plan.slopes)
    readSurface(graph.compute("radiance_filter.slopes", radiance_filter_slopes_spv), inputs, plan)
        .read("shifts", shifts)
        .readWrite("means", filtered)
        .specialize("taps", std::max(plan.taps.x, plan.taps.y))
        .specialize("layers", plan.layers())
        .specialize("parts", int(plan.parts.size()))
        .push(limitsOf(plan))
        .dispatchOver(plan.width, plan.height, 1);
  return filtered;
}

Shaded createShaded(gpu::FrameGraph& graph, const Plan& plan, std::size_t part) {
  const auto image = [&](const char* what) {
    return graph.create(
        fmt::format("radiance_filter.{}_{}", what,
                    plan.parts[part] == frame::Path::kDirect ? "direct" : "indirect"),
        gpu::ImageDesc{.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = plan.width, .height = plan.height});
  };
  return {image("irradiance"), image("gloss")};
}

std::vector<Shaded> recordShading(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                                  gpu::ImageRef values, gpu::BufferRef exposure) {
  std::vector<Shaded> parts;
  for (std::size_t part = 0; part < plan.parts.size(); ++part) {
    const Shaded& shaded = parts.emplace_back(createShaded(graph, plan, part));
    graph.compute("radiance_filter.shade", radiance_filter_shade_spv)
        .read("frame_view", inputs.view)
        .read("depth", inputs.gbuffer.depth)
        .read("normals", inputs.gbuffer.normals)
        .read("diffuse", inputs.gbuffer.diffuse)
        .read("values", values)
        .read("exposure", exposure)
        .write("irradiance", shaded.irradiance)
        .write("gloss", shaded.gloss)
        .specialize("field", plan.keepsField())
        .specialize("beams", plan.beams && plan.parts[part] == frame::Path::kDirect)
        .push(int(part))
        .dispatchOver(shaded.irradiance);
  }
  return parts;
}

void recordViews(gpu::FrameGraph& graph, const Plan& plan, gpu::ImageRef values, gpu::BufferRef exposure,
                 const std::string& name, bool with_weights) {
  const auto image = [&](const std::string& of) {
    return graph.create(
        of,
        gpu::ImageDesc{.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = plan.width, .height = plan.height});
  };
  const int bands = plan.keepsField() ? 3 : 2;
  for (int band = 0; band < bands + (with_weights ? 2 : 0); ++band) {
    const auto view = image(band < bands    ? fmt::format("{}_{}", name, band)
                            : band == bands ? "radiance_filter.weights"
                                            : "radiance_filter.set");
    graph.compute("radiance_filter.views", radiance_filter_views_spv)
        .read("values", values)
        .read("exposure", exposure)
        .write("view", view)
        .specialize("field", plan.keepsField())
        .specialize("band", band < bands ? band : 3 + band - bands)
        .specialize("parts", int(plan.parts.size()))
        .push(glm::uvec2(plan.sets))
        .dispatchOver(view);
  }
}

}  // namespace gloam::radiance_filter
