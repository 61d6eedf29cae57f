// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_transfer.h"

#include <fmt/format.h>

#include <algorithm>

namespace gloam::prt {

namespace {

/// Vertices, or texels.
std::uint32_t pointCount(const frame::GpuMesh& mesh) {
  const Transfer& transfer = *mesh.transfer;
  return transfer.ofTexels() ? std::uint32_t(transfer.texel_width) * std::uint32_t(transfer.texel_height)
                             : mesh.vertex_count;
}

void checkSizes(const frame::GpuMesh& mesh) {
  const Transfer& transfer = *mesh.transfer;
  const std::string place = "mesh '" + mesh.name + "'";
  if (transfer.order < 1 || transfer.order > sh::kMaxOrder)
    throw Error(place, fmt::format("transfer of order {}; 1 to {} are known", transfer.order, sh::kMaxOrder));
  const std::size_t expected =
      std::size_t(pointCount(mesh)) * std::size_t(transfer.order) * std::size_t(transfer.order);
  if (transfer.ofTexels() && mesh.first_lightmap_uv == frame::kAbsent)
    throw Error(place, fmt::format("transfer of texels, but no texture coordinates {}", transfer.uv_set));
  if (transfer.direct.size() != expected ||
      (!transfer.indirect.empty() && transfer.indirect.size() != 3 * expected))
    throw Error(
        place, fmt::format("transfer of order {} for {} {} needs {} values, or three times that for bounces; "
                           "it has {} and {}",
                           transfer.order, pointCount(mesh), transfer.ofTexels() ? "texels" : "vertices",
                           expected, transfer.direct.size(), transfer.indirect.size()));
}

}  // namespace

TransferBuffers::TransferBuffers(gpu::Device& device, const frame::GpuScene& scene,
                                 const TransferOptions& options)
    : options_(options) {
  findLit(scene);
  if (lit_.empty())
    throw Error(
        "technique prt",
        "no rigid mesh of this scene carries baked transfer; `gloam bake SCENE -o BAKED.glb` makes it");
  fillChunks(device, scene);
}

void TransferBuffers::findLit(const frame::GpuScene& scene) {
  order_ = options_.order > 0 ? options_.order : sh::kMaxOrder;
  for (std::uint32_t i = 0; i < scene.instances().size(); ++i) {
    const frame::GpuMesh& mesh = scene.meshes()[scene.instances()[i].mesh];
    if (!mesh.transfer || scene.deformed(i)) {
      if (std::find(unbaked_.begin(), unbaked_.end(), mesh.name) == unbaked_.end())
        unbaked_.push_back(mesh.name);
      continue;
    }
    checkSizes(mesh);
    order_ = std::min(order_, mesh.transfer->order);
    has_indirect_ = has_indirect_ || !mesh.transfer->indirect.empty();
    lit_.push_back(i);
  }
}

void TransferBuffers::fillChunks(gpu::Device& device, const frame::GpuScene& scene) {
  const std::size_t kept = std::size_t(order_) * std::size_t(order_);
  const bool half = options_.half_float;
  Packer packer(device, "prt.transfer", wordCount(kept, half), has_indirect_ ? wordCount(3 * kept, half) : 0,
                options_.chunk_bytes, options_.on_host);
  std::vector<OutputRow> rows(scene.instances().size(), OutputRow{kUnbaked, 0, 0, 0});
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    const std::uint32_t mesh_index = scene.instances()[lit_[i]].mesh;
    const auto light = static_cast<std::uint32_t>(i * std::size_t(order_) * std::size_t(order_));
    const auto output = static_cast<std::uint32_t>(output_vertices_);
    const frame::GpuMesh& mesh = scene.meshes()[mesh_index];
    const Transfer& transfer = *mesh.transfer;
    rows[lit_[i]] = {output, std::uint32_t(transfer.texel_width), std::uint32_t(transfer.texel_height),
                     mesh.first_lightmap_uv};
    const std::size_t stored = std::size_t(transfer.order) * std::size_t(transfer.order);
    const std::vector<float> none(transfer.indirect.empty() ? 3 * kept : 0, 0.0f);
    const auto fill = [&](std::uint32_t v, std::uint32_t* direct, std::uint32_t* indirect) {
      packWords({&transfer.direct[v * stored], kept}, half, direct);
      if (has_indirect_)
        packWords({none.empty() ? &transfer.indirect[v * 3 * stored] : none.data(), 3 * kept}, half,
                  indirect);
    };
    for (const Packer::Part& part : packer.partsOf(mesh_index, pointCount(mesh), fill))
      packer.addBlocks(part, light, output);
    output_vertices_ += pointCount(mesh);
  }
  chunks_ = packer.finish();
  output_rows_ = gpu::Buffer(device, "prt.output_rows", rows);
}

}  // namespace gloam::prt
