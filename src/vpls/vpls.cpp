// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 3.1: virtual lights on a regular grid of the map; or quasi-random, or by importance of flux
// (row MS-2). Differs: a grid's light carries the flux of all its cell, so that nothing is lost or flickers between points.
#include "vpls/vpls.h"

#include <algorithm>
#include <cmath>

#include "shaders/vpls_shaders.h"

namespace gloam::vpls {

namespace {

struct Step {
  gpu::FrameGraph& graph;
  const ReflectiveMaps& maps;
  gpu::BufferRef drawn;  ///< VplRow, by map and cell, some of which are dark
};

gpu::ComputePass& bindMaps(gpu::ComputePass& pass, const ReflectiveMaps& maps) {
  return pass.read("position_map", maps.position).read("normal_map", maps.normal).read("flux_map", maps.flux);
}

void recordCells(const Step& step, const MapPlace& place) {
  bindMaps(step.graph.compute("vpls.cells", vpls_cells_spv), step.maps)
      .write("rows", step.drawn)
      .push(place)
      .dispatch(std::uint32_t(place.grid), std::uint32_t(place.grid));
}

/// Running sums of flux along the rows of a map and down its last column, then lights at a warped sequence.
void recordDrawn(const Step& step, const MapPlace& place, bool importance) {
  const std::string name = "vpls.sums_" + std::to_string(place.map);
  const auto texels = std::size_t(place.size) * std::size_t(place.size);
  const auto sums = step.graph.create(name, gpu::BufferDesc{.bytes = texels * sizeof(float)});
  const auto rows = step.graph.create(name + "_rows",
                                      gpu::BufferDesc{.bytes = std::size_t(place.size) * sizeof(glm::vec4)});
  step.graph.compute("vpls.sums", vpls_sums_spv)
      .specialize("importance", importance)
      .read("flux_map", step.maps.flux)
      .write("sums", sums)
      .write("row_sums", rows)
      .push(place)
      .dispatchOver(place.size);
  step.graph.compute("vpls.rows", vpls_rows_spv).readWrite("row_sums", rows).push(place).dispatch(1);
  bindMaps(step.graph.compute("vpls.draw", vpls_draw_spv), step.maps)
      .specialize("importance", importance)
      .read("sums", sums)
      .read("row_sums", rows)
      .write("rows", step.drawn)
      .push(place)
      .dispatchOver(place.grid * place.grid);
  step.graph.compute("vpls.normalise", vpls_normalise_spv)
      .read("row_sums", rows)
      .readWrite("rows", step.drawn)
      .push(place)
      .dispatch(1);
}

}  // namespace

std::vector<int> gridsOf(std::span<const ReflectiveMap> maps, int count) {
  std::size_t lamps = 0;
  for (std::size_t i = 0; i < maps.size(); ++i) lamps += i == 0 || maps[i].light != maps[i - 1].light;
  std::vector<int> grids;
  for (const ReflectiveMap& map : maps) {
    const auto of_lamp =
        std::ranges::count_if(maps, [&](const ReflectiveMap& m) { return m.light == map.light; });
    grids.push_back(
        std::max(1, int(std::lround(std::sqrt(double(count) / double(lamps) / double(of_lamp))))));
  }
  return grids;
}

Vpls recordVpls(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const VplOptions& options) {
  Vpls result;
  if (options.count <= 0) return result;
  // Two texels a cell at least, were all lights of one map.
  const int finest = 2 * int(std::ceil(std::sqrt(double(options.count))));
  result.maps = recordReflectiveMaps(graph, inputs, std::max(options.map_size, finest));
  if (result.maps.maps.empty()) return result;
  const std::vector<int> grids = gridsOf(result.maps.maps, options.count);
  const std::uint32_t rows_of_cell = options.sampling == Sampling::kGrid ? 2 : 1;
  std::uint32_t count = 0;
  for (const int grid : grids) count += rows_of_cell * std::uint32_t(grid) * std::uint32_t(grid);
  result.capacity = (count + kVplChunk - 1) / kVplChunk * kVplChunk;
  const gpu::BufferDesc desc{.bytes = result.capacity * sizeof(VplRow)};
  const auto drawn = graph.create("vpls.drawn", desc);
  result.rows = graph.create("vpls.rows", desc);
  result.count = graph.create("vpls.count", gpu::BufferDesc{.bytes = sizeof(std::uint32_t)});
  const Step step{graph, result.maps, drawn};
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const ReflectiveMap& map = result.maps.maps[i];
    const MapPlace place{{map.x, map.y}, result.maps.size, grids[i], first, std::uint32_t(i)};
    first += rows_of_cell * std::uint32_t(grids[i]) * std::uint32_t(grids[i]);
    if (options.sampling == Sampling::kGrid)
      recordCells(step, place);
    else
      recordDrawn(step, place, options.sampling == Sampling::kImportance);
  }
  graph.clear("vpls.rows", result.rows);
  graph.compute("vpls.pack", vpls_pack_spv)
      .read("drawn", drawn)
      .readWrite("rows", result.rows)
      .write("count", result.count)
      .push(count)
      .dispatch(1);
  return result;
}

}  // namespace gloam::vpls
