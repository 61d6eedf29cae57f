// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A glTF file from start to end: the page to begin with. The document is checked as a whole before anything is made of it.
#include "scene/gltf_read.h"

#include "scene/gltf_parts.h"

namespace gloam {
namespace {

/// Files that hold meshes and no node at all are libraries rather than scenes; they are shown all the same.
void showMeshesWithoutNodes(GltfReading& reading) {
  Scene& scene = reading.scene;
  if (!scene.nodes.empty() || scene.meshes.empty()) return;
  Node node;
  node.name = "all meshes";
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) node.meshes.push_back(static_cast<int>(i));
  scene.nodes.push_back(std::move(node));
  scene.roots = {0};
  reading.document.warn("no node shows a mesh: all are shown where they stand");
}

}  // namespace

Scene readGltf(const std::filesystem::path& path, const Progress& progress) {
  progress.report(0.0, "reading " + path.filename().string());
  GltfReading reading(path, progress);
  reading.step(0.1, "reading textures");
  readMaterials(reading);
  readMeshes(reading);
  readCameras(reading);
  readLights(reading);
  readNodes(reading);
  readAnimations(reading);
  readNamedSky(reading);
  readImageLight(reading);
  showMeshesWithoutNodes(reading);
  reading.scene.warnings = reading.document.takeWarnings();
  progress.report(1.0, "reading " + path.filename().string());
  return std::move(reading.scene);
}

}  // namespace gloam
