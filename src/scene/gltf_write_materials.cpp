// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Materials with the extensions that they need: KHR_materials_specular, KHR_materials_emissive_strength,
// KHR_texture_transform. Textures are stored as PNG, without alpha where all of it is 1.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <tuple>

#include "scene/gltf_write_parts.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

void appendBytes(void* out, void* data, int size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  static_cast<std::vector<std::uint8_t>*>(out)->insert(static_cast<std::vector<std::uint8_t>*>(out)->end(),
                                                       begin, begin + size);
}

std::vector<std::uint8_t> encodedPng(const Texture& texture) {
  const std::size_t pixels = texture.rgba.size() / 4;
  bool opaque = true;
  for (std::size_t i = 0; i < pixels && opaque; ++i) opaque = texture.rgba[4 * i + 3] == 255;
  std::vector<std::uint8_t> png, rgb;
  if (opaque) {
    rgb.reserve(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      rgb.insert(rgb.end(), texture.rgba.begin() + std::ptrdiff_t(4 * i),
                 texture.rgba.begin() + std::ptrdiff_t(4 * i + 3));
    }
  }
  const int channels = opaque ? 3 : 4;
  const std::uint8_t* data = opaque ? rgb.data() : texture.rgba.data();
  stbi_write_png_to_func(appendBytes, &png, texture.width, texture.height, channels, data,
                         texture.width * channels);
  return png;
}

int wrapCode(Wrap wrap) {
  return wrap == Wrap::kClampToEdge ? 33071 : wrap == Wrap::kMirroredRepeat ? 33648 : 10497;
}

class MaterialWriter {
 public:
  MaterialWriter(const Scene& scene, GlbBuilder& builder) : scene_(scene), builder_(builder) {
    for (const Texture& texture : scene.textures) {
      Json image = {{"mimeType", "image/png"}, {"bufferView", builder.addView(encodedPng(texture))}};
      if (!texture.name.empty()) image["name"] = texture.name;
      builder.add("images", std::move(image));
    }
  }

  void write(const Material& m) {
    Json pbr = {{"baseColorFactor", tidyArray(clamped(m.base_color), 4)},
                {"metallicFactor", tidy(m.metallic)},
                {"roughnessFactor", tidy(m.roughness)}};
    Json material = {{"doubleSided", m.double_sided}};
    if (!m.name.empty()) material["name"] = m.name;
    addTexture(m.base_color_map, "baseColorTexture", pbr);
    addTexture(m.metallic_roughness_map, "metallicRoughnessTexture", pbr);
    material["pbrMetallicRoughness"] = std::move(pbr);
    if (addTexture(m.normal_map, "normalTexture", material))
      material["normalTexture"]["scale"] = tidy(m.normal_scale);
    if (addTexture(m.occlusion_map, "occlusionTexture", material)) {
      material["occlusionTexture"]["strength"] = tidy(m.occlusion_strength);
    }
    addTexture(m.emission_map, "emissiveTexture", material);
    addEmission(m.emission, material);
    if (m.alpha_mask) {
      material["alphaMode"] = "MASK";
      material["alphaCutoff"] = tidy(m.alpha_cutoff);
    }
    if (m.specular != 1.0f) {
      material["extensions"]["KHR_materials_specular"] = {{"specularFactor", tidy(m.specular)}};
      builder_.use("KHR_materials_specular");
    }
    builder_.add("materials", std::move(material));
  }

 private:
  static glm::vec4 clamped(const glm::vec4& c) { return glm::clamp(c, glm::vec4(0.0f), glm::vec4(1.0f)); }

  void addEmission(const glm::vec3& emission, Json& material) {
    const float strength = powerOfTwoFrom(std::max({emission.x, emission.y, emission.z}));
    if (!(strength > 0.0f)) return;
    material["emissiveFactor"] = tidyArray(strength > 1.0f ? emission / strength : emission, 3);
    if (strength <= 1.0f) return;
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", tidy(strength)}};
    builder_.use("KHR_materials_emissive_strength");
  }

  bool addTexture(const TextureSlot& slot, const char* member, Json& parent) {
    if (!slot) return false;
    Json info = {{"index", textureOf(slot)}};
    if (slot.uv_set != 0) info["texCoord"] = slot.uv_set;
    if (slot.texture_from_uv != glm::mat3(1.0f)) {
      info["extensions"]["KHR_texture_transform"] = transform(slot.texture_from_uv);
      builder_.use("KHR_texture_transform");
    }
    parent[member] = std::move(info);
    return true;
  }

  /// offset, rotation, scale of M = T R S, R = (c, s; -s, c): v runs down, so that a positive angle turns
  /// counter-clockwise as seen.
  static Json transform(const glm::mat3& m) {
    const glm::vec2 u(m[0]), v(m[1]);
    const float angle = std::atan2(-u.y, u.x), c = std::cos(angle), s = std::sin(angle);
    const glm::vec2 scale(glm::length(u),
                          glm::dot(v, glm::vec2(s, c)));  // negative where the picture is mirrored
    return {{"offset", {tidy(m[2].x), tidy(m[2].y)}},
            {"rotation", tidy(angle)},
            {"scale", {tidy(scale.x), tidy(scale.y)}}};
  }

  int textureOf(const TextureSlot& slot) {
    const auto key = std::make_tuple(slot.texture, slot.wrap_u, slot.wrap_v, slot.nearest);
    const auto found = textures_.find(key);
    if (found != textures_.end()) return found->second;
    const auto sampler_key = std::make_tuple(slot.wrap_u, slot.wrap_v, slot.nearest);
    if (!samplers_.count(sampler_key)) {
      samplers_[sampler_key] = builder_.add("samplers", {{"wrapS", wrapCode(slot.wrap_u)},
                                                         {"wrapT", wrapCode(slot.wrap_v)},
                                                         {"magFilter", slot.nearest ? 9728 : 9729},
                                                         {"minFilter", slot.nearest ? 9728 : 9987}});
    }
    return textures_[key] =
               builder_.add("textures", {{"source", slot.texture}, {"sampler", samplers_[sampler_key]}});
  }

  const Scene& scene_;
  GlbBuilder& builder_;
  std::map<std::tuple<int, Wrap, Wrap, bool>, int> textures_;
  std::map<std::tuple<Wrap, Wrap, bool>, int> samplers_;
};

}  // namespace

void writeMaterials(const Scene& scene, GlbBuilder& builder) {
  MaterialWriter writer(scene, builder);
  for (const Material& material : scene.materials) writer.write(material);
}

}  // namespace gloam
