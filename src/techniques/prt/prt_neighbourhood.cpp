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
namespace {

/// Numbers of a rotation, band by band, row after row.
std::vector<float> rotationBlocks(int order, const glm::mat3& matrix) {
  const sh::Rotation rotation = sh::makeRotation(order, matrix);
  std::vector<float> blocks;
  for (int l = 0; l < order; ++l) {
    const int first = l * l, width = 2 * l + 1;
    const std::size_t at = blocks.size();
    blocks.resize(at + std::size_t(width * width));
    for (int column = 0; column < width; ++column) {
      sh::Sh unit(order);
      unit.c[std::size_t(first + column)] = 1.0f;
      const sh::Sh turned = sh::rotate(rotation, unit);
      for (int row = 0; row < width; ++row)
        blocks[at + std::size_t(row * width + column)] = turned[first + row];
    }
  }
  return blocks;
}

/// To the carrier's coordinates, from the grid's centre on.
glm::mat4 wayFromWorld(const frame::Carrier& carrier) {
  glm::mat4 way_from_node(1.0f);
  way_from_node[3] = glm::vec4(-carrier.transfer->centre, 1.0f);
  return way_from_node * glm::inverse(carrier.world_from_node);
}

/// Whether a box touches the grid.
bool touches(const glm::mat4& way_from_place, const glm::vec3& low, const glm::vec3& high,
             const glm::vec3& half_size) {
  glm::vec3 least(std::numeric_limits<float>::max()), most(-least);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
    const glm::vec3 at(way_from_place * glm::vec4(p, 1.0f));
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  return glm::all(glm::greaterThan(most, -half_size)) && glm::all(glm::lessThan(least, half_size));
}

std::uint32_t pointsOf(const frame::GpuMesh& mesh) {
  const Transfer& transfer = *mesh.transfer;
  if (transfer.ofTexels()) return std::uint32_t(transfer.texel_width * transfer.texel_height);
  return mesh.vertex_count;
}

}  // namespace

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

/// A grid as someone reads it whose coordinates are `world_from_place`'s; its radiance will be turned to their axes.
std::uint32_t NeighbourhoodPasses::addReader(std::size_t carrier, const glm::mat4& world_from_place) {
  const frame::Carrier& c = inputs_.scene.carriers().shown()[carrier];
  const std::uint32_t points = buffers_.grids()[carrier].points;
  const NeighbourhoodTransfer& grid = *c.transfer;
  grids_.push_back({glm::mat4x3(wayFromWorld(c) * world_from_place), grid.spacing, grid.core, grid.growth,
                    grid.half(), glm::uvec3(grid.size), radiance_words_, std::uint32_t(carrier)});
  turns_.push_back({points, first_words_[carrier], radiance_words_, std::uint32_t(rotations_.size())});
  const glm::mat3 place_from_carrier =
      glm::transpose(rotationFactor(world_from_place)) * rotationFactor(c.world_from_node);
  const std::vector<float> blocks = rotationBlocks(buffers_.fieldOrder(), place_from_carrier);
  rotations_.insert(rotations_.end(), blocks.begin(), blocks.end());
  radiance_words_ += points * buffers_.wordsOfPoint();
  return std::uint32_t(grids_.size() - 1);
}

void NeighbourhoodPasses::findReaders(const TransferBuffers& transfer) {
  const frame::GpuScene& scene = inputs_.scene;
  const std::vector<frame::Carrier>& carriers = scene.carriers().shown();
  std::uint32_t first_output = 0;
  for (const std::uint32_t i : transfer.litInstances()) {
    const frame::InstanceRow& row = scene.instances()[i];
    const frame::GpuMesh& mesh = scene.meshes()[row.mesh];
    const std::uint32_t output = first_output;
    first_output += pointsOf(mesh);
    if (mesh.transfer->ofTexels()) continue;  // pixel by pixel, as what is not baked
    const glm::mat4 world_from_object(row.world_from_object);
    NeighbourhoodReader reader{output,
                               mesh.vertex_count,
                               row.first_vertex,
                               std::uint32_t(reader_lights_.size()),
                               std::uint32_t(grids_.size()),
                               0};
    for (std::size_t c = 0; c < carriers.size(); ++c) {
      if (scene.carriers().ofInstances()[i] == c) continue;
      if (!touches(wayFromWorld(carriers[c]) * world_from_object, mesh.bounds_min, mesh.bounds_max,
                   carriers[c].transfer->half()))
        continue;
      addReader(c, world_from_object);
      ++reader.grid_count;
    }
    if (reader.grid_count == 0) continue;
    const sh::ShRgb turned = sh::rotate(glm::transpose(rotationFactor(world_from_object)), light_);
    reader_lights_.insert(reader_lights_.end(), turned.coefficients().begin(), turned.coefficients().end());
    readers_.push_back(reader);
  }
}

void NeighbourhoodPasses::turn() {
  const std::size_t bytes = std::size_t(radiance_words_) * 4;
  if (bytes > graph_.device().limits().max_storage_bytes)
    throw Error("technique prt", "the neighbourhoods that objects stand in take " +
                                     std::to_string(bytes >> 20) +
                                     " MiB; a buffer of this device holds less: bake fewer points");
  radiance_ = graph_.create("prt.neighbourhood_radiance",
                            gpu::BufferDesc{.bytes = bytes, .host_visible = buffers_.onHost()});
  if (buffers_.onHost()) return turnOnHost();
  const gpu::BufferRef rotations = graph_.upload("prt.neighbourhood_rotations", rotations_);
  for (const NeighbourhoodTurn& params : turns_) {
    graph_.compute("prt.neighbourhood_turn", prt_neighbourhood_turn_spv)
        .specialize("field_order", buffers_.fieldOrder())
        .specialize("has_indirect", buffers_.hasThrown())
        .read("fields", fields_)
        .read("rotations", rotations)
        .write("radiance", radiance_)
        .push(params)
        .dispatch((params.points + 63) / 64, std::uint32_t(buffers_.fieldOrder() * buffers_.fieldOrder()));
  }
}

void NeighbourhoodPasses::turnOnHost() {
  auto& pass = graph_.host("prt.neighbourhood_turn");
  pass.read(fields_).write(radiance_);
  pass.run([turns = turns_, rotations = rotations_, &buffers = buffers_, fields = fields_,
            radiance = radiance_](gpu::HostAccess& access) {
    for (const NeighbourhoodTurn& turn : turns)
      turnGrid({.fields = access.map<std::uint32_t>(fields).data() + turn.first_in,
                .rotation = rotations.data() + turn.first_rotation,
                .radiance = access.map<std::uint32_t>(radiance).data() + turn.first_out,
                .points = turn.points,
                .words_of_row = buffers.hasThrown() ? 3u : 2u,
                .field_order = buffers.fieldOrder()});
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
