// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The parts of a glTF file on their way into a Scene. Every function throws Error that names the file and the field.
#pragma once

#include <gloam/scene.h>

#include <map>
#include <vector>

#include "scene/gltf_accessors.h"
#include "scene/mesh_repair.h"

namespace gloam {

/// What the parts share while one file is read.
struct GltfReading {
  explicit GltfReading(const std::filesystem::path& path, const Progress& to)
      : document(path), progress(to) {}

  GltfDocument document;
  GltfAccessors accessors{document};
  const Progress& progress;
  Scene scene;
  std::vector<std::vector<int>> meshes_of;  ///< Scene::meshes that came from each mesh of the file
  MeshRepairs repairs;
  int default_material = kNone;         ///< for primitives without one
  std::vector<int> light_of;            ///< Scene::lights for each light of the file; kNone for unknown kinds
  std::map<int, int> texture_of_image;  ///< Scene::textures by images[] of the file

  /// Progress, and the place where reading can be interrupted.
  void step(double fraction, const char* what) const {
    progress.report(fraction, what);
    if (progress.stopRequested()) throw Interrupted("reading was interrupted");
  }
};

/// Materials and the textures they use (pictures that nothing uses are not decoded).
void readMaterials(GltfReading& reading);
/// KHR_materials_pbrSpecularGlossiness in metallic-roughness terms.
void convertSpecularGlossiness(GltfReading& reading, const nlohmann::json& extension, Material& material,
                               const std::string& where);
/// A texture reference; empty where its picture is of a kind that we cannot read and need not.
TextureSlot readTextureSlot(GltfReading& reading, const nlohmann::json& info, const std::string& where);

/// Primitives. Adds a default material where one has none.
void readMeshes(GltfReading& reading);
/// Nodes, scenes, skins, instances, and what hangs on nodes.
void readNodes(GltfReading& reading);
void readCameras(GltfReading& reading);
void readLights(GltfReading& reading);
/// EXT_lights_image_based of the shown scene: irradiance coefficients turned back into radiance.
void readImageLight(GltfReading& reading);
void readNamedSky(GltfReading& reading);      ///< scenes[].extras.gloam_environment
void readAnimations(GltfReading& reading);

/// The node's name, for messages and scenes alike.
std::string nameOf(const nlohmann::json& object, const std::string& otherwise = {});

}  // namespace gloam
