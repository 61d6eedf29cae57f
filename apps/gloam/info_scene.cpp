// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <gloam/scene.h>
#include <gloam/volume.h>

#include <cstring>
#include <fstream>

#include "info.h"
#include "scene/gltf_transfer.h"

namespace gloam::cli {
namespace {

constexpr std::uint32_t kMaxJsonBytes = 1u << 28;

/// The JSON text of a .gltf, or of a .glb's first chunk; the reader has checked the file before.
std::string gltfText(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::uint32_t header[5] = {};
  in.read(reinterpret_cast<char*>(header), sizeof header);
  constexpr std::uint32_t kMagic = 0x46546c67;  // "glTF"
  std::error_code ignored;
  const auto file_bytes = std::filesystem::file_size(path, ignored);
  std::size_t size = file_bytes;
  if (in.gcount() == sizeof header && header[0] == kMagic) {
    size = header[3];
  } else {
    in.clear();
    in.seekg(0);
  }
  if (size > file_bytes || size > kMaxJsonBytes) return "";
  std::string text(size, '\0');
  in.read(text.data(), std::streamsize(size));
  return text;
}

Json extensionsJson(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".glb" && extension != ".gltf") return nullptr;
  const Json document = Json::parse(gltfText(path), nullptr, false);
  return document.is_object() ? document.value("extensionsUsed", Json::array()) : Json(nullptr);
}

Json texturesJson(const Scene& scene) {
  Json json = Json::array();
  for (const Texture& texture : scene.textures) {
    json.push_back({{"name", texture.name}, {"size", fmt::format("{}x{}", texture.width, texture.height)}});
  }
  return json;
}

Json lightsJson(const Scene& scene) {
  static constexpr const char* kTypes[] = {"directional", "point", "spot"};
  Json json = Json::array();
  for (const Light& light : scene.lights) {
    json.push_back(
        {{"name", light.name}, {"type", kTypes[int(light.type)]}, {"intensity", shortest(light.intensity)}});
  }
  return json;
}

Json camerasJson(const PosedScene& posed) {
  Json json = Json::array();
  for (const PosedCamera& posed_camera : posed.cameras) {
    const Camera& camera = posed_camera.camera;
    Json entry = {{"name", camera.name}, {"type", camera.perspective ? "perspective" : "orthographic"}};
    if (camera.perspective) entry["vertical_fov_deg"] = shortest(glm::degrees(camera.vertical_fov_rad));
    json.push_back(std::move(entry));
  }
  return json;
}

Json animationsJson(const Scene& scene) {
  Json json = Json::array();
  for (const Animation& animation : scene.animations) {
    json.push_back({{"name", animation.name}, {"channels", animation.channels.size()}});
  }
  return json;
}

Json transferJson(const Scene& scene) {
  std::size_t meshes = 0, vertices = 0, glossy_vertices = 0, floats = 0, lightmaps = 0, texels = 0;
  Json glossy = nullptr;
  const Transfer* any = nullptr;
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.transfer) continue;
    any = mesh.transfer.get();
    ++meshes;
    if (any->ofTexels()) {
      ++lightmaps;
      texels += std::size_t(any->texel_width) * std::size_t(any->texel_height);
    } else {
      vertices += mesh.vertexCount();
    }
    floats += any->direct.size() + any->indirect.size();
    const GlossyTransfer& own = any->glossy;
    if (own.empty()) continue;
    floats += own.visibility.size() + own.indirect.size();
    glossy_vertices += mesh.vertexCount();
    glossy = {{"light_order", own.light_order},
              {"radiance_order", own.field_order},
              {"interreflected", !own.indirect.empty()},
              {"exponent", own.exponent > 0.0f ? Json(shortest(own.exponent)) : Json(nullptr)},
              {"vertices", glossy_vertices}};
  }
  if (any == nullptr) return nullptr;
  return {{"kind", transferKind(*any)},
          {"order", any->order},
          {"coefficients", any->order * any->order},
          {"bounces", any->bounces},
          {"directions", any->directions},
          {"meshes", meshes},
          {"vertices", vertices},
          {"lightmaps", lightmaps},
          {"texels", texels},
          {"glossy", glossy},
          {"bytes_in_memory", floats * sizeof(float)}};
}

Json volumesJson(const Scene& scene) {
  Json json = Json::array();
  for (const Node& node : scene.nodes) {
    if (!node.volume) continue;
    const Volume& volume = *node.volume;
    Json transfer = nullptr;
    if (volume.transfer)
      transfer = {{"order", volume.transfer->order}, {"scatterings", volume.transfer->bounces + 1}};
    json.push_back({{"name", volume.name},
                    {"size", fmt::format("{}x{}x{}", volume.size.x, volume.size.y, volume.size.z)},
                    {"albedo", shortest(volume.albedo)},
                    {"asymmetry", shortest(volume.asymmetry)},
                    {"transfer", transfer}});
  }
  return json;
}

Json materialsJson(const Scene& scene) {
  Json json = Json::array();
  for (const Material& material : scene.materials) {
    const glm::vec4& base = material.base_color;
    json.push_back({{"name", material.name},
                    {"base_color", {shortest(base.x), shortest(base.y), shortest(base.z), shortest(base.w)}},
                    {"metallic", shortest(material.metallic)},
                    {"roughness", shortest(material.roughness)}});
  }
  return json;
}

}  // namespace

Json describeScene(const std::string& name, Console& console) {
  const Scene scene = loadScene(name, console.progress());
  console.endProgress();
  const PosedScene posed = pose(scene, 0.0f);
  std::size_t vertices = 0, triangles = 0, drawn = 0, skinned = 0, morphed = 0;
  for (const Mesh& mesh : scene.meshes) {
    vertices += mesh.vertexCount(), triangles += mesh.triangleCount();
    skinned += mesh.influences > 0, morphed += !mesh.morph_targets.empty();
  }
  for (const Instance& instance : posed.instances)
    drawn += scene.meshes[std::size_t(instance.mesh)].triangleCount();
  const glm::vec3 &low = posed.bounds_min, &high = posed.bounds_max;
  Json json = {{"kind", "scene"},
               {"file", name},
               {"meshes", scene.meshes.size()},
               {"skinned_meshes", skinned},
               {"morphed_meshes", morphed},
               {"vertices", vertices},
               {"triangles", triangles},
               {"instances_drawn", posed.instances.size()},
               {"triangles_drawn", drawn},
               {"nodes", scene.nodes.size()},
               {"bounds", {{"minimum", shortest(low)}, {"maximum", shortest(high)}}},
               {"materials", materialsJson(scene)},
               {"textures", texturesJson(scene)},
               {"cameras", camerasJson(posed)},
               {"lights", lightsJson(scene)},
               {"animations", animationsJson(scene)},
               {"duration_s", shortest(scene.duration_s())},
               {"environment", scene.environment.empty() ? Json(nullptr) : Json(scene.environment.name)},
               {"extensions", extensionsJson(name)},
               {"transfer", transferJson(scene)},
               {"volumes", volumesJson(scene)},
               {"warnings", scene.warnings}};
  return json;
}

}  // namespace gloam::cli
