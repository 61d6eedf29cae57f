// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The parts of an assimp scene on their way into ours. Only for units that are built with assimp.
#pragma once

#include <assimp/scene.h>
#include <gloam/scene.h>

#include <map>
#include <string>
#include <vector>

#include "scene/mesh_repair.h"

namespace gloam {

/// assimp refers to nodes by name.
struct AssimpNodes {
  std::map<std::string, int> by_name;
  std::vector<std::vector<int>> users_of_mesh;  ///< nodes that show each aiMesh
};

inline glm::vec3 toGlm(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
inline glm::mat4 toGlm(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

/// One of ours for each of theirs, and their textures as names or encoded bytes. `scan`: a format without materials, whose
/// vertex colours are the surface's own.
void readAssimpMaterials(const aiScene& source, bool scan, Scene& scene);
AssimpNodes readAssimpNodes(const aiScene& source, Scene& scene);
void readAssimpCamerasAndLights(const aiScene& source, const AssimpNodes& nodes, Scene& scene);
/// Node animation; keys that do not grow in time are dropped.
void readAssimpAnimations(const aiScene& source, const AssimpNodes& nodes, Scene& scene);

}  // namespace gloam
