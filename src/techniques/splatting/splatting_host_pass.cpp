// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The host's splatting as one pass between two of the device.
#include "techniques/splatting/splatting_host_pass.h"

namespace gloam::splatting {

gpu::ImageRef recordOnHost(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const LightSets& lights,
                           HostSplatting& host, const HostPlan& plan) {
  const auto shared = [&](const char* name, std::size_t bytes) {
    return graph.create(name, gpu::BufferDesc{.bytes = bytes, .host_visible = true});
  };
  const std::size_t pixels = std::size_t(plan.width) * std::size_t(plan.height);
  const gpu::BufferRef depth = shared("splatting.host_depth", pixels * sizeof(float)),
                       normals = shared("splatting.host_normals", pixels * sizeof(glm::uvec2)),
                       rows = shared("splatting.host_lights", lights.rows.bytes()),
                       light = shared("splatting.host_irradiance", pixels * sizeof(glm::vec4)),
                       counts = shared("splatting.counts", sizeof(Counts));
  graph.copy("splatting.host", inputs.gbuffer.depth, depth);
  graph.copy("splatting.host", inputs.gbuffer.normals, normals);
  graph.copy("splatting.host", lights.rows, rows);
  auto& pass = graph.host("splatting.host");
  pass.read(inputs.view).read(depth).read(normals).read(rows).write(light).write(counts);
  pass.run([=, &host, view = inputs.view, sets = lights.sets](gpu::HostAccess& access) {
    HostLights all{access.map<SplatLight>(rows), {}};
    for (const LightSet& set : sets) {
      std::span<const SplatLight> of_set = all.rows.subspan(set.first, set.rows);
      while (!of_set.empty() && of_set.back().power <= 0.0f) of_set = of_set.first(of_set.size() - 1);
      all.sets.push_back(of_set);
    }
    HostPlan now = plan;
    now.view = access.download<frame::FrameView>(view).at(0);
    host.splat(now, all, access.map<float>(depth), access.map<glm::uvec2>(normals),
               access.map<glm::vec4>(light));
    access.map<Counts>(counts)[0] = host.counts();
  });
  const auto irradiance = graph.create(
      "splatting.irradiance",
      gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = plan.width, .height = plan.height});
  graph.copy("splatting.host", light, irradiance);
  return irradiance;
}

}  // namespace gloam::splatting
