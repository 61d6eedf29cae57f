// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Straight ways through a density grid, as light takes them between scatterings.
#pragma once

#include <gloam/volume.h>

#include <vector>

namespace gloam::prt {

inline constexpr std::uint32_t kEmptyVoxel = 0xffffffffu;

/// Extinction and albedo of the medium that scatters evenly and lets through as much as the volume does once light has gone
/// round a few corners (similarity relation, van de Hulst 1980): sigma* = sigma (1 - a g), a* = a (1 - g) / (1 - a g); a colour
/// keeps its absorption sigma (1 - a).
struct EvenMedium {
  float extinction = 1.0f;  ///< times the volume's
  glm::vec3 albedo{1.0f};
};
EvenMedium evenMedium(const Volume& volume);

/// A share of the light that leaves a voxel and arrives without another scattering.
struct Gathered {
  std::uint32_t voxel;  ///< among the filled ones
  float weight;
};

/// Ways begin at the middle of a voxel and end where the box of filled voxels does. Steps are about a voxel long; density is
/// taken from their middles, trilinear. Thread-safe.
class VolumeMarcher {
 public:
  /// `node_from_axes`: from the axes that directions stand in to the volume's coordinates.
  VolumeMarcher(const Volume& volume, float extinction, const glm::mat3& node_from_axes = glm::mat3(1.0f));

  /// Voxels that have density or a neighbour with some, ascending.
  const std::vector<std::uint32_t>& filled() const { return filled_; }
  glm::vec3 position(std::uint32_t voxel) const;
  float densityAt(const glm::vec3& position) const;
  /// Of the way from a voxel outward, in a unit direction of the axes. At most kDark, then it stops.
  float opticalDepth(std::uint32_t voxel, const glm::vec3& direction) const;
  /// The same way as (voxel, T (1 - e^-tau)) a step, added to `gathered`: weights sum to 1 - T.
  void gather(std::uint32_t voxel, const glm::vec3& direction, std::vector<Gathered>& gathered) const;

  static constexpr float kDark = 12.0f;  // 6e-6 is left

 private:
  struct Way {
    glm::vec3 at, step;   // in voxels of the padded grid: the first middle
    float length = 0.0f;  // of a step, times extinction
    int steps = 0;
  };
  Way wayFrom(std::uint32_t voxel, const glm::vec3& direction) const;
  float sample(const glm::vec3& at) const;

  glm::ivec3 size_;
  glm::vec3 cell_, origin_;
  float extinction_, step_;
  glm::mat3 node_from_axes_;
  glm::vec3 low_{0.0f}, high_{0.0f};  // of filled voxels, padded coordinates
  std::vector<float> padded_;         // the outermost voxels stand twice
  std::vector<std::uint32_t> filled_, number_;
};

}  // namespace gloam::prt
