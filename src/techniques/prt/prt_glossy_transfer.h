// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked glossy transfer on the device (PRT-2).
#pragma once

#include "frame/frame_inputs.h"
#include "math/sh_high_order.h"
#include "techniques/prt/prt_packer.h"

namespace gloam::prt {

struct GlossyOptions {
  int order = 0;       ///< bands of light and radiance to keep; 0: as many as are baked
  bool cheap = false;  ///< V alone, to the bands of the radiance, instead of the matrix
  bool half_float = false;
  bool on_host = false;         ///< the host multiplies: buffers are mapped
  std::size_t chunk_bytes = 0;  ///< largest buffer of transfer; 0: what the device takes
  bool operator==(const GlossyOptions&) const = default;
};

/// `direct` of a chunk holds GS, packed (sh::PackedMatrix), or V; `indirect` GI - GS: [row i][column j][rgb], columns padded
/// to an even number. `direct` and `indirect` as words of prt_packer.h.
class GlossyBuffers {
 public:
  /// Of all rigid instances whose meshes carry glossy transfer; empty() where there is none. Throws Error where its size is
  /// wrong, or where buffers exceed the device's.
  GlossyBuffers(gpu::Device& device, const frame::GpuScene& scene, const GlossyOptions& options);

  bool empty() const { return lit_.empty(); }
  const GlossyOptions& options() const { return options_; }
  int lightOrder() const { return shape_.light_order; }
  int fieldOrder() const { return shape_.field_order; }
  bool hasIndirect() const { return has_indirect_; }
  const std::vector<TransferChunk>& chunks() const { return chunks_; }

  /// What the vertices of each lit instance are multiplied with, end to end: light (lightOrder^2), a factor a row of GS
  /// (fieldOrder^2; of a lobe that is baked in, else 1), and the light's matrix where V is kept. `light` is the world's.
  std::vector<glm::vec3> lightRows(const sh::ShRgb& light, const frame::GpuScene& scene) const;
  /// By instance: where its vertices' radiance begins, how it is turned, and its lobe.
  std::vector<GlossRow> instanceRows(const frame::GpuScene& scene) const;
  /// 32-bit words of a vertex's radiance, and vertices that all chunks write.
  std::size_t fieldWords() const;
  std::size_t outputVertices() const { return output_vertices_; }
  /// Values an instance takes of lightRows().
  std::size_t lightRowSize() const;

 private:
  void findLit(const frame::GpuScene& scene);
  void fillChunks(gpu::Device& device, const frame::GpuScene& scene);
  void packVertex(const GlossyTransfer& glossy, std::uint32_t vertex, std::uint32_t* direct,
                  std::uint32_t* indirect) const;

  GlossyOptions options_;
  sh::PackedMatrix shape_;
  bool has_indirect_ = false;
  std::vector<TransferChunk> chunks_;
  std::vector<std::uint32_t> lit_, first_outputs_;
  std::vector<float> exponents_;  ///< [lit]: baked in, or 0
  std::size_t output_vertices_ = 0;
};

}  // namespace gloam::prt
