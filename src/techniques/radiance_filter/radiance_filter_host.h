// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Twin of the filter's two passes (radiance_filter_weights, _filter) for devices that are the host: a software driver loads and stores
// lane by lane, the host's vector units read a row as it stands.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace gloam::radiance_filter {

/// What pixels see, a plane a number, with margins of kMostTaps pixels of nothing on the left and right.
struct HostSurfaces {
  int width = 0, height = 0;
  std::vector<float> x, y, z, normal_x, normal_y, normal_z;  ///< metres; geometric normals
  std::vector<float> tolerance;                              ///< metres off the tangent plane
  std::vector<std::uint32_t> objects;                        ///< 0: none

  HostSurfaces(int picture_width, int picture_height);
  std::size_t at(int px, int py) const;
};

/// RF-4, across and then down, on all cores. `values`: halves, four a pixel, rows of a layer and layers one after another, filtered in
/// place; `spare` holds as many.
void filterOnHost(const HostSurfaces& surfaces, glm::ivec2 taps, int layers, std::span<std::uint16_t> values,
                  std::span<std::uint16_t> spare);

}  // namespace gloam::radiance_filter
