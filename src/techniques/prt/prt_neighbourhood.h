// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of neighbourhood transfer (PRT-6): grids of matrices on the device, and what they leave of the light and throw on
// what stands in them.
#pragma once

#include <gloam/neighbourhood.h>

#include "frame/frame_inputs.h"
#include "techniques/prt/prt_neighbourhood_shared.h"
#include "techniques/prt/prt_transfer.h"

namespace gloam::prt {

/// The grids of all carriers that are shown, in their order.
class NeighbourhoodBuffers {
 public:
  /// `order`: most bands that are kept; 0: all. Throws Error where a grid's numbers do not fit its size, or a buffer exceeds
  /// the device's. `on_host`: the host multiplies them with the light.
  NeighbourhoodBuffers(gpu::Device& device, const frame::GpuScene& scene, int order, bool on_host);

  struct Rows {
    gpu::Buffer words;  ///< [row][pair of columns][3 words][point]
    std::uint32_t first_row = 0, row_count = 0;
  };
  struct Grid {
    gpu::Buffer visibility;    ///< [coefficient][point]
    std::vector<Rows> thrown;  ///< one part that holds nothing where nothing is thrown
    std::uint32_t points = 0;
  };
  bool empty() const { return grids_.empty(); }
  const std::vector<Grid>& grids() const { return grids_; }
  int orderAskedFor() const { return order_; }
  bool onHost() const { return on_host_; }
  int lightOrder() const { return light_order_; }
  int fieldOrder() const { return field_order_; }
  int visibilityOrder() const { return light_order_ + field_order_ - 1; }
  bool hasThrown() const { return has_thrown_; }
  /// 32-bit words of a point's radiance.
  std::uint32_t wordsOfPoint() const {
    return std::uint32_t(field_order_ * field_order_) * (has_thrown_ ? 3u : 2u);
  }

 private:
  Grid makeGrid(gpu::Device& device, const std::string& place, const NeighbourhoodTransfer& grid) const;

  int order_, light_order_ = 0, field_order_ = 0;
  bool on_host_, has_thrown_ = false;
  std::vector<Grid> grids_;
};

/// One frame of it.
class NeighbourhoodPasses {
 public:
  /// Adds "prt.neighbourhood_points" and "prt.neighbourhood_turn": the radiance in every grid, for what reads it. `light` is
  /// the world's, of buffers.lightOrder() bands; `damped`: where ringing makes a sum negative, one of a windowed
  /// radiance is mixed in.
  NeighbourhoodPasses(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                      const NeighbourhoodBuffers& buffers, const TransferBuffers& transfer,
                      const sh::ShRgb& light, bool damped);

  /// Adds "prt.neighbourhood_vertices", once a chunk, where baked vertices stand in others' grids: changes their light.
  void lightVertices(const TransferBuffers& transfer, gpu::BufferRef vertex_light);
  /// Adds "prt.neighbourhood_pixels": the terms of `lighting` with shadow and thrown light. The first of each path counts.
  void lightPixels(frame::Lighting& lighting, bool indirect);

 private:
  void multiply(std::size_t carrier, const sh::ShRgb& light);
  void multiplyOnHost(std::size_t carrier, std::vector<glm::vec3> lights);
  std::uint32_t addReader(std::size_t carrier, const glm::mat4& world_from_place);
  void findReaders(const TransferBuffers& transfer);
  void turn();
  void turnOnHost();

  gpu::FrameGraph& graph_;
  const frame::FrameInputs& inputs_;
  const NeighbourhoodBuffers& buffers_;
  sh::ShRgb light_;  ///< exposed, of fieldOrder() bands
  float exposure_ = 1.0f;
  bool damped_ = false;
  gpu::BufferRef fields_, radiance_;
  std::vector<std::uint32_t> first_words_;  ///< of each carrier's fields
  std::vector<float> rotations_;
  std::vector<NeighbourhoodTurn> turns_;
  std::uint32_t radiance_words_ = 0;
  std::vector<NeighbourhoodGrid> grids_;  ///< in the world, one a carrier; then those of readers
  std::vector<NeighbourhoodReader> readers_;
  std::vector<glm::vec3> reader_lights_;
};

}  // namespace gloam::prt
