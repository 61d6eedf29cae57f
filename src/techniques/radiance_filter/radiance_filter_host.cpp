// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, section 3.3 (rows RF-4, RF-5): what the host needs to filter and shade, and the pass that does.
#include "techniques/radiance_filter/radiance_filter_host.h"

#include <tbb/parallel_for.h>

#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

/// Of pixels, from points that stand by sets.
void readSurfaces(const Plan& plan, const Interleaving& in, const frame::FrameView& view,
                  std::span<const visibility::SightPoint> points, std::span<const glm::uvec2> ids,
                  HostSurfaces& surfaces) {
  if (surfaces.width != plan.width || surfaces.height != plan.height)
    surfaces = HostSurfaces(plan.width, plan.height);
  const float footprints =
      plan.depth_threshold * float(std::max(plan.taps.x, plan.taps.y)) * glm::length(view.step_x);
  tbb::parallel_for(0, plan.height, [&](int row) {
    const auto y = std::uint32_t(row);
    for (std::uint32_t x_set = 0; x_set < in.sets_x; ++x_set) {
      const visibility::SightPoint* point =
          &points[((y % in.sets_y * in.sets_x + x_set) * in.tile_height + y / in.sets_y) * in.tile_width];
      for (std::uint32_t x = x_set; x < in.width; x += in.sets_x, ++point) {
        const float along =
            view.depth_range > 0.0f ? 1.0f : glm::dot(point->position - view.eye, view.forward);
        const std::size_t at = surfaces.at(int(x), row);
        surfaces.x[at] = point->position.x, surfaces.y[at] = point->position.y;
        surfaces.z[at] = point->position.z;
        surfaces.normal_x[at] = point->normal.x, surfaces.normal_y[at] = point->normal.y;
        surfaces.normal_z[at] = point->normal.z;
        surfaces.tolerance[at] = footprints * along;
        surfaces.objects[at] = ids[std::size_t(y) * in.width + x].x;
      }
    }
  });
}

constexpr const char* kPass = "radiance_filter.filter";

/// Copies between images and memory that the host reads, larger than a binding where need be, named as the pass, whose time they are.
struct Exchange {
  gpu::FrameGraph& graph;
  std::size_t pixels;

  gpu::BufferRef make(const std::string& name, std::size_t bytes_a_pixel) const {
    return graph.create(
        name, gpu::BufferDesc{.bytes = pixels * bytes_a_pixel, .host_visible = true, .by_address = true});
  }
  gpu::BufferRef read(const std::string& name, gpu::ImageRef image, std::size_t bytes_a_pixel) const {
    const gpu::BufferRef buffer = make(name, bytes_a_pixel);
    graph.copy(kPass, image, buffer);
    return buffer;
  }
};

/// Where the lobes of one part go.
struct PartRefs {
  gpu::BufferRef irradiance, gloss;
};

}  // namespace

bool filtersOnHost(const gpu::Device& device, const Plan& plan) {
  constexpr std::size_t kLeast = 4;  // pixels: a vector's worth of values is read at once
  return plan.pixels() >= kLeast && !plan.brute() && device.info().software &&
         plan.means != visibility::Means::kDevice && plan.filter == Filter::kTwoPass &&
         plan.taps != glm::ivec2(1) && plan.mode != Mode::kIrradianceNormals;
}

HostResult recordOnHost(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                        const Light& light, HostSurfaces& surfaces) {
  constexpr std::size_t kFour = 4 * sizeof(std::uint16_t);
  const Exchange exchange{graph, plan.pixels()};
  const std::size_t layers = std::size_t(plan.layers()) * plan.parts.size();
  const bool shades = plan.keepsField();
  const gpu::BufferRef points = light.points, values = light.host_values, exposure = light.exposure,
                       view = inputs.view;
  const gpu::BufferRef filtered = exchange.make("radiance_filter.host_filtered", layers * kFour),
                       ids =
                           exchange.read("radiance_filter.host_ids", inputs.gbuffer.ids, sizeof(glm::uvec2));
  gpu::BufferRef normals, diffuse;
  std::vector<PartRefs> parts;
  if (shades) {
    normals = exchange.read("radiance_filter.host_normals", inputs.gbuffer.normals, sizeof(glm::uvec2));
    diffuse = exchange.read("radiance_filter.host_diffuse", inputs.gbuffer.diffuse, kFour);
    for (std::size_t part = 0; part < plan.parts.size(); ++part)
      parts.push_back({exchange.make(fmt::format("radiance_filter.host_irradiance_{}", part), kFour),
                       exchange.make(fmt::format("radiance_filter.host_gloss_{}", part), kFour)});
  }
  auto& pass = graph.host(kPass);
  pass.read(view).read(ids).read(points).read(exposure).read(values).write(filtered);
  if (shades) pass.read(normals).read(diffuse);
  for (const PartRefs& part : parts) pass.write(part.irradiance).write(part.gloss);
  const Interleaving in = interleavingOf(plan, inputs.scene, kEverySet);
  pass.run([=, &surfaces](gpu::HostAccess& access) {
    const frame::FrameView camera = access.download<frame::FrameView>(view).at(0);
    readSurfaces(plan, in, camera, access.map<visibility::SightPoint>(points), access.map<glm::uvec2>(ids),
                 surfaces);
    const std::span<std::uint16_t> all = access.map<std::uint16_t>(filtered);
    std::vector<HostShading> shadings;
    for (std::size_t i = 0; i < parts.size(); ++i)
      shadings.push_back({.values = all.subspan(i * kFieldLayers * 4 * plan.pixels()),
                          .diffuse = access.map<std::uint16_t>(diffuse),
                          .normals = access.map<glm::uvec2>(normals),
                          .eye = camera.eye,
                          .forward = camera.forward,
                          .perspective = !(camera.depth_range > 0.0f),
                          .beams = plan.beams && plan.parts[i] == frame::Path::kDirect,
                          .exposure = access.map<float>(exposure)[0],
                          .irradiance = access.map<std::uint16_t>(parts[i].irradiance),
                          .gloss = access.map<std::uint16_t>(parts[i].gloss)});
    const HostFilter filter{plan.taps, int(plan.parts.size()), plan.layers(), plan.slopes};
    filterOnHost(surfaces, filter, access.map<std::uint16_t>(values), all, [&](int row, int from, int to) {
      for (const HostShading& shading : shadings) shadeRow(surfaces, shading, row, from, to);
    });
  });

  HostResult result;
  if (!shades || plan.views) {
    result.filtered =
        createValues(graph, plan, "radiance_filter.filtered_packed", VK_FORMAT_R16G16B16A16_SFLOAT);
    graph.copy(kPass, filtered, result.filtered);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    result.shaded.push_back(createShaded(graph, plan, i));
    graph.copy(kPass, parts[i].irradiance, result.shaded[i].irradiance);
    graph.copy(kPass, parts[i].gloss, result.shaded[i].gloss);
  }
  return result;
}

}  // namespace gloam::radiance_filter
