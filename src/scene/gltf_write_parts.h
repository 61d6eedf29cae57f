// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The parts of a Scene on their way into a .glb. Each returns what its name says or fills the builder's arrays.
#pragma once

#include <gloam/scene.h>

#include <cmath>
#include <vector>

#include "scene/glb_builder.h"

namespace gloam {

/// The least that is no smaller than a positive number; any other number itself. A colour divided by it and multiplied again is
/// the same to the last bit.
inline float powerOfTwoFrom(float value) {
  int exponent = 0;
  if (!(value > 0.0f) || value > 0x1p127f) return value;
  const float part = std::frexp(value, &exponent);
  return std::ldexp(1.0f, part == 0.5f ? exponent - 1 : exponent);
}

/// Textures, samplers, images and materials; materials keep their indices.
void writeMaterials(const Scene& scene, GlbBuilder& builder);

/// glTF's meshes, each a list of our meshes (its primitives), in the order of their first use.
struct MeshGroups {
  std::vector<std::vector<int>> groups;
  int of(const std::vector<int>& meshes) const;  ///< index of the group with exactly these
};
MeshGroups groupMeshes(const Scene& scene);
void writeMeshes(const Scene& scene, const MeshGroups& groups, const WriteOptions& options,
                 GlbBuilder& builder);

void writeCameras(const Scene& scene, GlbBuilder& builder);
void writeLights(const Scene& scene, GlbBuilder& builder);
/// Nodes keep their indices; sheared ones get another above them. Returns the roots. `place` names the file in errors.
std::vector<int> writeNodes(const Scene& scene, const MeshGroups& groups, const std::string& place,
                            GlbBuilder& builder);
void writeSkins(const Scene& scene, GlbBuilder& builder);
void writeAnimations(const Scene& scene, GlbBuilder& builder);

}  // namespace gloam
