// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 7: L_p = M_p L at every grid point once a frame, then each receiver looks up the radiance
// around it: vertices of baked objects apply their own transfer to it, M_DS . L_p, others their lobes. Differs from the paper:
// what is left of the light counts as a factor, so that shadows of several objects multiply; thrown light adds.
#include "techniques/prt/prt_neighbourhood.h"

#include <algorithm>

#include "math/sh_high_order.h"
#include "scene/transforms.h"
#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_relight_kernel.h"

namespace gloam::prt {

NeighbourhoodPasses::NeighbourhoodPasses(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                         const NeighbourhoodBuffers& buffers, const TransferBuffers& transfer,
                                         const sh::ShRgb& light, bool damped)
    : graph_(graph), inputs_(inputs), buffers_(buffers), light_(buffers.fieldOrder()), damped_(damped) {
  // Radiance is kept in halves: at an exposure that brings the light's greatest coefficient to 1.
  float greatest = 0.0f;
  for (const glm::vec3& c : light.coefficients())
    greatest = std::max({greatest, std::abs(c.r), std::abs(c.g), std::abs(c.b)});
  if (greatest > 0.0f) exposure_ = greatest;
  for (int i = 0; i < std::min(light.size(), light_.size()); ++i)
    light_.c[std::size_t(i)] = light.c[std::size_t(i)] / exposure_;
  std::uint32_t words = 0;
  for (const NeighbourhoodBuffers::Grid& grid : buffers.grids()) {
    first_words_.push_back(words);
    words += grid.points * buffers.wordsOfPoint();
  }
  fields_ = graph.create("prt.neighbourhood_fields",
                         gpu::BufferDesc{.bytes = std::size_t(words) * 4, .host_visible = buffers.onHost()});
  for (std::size_t c = 0; c < buffers.grids().size(); ++c) multiply(c, light_);
  for (std::size_t c = 0; c < buffers.grids().size(); ++c) addReader(c, glm::mat4(1.0f));
  findReaders(transfer);
  turn();
}

void NeighbourhoodPasses::multiply(std::size_t carrier, const sh::ShRgb& light) {
  const frame::Carrier& c = inputs_.scene.carriers().shown()[carrier];
  const NeighbourhoodBuffers::Grid& grid = buffers_.grids()[carrier];
  const sh::ShRgb turned = sh::truncated(sh::rotate(glm::transpose(rotationFactor(c.world_from_node)), light),
                                         buffers_.lightOrder());
  std::vector<glm::vec3> lights(turned.coefficients().begin(), turned.coefficients().end());
  const int bands = buffers_.visibilityOrder();
  const std::vector<glm::vec3> product = sh::Tripling::of(buffers_.lightOrder(), buffers_.fieldOrder())
                                             .lightMatrix(turned.coefficients(), bands * bands);
  lights.insert(lights.end(), product.begin(), product.end());
  if (buffers_.onHost()) return multiplyOnHost(carrier, std::move(lights));
  const gpu::BufferRef light_rows =
      graph_.upload("prt.neighbourhood_lights_" + std::to_string(carrier), lights);
  for (const NeighbourhoodBuffers::Rows& rows : grid.thrown) {
    graph_.compute("prt.neighbourhood_points", prt_neighbourhood_points_spv)
        .specialize("light_order", buffers_.lightOrder())
        .specialize("field_order", buffers_.fieldOrder())
        .specialize("has_indirect", buffers_.hasThrown())
        .read("visibility", grid.visibility)
        .read("thrown", rows.words)
        .read("lights", light_rows)
        .write("fields", fields_)
        .push(NeighbourhoodPoints{grid.points, first_words_[carrier], rows.first_row})
        .dispatch((grid.points + 63) / 64, rows.row_count);
  }
}

void NeighbourhoodPasses::multiplyOnHost(std::size_t carrier, std::vector<glm::vec3> lights) {
  auto& pass = graph_.host("prt.neighbourhood_points");
  pass.write(fields_);
  pass.run([&buffers = buffers_, carrier, lights = std::move(lights), fields = fields_,
            first_word = first_words_[carrier]](gpu::HostAccess& access) {
    const NeighbourhoodBuffers::Grid& grid = buffers.grids()[carrier];
    for (const NeighbourhoodBuffers::Rows& rows : grid.thrown)
      multiplyGrid(
          {.visibility = reinterpret_cast<const float*>(grid.visibility.mapped()),
           .thrown =
               buffers.hasThrown() ? reinterpret_cast<const std::uint32_t*>(rows.words.mapped()) : nullptr,
           .points = grid.points,
           .first_row = rows.first_row,
           .row_count = rows.row_count,
           .light_order = buffers.lightOrder(),
           .field_order = buffers.fieldOrder()},
          lights, access.map<std::uint32_t>(fields).data() + first_word);
  });
}

void NeighbourhoodPasses::lightVertices(const TransferBuffers& transfer, gpu::BufferRef vertex_light) {
  if (readers_.empty()) return;
  const gpu::BufferRef lights = graph_.upload("prt.neighbourhood_reader_lights", reader_lights_);
  const gpu::BufferRef readers = graph_.upload("prt.neighbourhood_readers", readers_);
  const gpu::BufferRef grids = graph_.upload("prt.neighbourhood_reader_grids", grids_);
  const gpu::Limits& limits = graph_.device().limits();
  for (const TransferChunk& chunk : transfer.chunks()) {
    const std::uint32_t columns = std::min(chunk.block_count, limits.max_group_count[0]);
    graph_.compute("prt.neighbourhood_vertices", prt_neighbourhood_vertices_spv)
        .specialize("coefficients", transfer.order() * transfer.order())
        .specialize("has_indirect", transfer.hasIndirect())
        .specialize("half_float", transfer.options().half_float)
        .specialize("field_order", buffers_.fieldOrder())
        .specialize("has_thrown", buffers_.hasThrown())
        .specialize("damped", damped_)
        .read("radiance", radiance_)
        .read("blocks", chunk.blocks)
        .read("transfer_direct", chunk.direct)
        .read("transfer_indirect", chunk.indirect)
        .read("lights", lights)
        .read("readers", readers)
        .read("grids", grids)
        .read("positions", inputs_.scene.positions())
        .readWrite("vertex_light", vertex_light)
        .push(NeighbourhoodVertices{chunk.block_count, std::uint32_t(readers_.size()), exposure_})
        .dispatch(columns, (chunk.block_count + columns - 1) / columns);
  }
}

void NeighbourhoodPasses::lightPixels(frame::Lighting& lighting, bool indirect) {
  const frame::GpuScene& scene = inputs_.scene;
  std::vector<glm::uvec2> owners;
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    const frame::GpuMesh& mesh = scene.meshes()[scene.instances()[i].mesh];
    const bool by_vertices = mesh.transfer && !mesh.transfer->ofTexels() && !scene.deformed(i);
    owners.emplace_back(scene.carriers().ofInstances()[i], by_vertices ? 1u : 0u);
  }
  const auto termOf = [](const auto& terms, frame::Path path) {
    gpu::ImageRef image;
    for (const auto& term : terms)
      if (term.path == path && !image) image = term.image;
    return image;
  };
  const gpu::ImageRef direct_in = termOf(lighting.irradiance, frame::Path::kDirect);
  const gpu::ImageRef indirect_in = termOf(lighting.irradiance, frame::Path::kIndirect);
  const gpu::ImageRef gloss_in = termOf(lighting.gloss, frame::Path::kDirect);
  const gpu::ImageRef gloss_indirect_in = termOf(lighting.gloss, frame::Path::kIndirect);
  const gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                            .width = inputs_.gbuffer.width,
                            .height = inputs_.gbuffer.height};
  const auto direct = graph_.create("prt.neighbourhood_direct", desc);
  const auto further = graph_.create("prt.neighbourhood_indirect", desc);
  const auto gloss_direct = graph_.create("prt.neighbourhood_gloss_direct", desc);
  const auto gloss_further = graph_.create("prt.neighbourhood_gloss_indirect", desc);
  const auto carriers = std::uint32_t(buffers_.grids().size());
  const std::span<const glm::vec3> light = light_.coefficients();
  const std::vector<glm::vec3> light_row(light.begin(), light.end());
  graph_.compute("prt.neighbourhood_pixels", prt_neighbourhood_pixels_spv)
      .specialize("field_order", buffers_.fieldOrder())
      .specialize("has_thrown", buffers_.hasThrown())
      .specialize("has_indirect_in", bool(indirect_in))
      .specialize("has_gloss_in", bool(gloss_in))
      .specialize("has_gloss_indirect_in", bool(gloss_indirect_in))
      .specialize("damped", damped_)
      .read("radiance", radiance_)
      .read("frame_view", inputs_.view)
      .read("ids", inputs_.gbuffer.ids)
      .read("normals", inputs_.gbuffer.normals)
      .read("depth", inputs_.gbuffer.depth)
      .read("diffuse", inputs_.gbuffer.diffuse)
      .read("specular", inputs_.gbuffer.specular)
      .sample("gloss", inputs_.environment.gloss())
      .read("owners", graph_.upload("prt.neighbourhood_owners", owners))
      .read("grids", graph_.upload("prt.neighbourhood_grids",
                                   std::span<const NeighbourhoodGrid>(grids_).first(carriers)))
      .read("light", graph_.upload("prt.neighbourhood_light", light_row))
      .read("direct_in", direct_in)
      .read("indirect_in", indirect_in ? indirect_in : direct_in)
      .read("gloss_in", gloss_in ? gloss_in : direct_in)
      .read("gloss_indirect_in", gloss_indirect_in ? gloss_indirect_in : direct_in)
      .write("direct", direct)
      .write("indirect", further)
      .write("gloss_direct", gloss_direct)
      .write("gloss_indirect", gloss_further)
      .push(NeighbourhoodPixels{carriers, exposure_})
      .dispatchOver(direct);
  lighting.irradiance = {{.image = direct, .path = frame::Path::kDirect}};
  lighting.gloss = {{gloss_direct, frame::Path::kDirect}};
  lighting.has_environment_gloss = true;
  const bool thrown = indirect && buffers_.hasThrown();
  if (thrown || indirect_in)
    lighting.irradiance.push_back({.image = further, .path = frame::Path::kIndirect});
  if (thrown || gloss_indirect_in) lighting.gloss.push_back({gloss_further, frame::Path::kIndirect});
}

}  // namespace gloam::prt
