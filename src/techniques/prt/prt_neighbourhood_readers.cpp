// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 7: who reads a grid, the world and every baked object that stands in it, and its radiance
// turned to their axes, band by band.
#include "math/sh_high_order.h"
#include "scene/transforms.h"
#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_neighbourhood.h"
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

}  // namespace gloam::prt
