// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "gpu/format.h"

namespace gloam::prt {

namespace {

std::uint32_t blockCount(std::uint32_t vertices) {
  return (vertices + kBlockVertices - 1) / kBlockVertices;
}

/// One vertex after another becomes blocks of kBlockVertices, coefficient after coefficient; the last block
/// is padded with 0. `kept` of `stored` values a vertex are taken.
void appendBlocks(std::vector<float>& to, const std::vector<float>& from, std::uint32_t first_vertex,
                  std::uint32_t vertices, std::size_t stored, std::size_t kept) {
  const std::size_t start = to.size();
  to.resize(start + std::size_t(blockCount(vertices)) * kept * kBlockVertices, 0.0f);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::size_t block = v / kBlockVertices, lane = v % kBlockVertices;
    for (std::size_t i = 0; i < kept; ++i) {
      to[start + (block * kept + i) * kBlockVertices + lane] =
          from[(std::size_t(first_vertex) + v) * stored + i];
    }
  }
}

gpu::Buffer uploaded(gpu::Device& device, const std::string& name, const std::vector<float>& values,
                     bool half_float) {
  if (!half_float) return gpu::Buffer(device, name, values);
  std::vector<std::uint16_t> halves(values.size());
  std::transform(values.begin(), values.end(), halves.begin(), gpu::halfFromFloat);
  return gpu::Buffer(device, name, halves);
}

void checkSizes(const frame::GpuMesh& mesh) {
  const Transfer& transfer = *mesh.transfer;
  const std::string place = "mesh '" + mesh.name + "'";
  if (transfer.order < 1 || transfer.order > sh::kMaxOrder)
    throw Error(place, fmt::format("transfer of order {}; 1 to {} are known", transfer.order, sh::kMaxOrder));
  const std::size_t expected =
      std::size_t(mesh.vertex_count) * std::size_t(transfer.order) * std::size_t(transfer.order);
  if (transfer.direct.size() != expected ||
      (!transfer.indirect.empty() && transfer.indirect.size() != 3 * expected))
    throw Error(
        place,
        fmt::format("transfer of order {} for {} vertices needs {} values, or three times that for bounces; "
                    "it has {} and {}",
                    transfer.order, mesh.vertex_count, expected, transfer.direct.size(),
                    transfer.indirect.size()));
}

/// Vertices of a mesh in one chunk.
struct Part {
  std::size_t chunk;
  std::uint32_t first_block, first_vertex, vertices;
};

/// Puts meshes end to end into chunks, each mesh once, cut where a chunk is full.
class Packer {
 public:
  Packer(gpu::Device& device, int order, bool has_indirect, const TransferOptions& options)
      : device_(device),
        kept_(std::size_t(order) * std::size_t(order)),
        has_indirect_(has_indirect),
        half_(options.half_float) {
    const std::size_t block_bytes = kept_ * (has_indirect ? 3 : 1) * kBlockVertices * (half_ ? 2 : 4);
    const std::uint64_t bytes =
        options.chunk_bytes > 0 ? options.chunk_bytes : device.limits().max_storage_bytes;
    limit_ = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(bytes / block_bytes, 1, 1u << 24));
    chunks_.emplace_back();
    blocks_.emplace_back();
  }

  const std::vector<Part>& partsOf(std::uint32_t mesh_index, const frame::GpuMesh& mesh) {
    const auto [place, is_new] = parts_.try_emplace(mesh_index);
    for (std::uint32_t first = 0; is_new && first < mesh.vertex_count;) {
      if (used_ == limit_) startChunk();
      const std::uint32_t taken = std::min(mesh.vertex_count - first, (limit_ - used_) * kBlockVertices);
      place->second.push_back({chunks_.size() - 1, used_, first, taken});
      append(*mesh.transfer, first, taken);
      used_ += blockCount(taken);
      first += taken;
    }
    return place->second;
  }

  void addBlocks(const Part& part, std::uint32_t light, std::uint32_t output) {
    for (std::uint32_t b = 0; b < blockCount(part.vertices); ++b) {
      blocks_[part.chunk].push_back({part.first_block + b, light,
                                     output + part.first_vertex + b * kBlockVertices,
                                     std::min(part.vertices - b * kBlockVertices, kBlockVertices)});
    }
  }

  std::vector<TransferChunk> finish() {
    uploadValues();
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      chunks_[c].block_count = static_cast<std::uint32_t>(blocks_[c].size());
      chunks_[c].blocks = gpu::Buffer(device_, "prt.blocks", blocks_[c]);
    }
    return std::move(chunks_);
  }

 private:
  void append(const Transfer& transfer, std::uint32_t first, std::uint32_t count) {
    const std::size_t stored = std::size_t(transfer.order) * std::size_t(transfer.order);
    appendBlocks(direct_, transfer.direct, first, count, stored, kept_);
    if (!has_indirect_) return;
    if (transfer.indirect.empty()) {
      indirect_.resize(direct_.size() * 3, 0.0f);
    } else {
      appendBlocks(indirect_, transfer.indirect, first, count, 3 * stored, 3 * kept_);
    }
  }
  void uploadValues() {
    chunks_.back().direct = uploaded(device_, "prt.transfer_direct", direct_, half_);
    chunks_.back().indirect = uploaded(device_, "prt.transfer_indirect", indirect_, half_);
    direct_.clear();
    indirect_.clear();
  }
  void startChunk() {
    uploadValues();
    chunks_.emplace_back();
    blocks_.emplace_back();
    used_ = 0;
  }

  gpu::Device& device_;
  std::size_t kept_;
  bool has_indirect_, half_;
  std::uint32_t limit_ = 0, used_ = 0;
  std::vector<float> direct_, indirect_;  // of the last chunk
  std::vector<TransferChunk> chunks_;
  std::vector<std::vector<VertexBlock>> blocks_;
  std::map<std::uint32_t, std::vector<Part>> parts_;
};

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
  Packer packer(device, order_, has_indirect_, options_);
  std::vector<std::uint32_t> first_outputs(scene.instances().size(), kUnbaked);
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    const std::uint32_t mesh_index = scene.instances()[lit_[i]].mesh;
    const auto light = static_cast<std::uint32_t>(i * std::size_t(order_) * std::size_t(order_));
    const auto output = static_cast<std::uint32_t>(output_vertices_);
    first_outputs[lit_[i]] = output;
    for (const Part& part : packer.partsOf(mesh_index, scene.meshes()[mesh_index]))
      packer.addBlocks(part, light, output);
    output_vertices_ += scene.meshes()[mesh_index].vertex_count;
  }
  chunks_ = packer.finish();
  first_outputs_ = gpu::Buffer(device, "prt.first_outputs", first_outputs);
}

}  // namespace gloam::prt
