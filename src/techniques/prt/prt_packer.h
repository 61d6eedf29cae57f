// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked numbers of meshes' vertices, laid out for work groups and cut into buffers that a device takes.
#pragma once

#include <functional>
#include <map>
#include <span>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "techniques/prt/prt_shared.h"

namespace gloam::prt {

/// Transfer of some vertices: as many as fit into one storage buffer. Word w of vertex v of block b stands at
/// (b * words + w) * kBlockVertices + v. A word is a float, or two halves, the first in its low bits.
struct TransferChunk {
  gpu::Buffer direct, indirect;  ///< either may be empty
  gpu::Buffer blocks;            ///< VertexBlock, one a work group
  std::uint32_t block_count = 0;
};

/// As large as `values`, and filled with them. `mapped`: the host reads it, too.
template <class T>
gpu::Buffer filledBuffer(gpu::Device& device, std::string name, const std::vector<T>& values, bool mapped) {
  gpu::Buffer buffer(device, std::move(name),
                     gpu::BufferDesc{.bytes = values.size() * sizeof(T), .host_visible = mapped});
  buffer.upload(values);
  return buffer;
}

/// 32-bit words that so many values take.
constexpr std::size_t wordCount(std::size_t values, bool half_float) {
  return half_float ? (values + 1) / 2 : values;
}
void packWords(std::span<const float> values, bool half_float, std::uint32_t* words);

/// Puts meshes end to end into chunks, each mesh once, cut where a chunk is full.
class Packer {
 public:
  /// Vertices of a mesh in one chunk.
  struct Part {
    std::size_t chunk;
    std::uint32_t first_block, first_vertex, vertices;
  };
  /// Writes the words of one vertex.
  using Fill = std::function<void(std::uint32_t vertex, std::uint32_t* direct, std::uint32_t* indirect)>;

  /// Buffers are called `name`_direct and so on; `chunk_bytes` 0: what the device takes. `host_visible`: they are mapped.
  Packer(gpu::Device& device, std::string name, std::size_t direct_words, std::size_t indirect_words,
         std::size_t chunk_bytes, bool host_visible = false);
  const std::vector<Part>& partsOf(std::uint32_t mesh, std::uint32_t vertices, const Fill& fill);
  /// One instance's share: `light` and `output` as in VertexBlock.
  void addBlocks(const Part& part, std::uint32_t light, std::uint32_t output);
  std::vector<TransferChunk> finish();

 private:
  void append(const Fill& fill, std::uint32_t first, std::uint32_t count);
  void uploadValues();

  gpu::Device& device_;
  std::string name_;
  std::size_t direct_words_, indirect_words_;
  bool host_visible_;
  std::uint32_t limit_ = 0, used_ = 0;            // blocks of a chunk, and of the last one
  std::vector<std::uint32_t> direct_, indirect_;  // of the last chunk
  std::vector<TransferChunk> chunks_;
  std::vector<std::vector<VertexBlock>> blocks_;
  std::map<std::uint32_t, std::vector<Part>> parts_;
};

}  // namespace gloam::prt
