// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// KHR_materials_pbrSpecularGlossiness -> metallic-roughness. For factors: the metallic m that gives the same diffuse and
// specular brightness, from base*(1 - 0.04)*(1 - m) = diffuse*(1 - s) and 0.04*(1 - m) + base*m = specular, s the greatest
// specular component: 0.04 m^2 + (d(1 - s)/0.96 + s - 0.08) m + 0.04 - s = 0 (appendix of the extension's specification).
// Of textures, diffuse becomes base colour and glossiness becomes roughness; specular colour textures are left out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf_parts.h"

namespace gloam {
namespace {

constexpr float kDielectric = 0.04f;

/// Perceived brightness, as the specification's example takes it.
float brightness(const glm::vec3& c) {
  return std::sqrt(0.299f * c.r * c.r + 0.587f * c.g * c.g + 0.114f * c.b * c.b);
}

float solveMetallic(float diffuse, float specular, float one_minus_specular) {
  if (specular < kDielectric) return 0.0f;
  const float b = diffuse * one_minus_specular / (1.0f - kDielectric) + specular - 2.0f * kDielectric;
  const float c = kDielectric - specular;
  const float root = std::sqrt(std::max(b * b - 4.0f * kDielectric * c, 0.0f));
  return std::clamp((-b + root) / (2.0f * kDielectric), 0.0f, 1.0f);
}

template <typename VecT>
VecT vectorOf(const nlohmann::json& object, const char* name, const VecT& otherwise) {
  const auto found = object.find(name);
  VecT out = otherwise;
  if (found != object.end())
    for (int c = 0; c < VecT::length(); ++c)
      out[c] = std::clamp((*found)[static_cast<std::size_t>(c)].get<float>(), 0.0f, 1.0f);
  return out;
}

}  // namespace

void convertSpecularGlossiness(GltfReading& reading, const nlohmann::json& extension, Material& material,
                               const std::string& where) {
  const glm::vec4 diffuse = vectorOf(extension, "diffuseFactor", glm::vec4(1.0f));
  const glm::vec3 specular = vectorOf(extension, "specularFactor", glm::vec3(1.0f));
  const float gloss = std::clamp(extension.value("glossinessFactor", 1.0f), 0.0f, 1.0f);
  const bool has_map = extension.contains("specularGlossinessTexture");
  const float one_minus_specular = 1.0f - std::max({specular.r, specular.g, specular.b});

  // The factor of a specular map says little: most such files have 1 there and dielectrics in the map.
  material.metallic =
      has_map ? 0.0f
              : solveMetallic(brightness(glm::vec3(diffuse)), brightness(specular), one_minus_specular);
  const float m = material.metallic;
  const glm::vec3 from_diffuse =
      glm::vec3(diffuse) * (one_minus_specular / (1.0f - kDielectric) / std::max(1.0f - m, 1e-4f));
  const glm::vec3 from_specular = (specular - kDielectric * (1.0f - m)) / std::max(m, 1e-4f);
  const glm::vec3 base = has_map ? glm::vec3(diffuse) : glm::mix(from_diffuse, from_specular, m * m);
  material.base_color = glm::vec4(glm::clamp(base, 0.0f, 1.0f), diffuse.a);
  material.roughness = 1.0f - gloss;
  material.metallic_roughness_map = TextureSlot{};
  material.base_color_map = TextureSlot{};
  if (extension.contains("diffuseTexture"))
    material.base_color_map =
        readTextureSlot(reading, extension["diffuseTexture"], where + ".diffuseTexture");
  if (!has_map) return;

  const TextureSlot slot =
      readTextureSlot(reading, extension["specularGlossinessTexture"], where + ".specularGlossinessTexture");
  if (!slot) return;
  Scene& scene = reading.scene;
  Texture roughness = scene.textures[static_cast<std::size_t>(slot.texture)];
  reading.document.budget.charge(roughness.rgba.size(), 1, where);
  roughness.name += " as roughness";
  for (std::size_t i = 0; i < roughness.rgba.size(); i += 4) {
    const float alpha = roughness.rgba[i + 3] / 255.0f;
    const auto value = static_cast<std::uint8_t>(std::lround(255.0f * (1.0f - gloss * alpha)));
    const std::uint8_t texel[4] = {0, value, 255, 255};
    std::copy(texel, texel + 4, &roughness.rgba[i]);
  }
  scene.textures.push_back(std::move(roughness));
  material.metallic_roughness_map = slot;
  material.metallic_roughness_map.texture = static_cast<int>(scene.textures.size()) - 1;
  material.roughness = 1.0f;
  reading.document.warn(where + ": the specular colours of its texture are left out");
}

}  // namespace gloam
