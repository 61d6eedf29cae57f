// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A Scene as a .glb, from start to end: the page to begin with.
#include "scene/gltf_neighbourhood.h"
#include "scene/gltf_volume.h"
#include "scene/gltf_write_parts.h"

namespace gloam {
namespace {

/// The environment rides along where a name brings it back: glTF has no extension for a sky, and pictures of radiance stay
/// files of their own.
void writeEnvironment(const Environment& environment, nlohmann::json& scene) {
  if (environment.empty() || environment.name.rfind("sky:", 0) != 0) return;
  scene["extras"]["gloam_environment"] = {{"name", environment.name},
                                          {"rotation_rad", tidy(environment.rotation_rad)},
                                          {"intensity", tidy(environment.intensity)}};
}

}  // namespace

void writeGlb(const Scene& scene, const std::filesystem::path& path, const WriteOptions& options) {
  GlbBuilder builder;
  const MeshGroups groups = groupMeshes(scene);
  writeMaterials(scene, builder);
  writeMeshes(scene, groups, options, builder);
  writeCameras(scene, builder);
  writeLights(scene, builder);
  const std::vector<int> roots = writeNodes(scene, groups, path.string(), builder);
  writeNeighbourhoods(scene, options.half_float, builder);
  writeVolumes(scene, options.half_float, builder);
  writeSkins(scene, builder);
  writeAnimations(scene, builder);
  nlohmann::json shown = nlohmann::json::object();
  if (!scene.name.empty()) shown["name"] = scene.name;
  if (!roots.empty()) shown["nodes"] = roots;
  writeEnvironment(scene.environment, shown);
  builder.root["scene"] = builder.add("scenes", std::move(shown));
  builder.save(path);
}

}  // namespace gloam
