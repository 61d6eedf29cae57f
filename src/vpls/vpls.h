// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Virtual point lights (Keller 1997) made of reflective shadow maps on the device (row MS-2). Shared by the techniques that
// gather them.
#pragma once

#include "vpls/reflective_maps.h"
#include "vpls/vpls_shared.h"

namespace gloam::vpls {

/// How virtual lights are taken from a map; each way their flux is that of the map.
enum class Sampling : std::uint8_t {
  kGrid,       ///< one a cell of a regular grid: the cell's flux, at the mean of what it lights
  kQuasi,      ///< at points of a quasi-random sequence, spread evenly over the map
  kImportance  ///< the same sequence, warped to where the flux is
};

struct VplOptions {
  int count = 256;     ///< asked for, of all lamps together
  int map_size = 256;  ///< texels a side of a map; more where the grid is finer
  Sampling sampling = Sampling::kGrid;
};

struct Vpls {
  ReflectiveMaps maps;
  gpu::BufferRef rows;         ///< VplRow; those that send light come first, the rest is zero
  gpu::BufferRef count;        ///< one uint32: how many send light
  std::uint32_t capacity = 0;  ///< rows, a multiple of kVplChunk; 0 without lamps

  std::uint32_t chunks() const { return capacity / kVplChunk; }
  gpu::BufferRef chunk(std::uint32_t index) const {
    const std::size_t bytes = kVplChunk * sizeof(VplRow);
    return rows.slice(index * bytes, bytes);
  }
};

/// Cells a side of the grid in each map: lamps share `count` evenly, and the maps of a cube that of their lamp; at least one.
std::vector<int> gridsOf(std::span<const ReflectiveMap> maps, int count);

/// Adds passes "vpls.maps", "vpls.reflect", "vpls.cells" (or "vpls.sums", "vpls.rows", "vpls.draw", "vpls.normalise") and
/// "vpls.pack". The order of lights, and so of sums over them, does not change from run to run.
Vpls recordVpls(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const VplOptions& options);

}  // namespace gloam::vpls
