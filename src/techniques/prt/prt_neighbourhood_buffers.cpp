// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Grids of neighbourhood transfer as the device keeps them: visibility as floats, thrown light as halves, points side by side.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "math/sh_high_order.h"
#include "techniques/prt/prt_neighbourhood.h"

namespace gloam::prt {
namespace {

void checkSizes(const std::string& place, const NeighbourhoodTransfer& grid) {
  const bool sized = glm::all(glm::greaterThanEqual(grid.size, glm::ivec3(2)));
  const bool known =
      grid.light_order >= 1 && grid.light_order <= grid.field_order && grid.field_order <= sh::kMaxOrder;
  if (!sized || !known || grid.visibility.size() != grid.points() * grid.visibilityCount() ||
      (!grid.indirect.empty() && grid.indirect.size() != 3 * grid.points() * grid.matrixCount()))
    throw Error(place,
                fmt::format("neighbourhood transfer from {} to {} bands at {} x {} x {} points: its "
                            "numbers do not fit",
                            grid.light_order, grid.field_order, grid.size.x, grid.size.y, grid.size.z));
}

}  // namespace

NeighbourhoodBuffers::NeighbourhoodBuffers(gpu::Device& device, const frame::GpuScene& scene, int order,
                                           bool on_host)
    : order_(order), on_host_(on_host) {
  const int most = order > 0 ? order : sh::kMaxOrder;
  light_order_ = field_order_ = most;
  const std::vector<frame::Carrier>& carriers = scene.carriers().shown();
  for (const frame::Carrier& carrier : carriers) {
    checkSizes("node '" + carrier.name + "'", *carrier.transfer);
    light_order_ = std::min(light_order_, carrier.transfer->light_order);
    field_order_ = std::min(field_order_, carrier.transfer->field_order);
    has_thrown_ = has_thrown_ || !carrier.transfer->indirect.empty();
  }
  light_order_ = std::min(light_order_, field_order_);
  for (const frame::Carrier& carrier : carriers)
    grids_.push_back(makeGrid(device, "node '" + carrier.name + "'", *carrier.transfer));
}

NeighbourhoodBuffers::Grid NeighbourhoodBuffers::makeGrid(gpu::Device& device, const std::string& place,
                                                          const NeighbourhoodTransfer& grid) const {
  Grid result;
  const std::size_t points = grid.points(), kept = std::size_t(visibilityOrder() * visibilityOrder());
  result.points = std::uint32_t(points);
  const std::size_t columns = std::size_t(light_order_ * light_order_), pairs = (columns + 1) / 2;
  const std::size_t rows = std::size_t(field_order_ * field_order_), row_words = pairs * 3 * points;
  const std::size_t limit = device.limits().max_storage_bytes;
  const std::size_t radiance = points * wordsOfPoint() * 4;
  if (std::max({kept * points * 4, row_words * 4, radiance}) > limit)
    throw Error(place, fmt::format("a grid of {} points does not fit into the {} MiB that a buffer of this "
                                   "device holds: bake fewer points",
                                   points, limit >> 20));
  std::vector<float> visibility(kept * points);
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t k = 0; k < kept; ++k)
      visibility[k * points + p] = grid.visibility[p * grid.visibilityCount() + k];
  result.visibility = filledBuffer(device, "prt.neighbourhood_visibility", visibility, on_host_);
  const std::size_t stored = std::size_t(grid.light_order * grid.light_order);
  const std::size_t together = std::max<std::size_t>(1, limit / (row_words * 4));
  for (std::size_t first = 0; first < rows; first += together) {
    const std::size_t count = std::min(together, rows - first);
    std::vector<std::uint32_t> words;
    if (has_thrown_) words.assign(count * row_words, 0);
    for (std::size_t w = 0; w < words.size() && !grid.indirect.empty(); ++w) {
      const std::size_t p = w % points, third = w / points % 3, pair = w / points / 3 % pairs;
      const std::size_t i = first + w / row_words;
      const auto value = [&](std::size_t n) {  // of the six of a pair of columns
        const std::size_t j = 2 * pair + n / 3;
        if (j >= columns) return 0.0f;
        return grid
            .indirect[((p * std::size_t(grid.field_order * grid.field_order) + i) * stored + j) * 3 + n % 3];
      };
      words[w] = glm::packHalf2x16(glm::vec2(value(2 * third), value(2 * third + 1)));
    }
    if (words.empty()) words.push_back(0);
    result.thrown.push_back({filledBuffer(device, "prt.neighbourhood_thrown", words, on_host_),
                             std::uint32_t(first), std::uint32_t(count)});
  }
  return result;
}

}  // namespace gloam::prt
