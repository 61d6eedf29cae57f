// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Neighbourhood transfer on the host: what a grid says at a place, the slow twin of the shaders.
#pragma once

#include <gloam/neighbourhood.h>
#include <gloam/sh.h>

#include <span>

namespace gloam::prt {

/// The eight grid points round a place and their weights; outside the grid, those of the nearest place in it.
struct GridCorners {
  std::size_t point[8];
  float weight[8];
};
GridCorners cornersAt(const NeighbourhoodTransfer& grid, const glm::vec3& position);

/// V at a place, interpolated: visibilityCount() numbers.
void visibilityAt(const NeighbourhoodTransfer& grid, const glm::vec3& position, std::span<float> visibility);

/// How much of the grid counts at a place: 1 inside, falling to 0 at its border (kNeighbourhoodFade of the way from the centre).
float neighbourhoodShare(const NeighbourhoodTransfer& grid, const glm::vec3& position);

/// Radiance at a place in the grid under `light` (both in the carrier's axes, field_order bands): what of the distant light
/// arrives, and what the object throws.
struct NeighbourhoodField {
  sh::ShRgb direct, thrown;
};
NeighbourhoodField fieldAt(const NeighbourhoodTransfer& grid, const glm::vec3& position,
                           const sh::ShRgb& light);

/// The irradiance that surfaces of many directions get through V and through W of (2 order - 1) bands: squared difference
/// and squared V, under light that falls as 1 / (l + 1).
glm::dvec2 irradianceDifference(int order, std::span<const float> truth, std::span<const float> other);

}  // namespace gloam::prt
