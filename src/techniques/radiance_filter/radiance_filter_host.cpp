// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, section 3.3 (row RF-4): what the host needs for the filter, and the pass that runs it.
#include "techniques/radiance_filter/radiance_filter_host.h"

#include <tbb/parallel_for.h>

#include <memory>

#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

/// Of pixels, from points that stand by sets.
HostSurfaces surfacesOf(const Plan& plan, const Interleaving& in, const frame::FrameView& view,
                        std::span<const visibility::SightPoint> points, std::span<const glm::uvec2> ids) {
  HostSurfaces surfaces(plan.width, plan.height);
  const float footprints =
      plan.depth_threshold * float(std::max(plan.taps.x, plan.taps.y)) * glm::length(view.step_x);
  tbb::parallel_for(0, plan.height, [&](int row) {
    const auto y = std::uint32_t(row);
    for (std::uint32_t x = 0; x < in.width; ++x) {
      const std::uint32_t set = y % in.sets_y * in.sets_x + x % in.sets_x;
      const visibility::SightPoint& point =
          points[(set * in.tile_height + y / in.sets_y) * in.tile_width + x / in.sets_x];
      const float along = view.depth_range > 0.0f ? 1.0f : glm::dot(point.position - view.eye, view.forward);
      const std::size_t at = surfaces.at(int(x), row);
      surfaces.x[at] = point.position.x, surfaces.y[at] = point.position.y, surfaces.z[at] = point.position.z;
      surfaces.normal_x[at] = point.normal.x, surfaces.normal_y[at] = point.normal.y;
      surfaces.normal_z[at] = point.normal.z;
      surfaces.tolerance[at] = footprints * along;
      surfaces.objects[at] = ids[std::size_t(y) * in.width + x].x;
    }
  });
  return surfaces;
}

}  // namespace

void recordFilterOnHost(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                        const Light& light, gpu::ImageRef filtered) {
  const gpu::ImageRef ids = inputs.gbuffer.ids, values = light.values;
  const gpu::BufferRef points = light.points, view = inputs.view;
  auto& pass = graph.host("radiance_filter.filter");
  pass.read(view).read(ids).read(points).read(values).write(filtered);
  const Interleaving in = interleavingOf(plan, inputs.scene, kEverySet);
  pass.run([=](gpu::HostAccess& access) {
    const HostSurfaces surfaces =
        surfacesOf(plan, in, access.download<frame::FrameView>(view).at(0),
                   access.map<visibility::SightPoint>(points), ids.image().download<glm::uvec2>());
    const int layers = values.range().layers;
    const std::size_t layer = 4 * plan.pixels(), all = layer * std::size_t(layers);
    const auto halves = std::make_unique_for_overwrite<std::uint16_t[]>(2 * all);
    const auto layerOf = [&](int l) { return std::span(halves.get() + std::size_t(l) * layer, layer); };
    for (int l = 0; l < layers; ++l) values.image().downloadBytes(std::as_writable_bytes(layerOf(l)), 0, l);
    filterOnHost(surfaces, plan.taps, layers, {halves.get(), all}, {halves.get() + all, all});
    auto& to = const_cast<gpu::Image&>(filtered.image());
    for (int l = 0; l < layers; ++l) to.uploadBytes(std::as_bytes(layerOf(l)), 0, l);
  });
}

}  // namespace gloam::radiance_filter
