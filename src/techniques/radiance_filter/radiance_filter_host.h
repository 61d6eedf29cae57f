// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Twin of the filter's two passes (radiance_filter_weights, _filter) and of shading (_shade) for devices that are the host: a software driver loads and stores
// lane by lane, the host's vector units read a row as it stands.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace gloam::radiance_filter {

/// What pixels see, a plane a number, with margins of kMostTaps pixels of nothing on the left and right.
struct HostSurfaces {
  int width = 0, height = 0;
  std::vector<float> x, y, z, normal_x, normal_y, normal_z;  ///< metres; geometric normals
  std::vector<float> tolerance;                              ///< metres off the tangent plane
  std::vector<std::uint32_t> objects;                        ///< 0: none
  // What the filter finds, without margins:
  std::vector<std::uint32_t> masks[2];  ///< across, down: taps that are taken
  std::vector<glm::vec2> shifts;  ///< of the middle of what is taken, pixels; kNoShift: sets are missing

  HostSurfaces(int picture_width, int picture_height);
  std::size_t at(int px, int py) const;
  std::size_t pixel(int px, int py) const;  ///< of what has no margins
};

/// How RF-4 goes over the picture.
struct HostFilter {
  glm::ivec2 taps{1};
  int parts = 1, layers = 1;  ///< layers of a part
  bool slopes = true;
};
/// A row, from one column to before another, is as it shall be.
using RowDone = std::function<void(int row, int from, int to)>;
/// Across and then down, on all cores, edges mended. `values`: halves, four a pixel, rows of a layer and layers one after another, as
/// `filtered` is. `done` is called from any core.
void filterOnHost(HostSurfaces& surfaces, const HostFilter& filter, std::span<const std::uint16_t> values,
                  std::span<std::uint16_t> filtered, const RowDone& done);
/// Twin of radiance_filter_once: pixels of a row that would take other rows in place of their window's, in one pass; and shifts of all
/// pixels of the row.
void mendEdges(HostSurfaces& surfaces, const HostFilter& filter, int row,
               std::span<const std::uint16_t> values, std::span<std::uint16_t> filtered);
/// Whether the row has pixels there whose windows lie to one side.
bool hasSlopes(const HostSurfaces& surfaces, int row, int from, int to);
/// Twin of radiance_filter_slopes: pixels of a row, where they stand.
void followSlopes(const HostSurfaces& surfaces, const HostFilter& filter, int row, int from, int to,
                  std::span<std::uint16_t> filtered);

/// What RF-5 makes of one part of the light, all images whole, halves four a pixel.
struct HostShading {
  static constexpr int kBlock = 16;        ///< pixels at a time, at most
  std::span<const std::uint16_t> values;   ///< kFieldLayers, filtered
  std::span<const std::uint16_t> diffuse;  ///< of the G-buffer: k_d, roughness
  std::span<const glm::uvec2> normals;     ///< of the G-buffer
  glm::vec3 eye{0.0f}, forward{0.0f};
  bool perspective = true, beams = false;
  float exposure = 1.0f;
  std::span<std::uint16_t> irradiance, gloss;  ///< out
};
/// Twin of radiance_filter_shade: of one row, columns from `from` to before `to`.
void shadeRow(const HostSurfaces& surfaces, const HostShading& shading, int row, int from, int to);

}  // namespace gloam::radiance_filter
