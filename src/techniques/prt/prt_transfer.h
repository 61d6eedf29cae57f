// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked transfer on the device, and which vertices or texels of which instances it lights.
#pragma once

#include "frame/frame_inputs.h"
#include "techniques/prt/prt_packer.h"

namespace gloam::prt {

struct TransferOptions {
  int order = 0;  ///< bands to keep; 0: as many as are baked
  bool half_float = false;
  bool on_host = false;         ///< the host reads it, too: buffers are mapped
  std::size_t chunk_bytes = 0;  ///< largest buffer of transfer; 0: what the device takes
  bool operator==(const TransferOptions&) const = default;
};

class TransferBuffers {
 public:
  /// Of all rigid instances whose meshes carry transfer. Throws Error where there is none, where a mesh's
  /// transfer has the wrong size, or where buffers exceed the device's.
  TransferBuffers(gpu::Device& device, const frame::GpuScene& scene, const TransferOptions& options);

  const TransferOptions& options() const { return options_; }
  int order() const { return order_; }
  bool hasIndirect() const { return has_indirect_; }
  const std::vector<TransferChunk>& chunks() const { return chunks_; }
  /// Instances that are lit by transfer, in the order of their rotated lights; order^2 coefficients each.
  const std::vector<std::uint32_t>& litInstances() const { return lit_; }
  /// Vertices and texels that all chunks write (VertexLight).
  std::size_t outputVertices() const { return output_vertices_; }
  /// By instance: OutputRow.
  const gpu::Buffer& outputRows() const { return output_rows_; }
  /// Names of meshes that stand in the scene without usable transfer.
  const std::vector<std::string>& unbakedMeshes() const { return unbaked_; }

 private:
  void findLit(const frame::GpuScene& scene);
  void fillChunks(gpu::Device& device, const frame::GpuScene& scene);

  TransferOptions options_;
  int order_ = 0;
  bool has_indirect_ = false;
  std::vector<TransferChunk> chunks_;
  std::vector<std::uint32_t> lit_;
  std::size_t output_vertices_ = 0;
  gpu::Buffer output_rows_;
  std::vector<std::string> unbaked_;
};

}  // namespace gloam::prt
