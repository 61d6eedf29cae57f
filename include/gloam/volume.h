// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Smoke and cloud: density on a grid, and its transfer (Sloan, Kautz, Snyder 2002, section 6; PRT-7).
#pragma once

#include <gloam/scene.h>

#include <filesystem>

namespace gloam {

/// Density in a box that stands in the axes of the node that carries it. Voxel (x, y, z), x first, is centred at
/// bounds_min + (x + 1/2, …) * (bounds_max - bounds_min) / size; between centres it is trilinear, from the outermost ones to
/// the box's sides constant, outside the box nothing. Lengths are those of the node: a scaled cloud is as dense to look at.
struct Volume {
  std::string name;
  glm::ivec3 size{0};
  glm::vec3 bounds_min{0.0f}, bounds_max{1.0f};
  std::vector<float> density;  ///< extinction, 1 / metre, not negative
  glm::vec3 albedo{0.99f};     ///< share of extinction that scatters
  float asymmetry = 0.0f;      ///< g of the Henyey-Greenstein phase function, -1 < g < 1
  /// Of the voxels, as points; null unless baked. DS gives the mean over all directions of the light that reaches a voxel
  /// unscattered, DI - DS of what was scattered before: radiance (1 / 4 pi times fluence). `bounces` is the number of
  /// scatterings before the last. Voxels of no density, whose neighbours have none, hold zeros.
  std::shared_ptr<const Transfer> transfer;
  std::size_t voxels() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
};

struct VolumeBakeOptions {
  int order = 5;                     ///< bands of light, 3 to 6
  int scatterings = 16;              ///< orders of scattering that are drawn, 1 (single) to 256
  int directions = 512;              ///< in which a voxel looks out, 64 to 65536
  int scatter_directions = 64;       ///< in which it gathers from other voxels, 16 to 65536
  int threads = 0;                   ///< 0: all cores. The result does not depend on it
  float time_s = 0.0f;               ///< instant at which the scene is posed
  std::size_t memory_bytes = 0;      ///< most that the bake may take; 0: what the machine has
  std::filesystem::path checkpoint;  ///< as BakeOptions::checkpoint, of all volumes together
  bool keep_checkpoint = false;      ///< as BakeOptions::keep_checkpoint; to be removed by the caller
};

struct VolumeEstimate {
  std::size_t volumes = 0, voxels = 0;
  std::size_t filled = 0;  ///< voxels that have density or a neighbour with some: those that are baked
  std::size_t memory_bytes = 0,
              file_bytes = 0;  ///< the largest volume's memory, what all add to the file as floats
};

struct VolumeReport {
  std::size_t volumes = 0, filled = 0;
  double seconds = 0.0;
  /// What the last order of scattering still added, as a share of all scattered light under even light, of the volume for which
  /// it is greatest: what further orders would add is about this, times the number of orders a photon lives.
  double last_order = 0.0;
  bool resumed = false;  ///< a checkpoint brought work along, which `seconds` does not count
};

/// Whether any node carries a volume; and one that is not baked.
bool carriesVolumes(const Scene& scene);
bool carriesUnbakedVolumes(const Scene& scene);
/// Names of the volumes, for messages: "cloud, smoke".
std::string volumeNames(const Scene& scene);

/// Throws Error where options are out of range.
VolumeEstimate estimateVolumes(const Scene& scene, const VolumeBakeOptions& options);

/// Transfer of every volume's voxels, single scattering and further orders; the scene's rigid meshes block light from outside.
/// Each volume is baked as if the others were not there. Same bits for any number of threads. Throws Error for options out of
/// range, a volume whose numbers do not fit and one that takes more memory than is granted; Interrupted when asked to stop
/// (the checkpoint stays).
Scene bakeVolumes(const Scene& scene, const VolumeBakeOptions& options, const Progress& progress = {},
                  VolumeReport* report = nullptr);

}  // namespace gloam
