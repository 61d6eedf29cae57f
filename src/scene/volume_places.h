// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where volumes stand. A posed scene has instances of meshes, no nodes; volumes hang on nodes.
#pragma once

#include <gloam/volume.h>

namespace gloam {

struct PlacedVolume {
  int node = kNone;
  std::shared_ptr<const Volume> volume;
  glm::mat4 world_from_node{1.0f};
};

/// Keeps of a scene what it takes to say where its volumes are: nodes and what moves them.
class VolumePlaces {
 public:
  VolumePlaces() = default;
  explicit VolumePlaces(const Scene& scene);
  /// Volumes of shown nodes, in order of nodes.
  std::vector<PlacedVolume> at(float time_s) const;

 private:
  Scene skeleton_;  ///< a mesh without vertices stands for each volume
};

/// Throws Error(place, …) for a size below 2 or beyond 2^31 voxels, numbers that are not as many as voxels, or of which one is
/// negative or not finite, a box without room, an albedo or a phase function out of range.
void checkVolume(const Volume& volume, const std::string& place);

}  // namespace gloam
