// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4.2, equation 13: a vertex turns the light into transferred radiance by its matrix; the
// radiance is convolved with the Phong-like kernel and taken at the mirror direction R. Differs from the paper: convolution
// and R a pixel, about the shading normal, so that normal maps and maps of roughness act; GS and GI - GS stay apart.
#include "techniques/prt/prt_glossy.h"

#include <algorithm>

#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_relight_kernel.h"

namespace gloam::prt {

namespace {

std::size_t fieldBytes(const GlossyBuffers& glossy) {
  return glossy.outputVertices() * glossy.fieldWords() * 4;
}

gpu::BufferRef fieldsOnDevice(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                              const GlossyBuffers& glossy, const std::vector<glm::vec3>& rows_of_light,
                              const LocalGloss* local) {
  const gpu::BufferRef lights = graph.upload("prt.gloss_lights", rows_of_light);
  const auto fields = graph.create("prt.gloss_fields", gpu::BufferDesc{.bytes = fieldBytes(glossy)});
  const gpu::Limits& limits = graph.device().limits();
  for (const TransferChunk& chunk : glossy.chunks()) {
    const std::uint32_t columns = std::min(chunk.block_count, limits.max_group_count[0]);
    const std::uint32_t rows = (chunk.block_count + columns - 1) / columns;
    auto& pass = local ? graph.compute("prt.local_gloss", prt_local_gloss_spv)
                       : graph.compute("prt.gloss_vertices", prt_gloss_vertices_spv);
    pass.specialize("light_order", glossy.lightOrder())
        .specialize("field_order", glossy.fieldOrder())
        .specialize("has_indirect", glossy.hasIndirect())
        .specialize("half_float", glossy.options().half_float)
        .specialize("cheap", glossy.options().cheap)
        .read("blocks", chunk.blocks)
        .read("transfer_direct", chunk.direct)
        .read("transfer_indirect", chunk.indirect)
        .read("lights", lights)
        .write("fields", fields);
    if (local) {
      pass.specialize("points", local->points)
          .specialize("probe_coefficients", local->order * local->order)
          .specialize("lamps_direct", local->lamps)
          .read("probe_lights", local->lights)
          .read("lamp_lights", local->lamp_lights)
          .read("probe_places", local->places)
          .read("trust", local->trust)
          .read("positions", inputs.scene.positions())
          .read("rows", local->rows)
          .push(glm::uvec2(chunk.block_count, static_cast<std::uint32_t>(glossy.lightRowSize())));
    } else {
      pass.push(chunk.block_count);
    }
    pass.dispatch(columns, rows);
  }
  return fields;
}

/// The light's rows tell all that the field depends on.
gpu::BufferRef fieldsOnHost(gpu::FrameGraph& graph, const GlossyBuffers& glossy, std::vector<glm::vec3> light,
                            GlossFields& kept) {
  if (!kept.buffer)
    kept.buffer = gpu::Buffer(graph.device(), "prt.gloss_fields",
                              gpu::BufferDesc{.bytes = fieldBytes(glossy), .host_visible = true});
  const gpu::BufferRef fields = graph.import("prt.gloss_fields", kept.buffer);
  if (kept.light == light) return fields;
  auto& pass = graph.host("prt.gloss_vertices");
  pass.write(fields);
  pass.run([&glossy, &kept, light = std::move(light), fields](gpu::HostAccess& access) {
    const auto words = [](const gpu::Buffer& buffer) {
      return reinterpret_cast<const std::uint32_t*>(buffer.mapped());
    };
    for (const TransferChunk& chunk : glossy.chunks())
      relightGloss(
          {.direct = words(chunk.direct),
           .indirect = glossy.hasIndirect() ? words(chunk.indirect) : nullptr,
           .blocks = {reinterpret_cast<const VertexBlock*>(chunk.blocks.mapped()), chunk.block_count},
           .light_order = glossy.lightOrder(),
           .field_order = glossy.fieldOrder(),
           .cheap = glossy.options().cheap,
           .half_float = glossy.options().half_float},
          light, access.map<std::uint32_t>(fields).data());
    kept.light = light;
  });
  return fields;
}

}  // namespace

std::vector<frame::Gloss> recordGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                      const GlossyBuffers& glossy, const sh::ShRgb& light, bool damped,
                                      bool indirect, GlossFields& kept, const LocalGloss* local) {
  // Radiance is kept in halves: at an exposure that brings the light's greatest coefficient to 1.
  std::vector<glm::vec3> light_rows;
  float greatest = 0.0f;
  for (const glm::vec3& c : light.coefficients())  // what probes will see is not known here
    greatest = std::max({greatest, std::abs(c.r), std::abs(c.g), std::abs(c.b)});
  if (local) greatest = 1.0f;
  sh::ShRgb exposed = light;
  if (greatest > 0.0f) exposed *= glm::vec3(1.0f / greatest);
  light_rows = glossy.lightRows(exposed, inputs.scene);

  const gpu::BufferRef fields = glossy.options().on_host && !local
                                    ? fieldsOnHost(graph, glossy, std::move(light_rows), kept)
                                    : fieldsOnDevice(graph, inputs, glossy, light_rows, local);
  const gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                            .width = inputs.gbuffer.width,
                            .height = inputs.gbuffer.height};
  const auto direct = graph.create("prt.gloss_direct", desc);
  const auto further = graph.create("prt.gloss_indirect", desc);
  auto& pixels = graph.compute("prt.gloss_pixels", prt_gloss_pixels_spv)
                     .specialize("field_order", glossy.fieldOrder())
                     .specialize("has_indirect", glossy.hasIndirect())
                     .specialize("damped", damped)
                     .read("frame_view", inputs.view)
                     .read("ids", inputs.gbuffer.ids)
                     .read("normals", inputs.gbuffer.normals)
                     .read("diffuse", inputs.gbuffer.diffuse)
                     .read("specular", inputs.gbuffer.specular)
                     .sample("gloss", inputs.environment.gloss())
                     .read("gloss_rows", graph.upload("prt.gloss_rows", glossy.instanceRows(inputs.scene)))
                     .read("fields", fields)
                     .write("direct", direct)
                     .write("indirect", further)
                     .push(greatest);
  inputs.scene.bindTriangles(pixels).dispatchOver(direct);
  std::vector<frame::Gloss> terms = {{direct, frame::Path::kDirect}};
  if (glossy.hasIndirect() && indirect) terms.push_back({further, frame::Path::kIndirect});
  return terms;
}

}  // namespace gloam::prt
