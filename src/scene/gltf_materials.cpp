// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Materials and textures (glTF 2.0 specification, sections 3.8 and 3.9; KHR_texture_transform,
// KHR_materials_emissive_strength, KHR_materials_specular).
#include <fmt/format.h>

#include <cmath>

#include "image/limits.h"
#include "scene/gltf_parts.h"
#include "scene/texture_decode.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

Wrap wrapOf(int code) {
  if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClampToEdge;
  if (code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirroredRepeat;
  return Wrap::kRepeat;
}

/// KHR_texture_transform: translation * rotation * scale. The rotation turns (u, v), v downwards, counter-clockwise as the
/// picture is seen, which takes the signs of the extension's own example.
glm::mat3 textureTransform(const Json& transform) {
  const auto pair = [&](const char* name, glm::vec2 value) {
    const auto found = transform.find(name);
    return found == transform.end() ? value : glm::vec2((*found)[0].get<float>(), (*found)[1].get<float>());
  };
  const glm::vec2 offset = pair("offset", glm::vec2(0.0f)), scale = pair("scale", glm::vec2(1.0f));
  const float angle = transform.value("rotation", 0.0f), c = std::cos(angle), s = std::sin(angle);
  return glm::mat3(c * scale.x, -s * scale.x, 0.0f, s * scale.y, c * scale.y, 0.0f, offset.x, offset.y, 1.0f);
}

/// The image that a texture shows; kNone where it is of a format that is not read and not required.
int imageOf(GltfReading& reading, int texture) {
  GltfDocument& document = reading.document;
  const Json& json = document.json["textures"][static_cast<std::size_t>(texture)];
  if (json.contains("source")) return json["source"];
  for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp"})
    if (GltfDocument::extension(json, name))
      document.warn(fmt::format("textures[{}]: has only a picture of {}, which is not read; drawn without it",
                                texture, name));
  return kNone;
}

/// Decodes an image at its first use. The Scene's texture carries the image's number until all are known.
int textureOfImage(GltfReading& reading, int image) {
  GltfDocument& document = reading.document;
  const Json& json = document.json["images"][static_cast<std::size_t>(image)];
  std::string name = nameOf(json);
  if (name.empty() && json.contains("uri") && !json["uri"].get_ref<const std::string&>().starts_with("data:"))
    name = oneLine(percentDecoded(json["uri"]));
  const auto known = reading.texture_of_image.find(image);
  if (known != reading.texture_of_image.end()) return known->second;
  const std::string where = name.empty() ? fmt::format("images[{}]", image)
                                         : fmt::format("images[{}] ('{}')", image, oneLine(name));
  reading.scene.textures.push_back(
      decodeTexture(document.image(image), name, document.place(), where, document.budget));
  return reading.texture_of_image[image] = static_cast<int>(reading.scene.textures.size()) - 1;
}

void readMaterial(GltfReading& reading, std::size_t index) {
  GltfDocument& document = reading.document;
  const gloam_tinygltf::Material& source = document.model.materials[index];
  const Json& json = document.json["materials"][index];
  const std::string where = fmt::format("materials[{}]", index);
  const auto slot = [&](const Json& parent, const char* name) {
    const auto found = parent.find(name);
    return found == parent.end() ? TextureSlot{} : readTextureSlot(reading, *found, where + "." + name);
  };

  Material material;
  material.name = source.name.empty() ? where : source.name;
  const auto& pbr = source.pbrMetallicRoughness;
  for (int c = 0; c < 4; ++c)
    material.base_color[c] =
        static_cast<float>(std::max(pbr.baseColorFactor[static_cast<std::size_t>(c)], 0.0));
  material.metallic = static_cast<float>(std::clamp(pbr.metallicFactor, 0.0, 1.0));
  material.roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
  if (json.contains("pbrMetallicRoughness")) {
    material.base_color_map = slot(json["pbrMetallicRoughness"], "baseColorTexture");
    material.metallic_roughness_map = slot(json["pbrMetallicRoughness"], "metallicRoughnessTexture");
  }
  material.normal_map = slot(json, "normalTexture");
  material.normal_scale = static_cast<float>(source.normalTexture.scale);
  material.occlusion_map = slot(json, "occlusionTexture");
  material.occlusion_strength = static_cast<float>(std::clamp(source.occlusionTexture.strength, 0.0, 1.0));
  material.emission_map = slot(json, "emissiveTexture");
  const Json* strength = GltfDocument::extension(json, "KHR_materials_emissive_strength");
  const double factor = strength ? strength->value("emissiveStrength", 1.0) : 1.0;
  for (int c = 0; c < 3; ++c)
    material.emission[c] = static_cast<float>(
        std::clamp(source.emissiveFactor[static_cast<std::size_t>(c)] * factor, 0.0, 1e30));
  material.alpha_mask = source.alphaMode == "MASK";
  material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  material.double_sided = source.doubleSided;
  if (source.alphaMode == "BLEND")
    document.warn(fmt::format("material '{}': alphaMode BLEND is drawn opaque", oneLine(material.name)));
  if (const Json* specular = GltfDocument::extension(json, "KHR_materials_specular"))
    material.specular = specular->value("specularFactor", 1.0f);
  if (const Json* extension = GltfDocument::extension(json, "KHR_materials_pbrSpecularGlossiness"))
    convertSpecularGlossiness(reading, *extension, material,
                              where + ".extensions.KHR_materials_pbrSpecularGlossiness");
  if (GltfDocument::extension(json, "KHR_materials_unlit"))
    document.warn(
        fmt::format("material '{}': KHR_materials_unlit is lit like any other", oneLine(material.name)));
  reading.scene.materials.push_back(std::move(material));
}

}  // namespace

std::string nameOf(const Json& object, const std::string& otherwise) {
  const auto found = object.find("name");
  return found == object.end() || found->get_ref<const std::string&>().empty() ? otherwise
                                                                               : found->get<std::string>();
}

TextureSlot readTextureSlot(GltfReading& reading, const Json& info, const std::string& where) {
  GltfDocument& document = reading.document;
  const int texture = info["index"];
  TextureSlot slot;
  const int image = imageOf(reading, texture);
  if (image == kNone) return slot;
  reading.step(0.2, "reading textures");
  slot.texture = textureOfImage(reading, image);
  slot.uv_set = info.value("texCoord", 0);
  const int sampler = document.model.textures[static_cast<std::size_t>(texture)].sampler;
  if (sampler >= 0) {
    const gloam_tinygltf::Sampler& source = document.model.samplers[static_cast<std::size_t>(sampler)];
    slot.wrap_u = wrapOf(source.wrapS);
    slot.wrap_v = wrapOf(source.wrapT);
    slot.nearest = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  if (const Json* transform = GltfDocument::extension(info, "KHR_texture_transform")) {
    slot.texture_from_uv = textureTransform(*transform);
    slot.uv_set = transform->value("texCoord", slot.uv_set);
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row)
        if (!std::isfinite(slot.texture_from_uv[column][row]))
          document.fail(where + ".extensions.KHR_texture_transform", "too large");
  }
  return slot;
}

void readMaterials(GltfReading& reading) {
  for (std::size_t i = 0; i < reading.document.model.materials.size(); ++i) readMaterial(reading, i);
}

}  // namespace gloam
