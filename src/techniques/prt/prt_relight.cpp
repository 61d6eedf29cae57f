// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4: the light in each object's axes, and each vertex's dot product with it. Row PRT-4.
#include "techniques/prt/prt_relight.h"

#include <algorithm>

#include "math/sampling.h"
#include "math/sh_light_parts.h"
#include "scene/transforms.h"
#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_relight_kernel.h"

namespace gloam::prt {

namespace {

/// The light in each lit instance's axes is added, end to end.
void addRotatedLights(const sh::ShRgb& light, const frame::GpuScene& scene, const TransferBuffers& transfer,
                      std::vector<glm::vec3>& lights) {
  for (const std::uint32_t i : transfer.litInstances()) {
    const glm::mat3 world_from_object = rotationFactor(glm::mat3(scene.instances()[i].world_from_object));
    const sh::ShRgb turned = sh::rotate(glm::transpose(world_from_object), light);
    lights.insert(lights.end(), turned.coefficients().begin(), turned.coefficients().end());
  }
}

/// How far the light rings, 0 to 1: where in some direction a colour falls short of half of its windowed self, by a share of its
/// mean. A vertex gathers the light's bands by a weight that is nowhere negative, so that light which is high enough everywhere
/// leaves no vertex dark: soft skies are 0 and cost nothing. It grows from there, so that light that changes changes no picture at once.
float ringing(const sh::ShRgb& light) {
  constexpr float kFull = 0.1f;  // of the mean
  static const std::vector<glm::vec3> directions = sampling::fibonacciSphere(600);
  const sh::ShRgb soft = sh::windowHann(light, float(light.order));
  const glm::vec3 mean = glm::max(light[0] * sh::evaluate(1, {0, 1, 0})[0], glm::vec3(1e-9f));
  glm::vec3 lack(0.0f);
  for (const glm::vec3& d : directions) {
    const glm::vec3 least = kLeastOfDamped * glm::max(sh::valueAt(soft, d), glm::vec3(0.0f));
    lack = glm::max(lack, (least - sh::valueAt(light, d)) / mean);
  }
  return std::min(1.0f, std::max({lack.r, lack.g, lack.b}) / kFull);
}

/// Light that is damped vertex by vertex: its sharpest peak, as much of it as the light rings, and the rest.
sh::LightParts partsOf(const sh::ShRgb& all_bands, const sh::ShRgb& light, float share) {
  sh::LightParts parts = sh::lightParts(all_bands, light.order);
  parts.peak *= share;
  parts.rest = light;
  const sh::Sh there = sh::directionalLight(light.order, parts.direction);
  for (int i = 0; i < there.size(); ++i) parts.rest[i] -= parts.peak * there[i];
  return parts;
}

/// The lights of all lit instances.
struct Lights {
  std::vector<glm::vec3> coefficients;
  std::uint32_t first_peak = 0;  // of the peaks, which follow where the light is taken in parts
  bool in_parts = false;
};

Lights lightsOf(const frame::GpuScene& scene, const TransferBuffers& transfer, const sh::ShRgb& light,
                const sh::ShRgb& all_bands, bool damping) {
  Lights lights;
  const float share = damping ? ringing(light) : 0.0f;
  lights.in_parts = share > 0.0f;
  if (!lights.in_parts) {
    addRotatedLights(light, scene, transfer, lights.coefficients);
    return lights;
  }
  const sh::LightParts parts = partsOf(all_bands, light, share);
  addRotatedLights(parts.rest, scene, transfer, lights.coefficients);
  lights.first_peak = static_cast<std::uint32_t>(lights.coefficients.size());
  addRotatedLights(sh::colored(sh::directionalLight(light.order, parts.direction), parts.peak), scene,
                   transfer, lights.coefficients);
  return lights;
}

void lightOnDevice(gpu::FrameGraph& graph, const TransferBuffers& transfer, const Lights& lights,
                   gpu::BufferRef output) {
  const gpu::BufferRef light_buffer = graph.upload("prt.lights", lights.coefficients);
  const gpu::Limits& limits = graph.device().limits();
  for (const TransferChunk& chunk : transfer.chunks()) {
    const std::uint32_t groups = (chunk.block_count + kBlocksTogether - 1) / kBlocksTogether;
    const std::uint32_t columns = std::min(groups, limits.max_group_count[0]);
    const std::uint32_t rows = (groups + columns - 1) / columns;
    graph.compute("prt.vertices", prt_vertices_spv)
        .specialize("coefficients", transfer.order() * transfer.order())
        .specialize("has_indirect", transfer.hasIndirect())
        .specialize("half_float", transfer.options().half_float)
        .specialize("in_parts", lights.in_parts)
        .read("blocks", chunk.blocks)
        .read("transfer_direct", chunk.direct)
        .read("transfer_indirect", chunk.indirect)
        .read("lights", light_buffer)
        .write("vertex_light", output)
        .push(VerticesParams{.block_count = chunk.block_count, .first_peak = lights.first_peak})
        .dispatch(columns, rows);
  }
}

void lightOnHost(gpu::FrameGraph& graph, const TransferBuffers& transfer, Lights lights,
                 gpu::BufferRef output) {
  auto& pass = graph.host("prt.vertices");
  // Transfer was uploaded long before, and no pass writes it.
  pass.write(output);
  pass.run([&transfer, lights = std::move(lights), output](gpu::HostAccess& access) {
    const auto words = [](const gpu::Buffer& buffer) {
      return reinterpret_cast<const std::uint32_t*>(buffer.mapped());
    };
    for (const TransferChunk& chunk : transfer.chunks())
      relight({.direct = words(chunk.direct),
               .indirect = transfer.hasIndirect() ? words(chunk.indirect) : nullptr,
               .blocks = {reinterpret_cast<const VertexBlock*>(chunk.blocks.mapped()), chunk.block_count},
               .coefficients = transfer.order() * transfer.order(),
               .half_float = transfer.options().half_float},
              lights.coefficients, lights.first_peak, lights.in_parts, access.map<VertexLight>(output));
  });
}

}  // namespace

gpu::BufferRef lightVertices(gpu::FrameGraph& graph, const frame::GpuScene& scene,
                             const TransferBuffers& transfer, const sh::ShRgb& light,
                             const sh::ShRgb& all_bands, bool damping) {
  Lights lights = lightsOf(scene, transfer, light, all_bands, damping);
  const bool on_host = transfer.options().on_host;
  const auto output = graph.create(
      "prt.vertex_light",
      gpu::BufferDesc{.bytes = transfer.outputVertices() * sizeof(VertexLight), .host_visible = on_host});
  if (on_host)
    lightOnHost(graph, transfer, std::move(lights), output);
  else
    lightOnDevice(graph, transfer, lights, output);
  return output;
}

}  // namespace gloam::prt
