// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Phong materials as metallic-roughness: base colour from the diffuse colour, roughness from the exponent by the same
// n = 2 / roughness^4 - 2 that shading uses (scene.h).
#if GLOAM_HAS_ASSIMP
#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/assimp_parts.h"

namespace gloam {
namespace {

constexpr float kPlainGrey = 0.8f;  // of surfaces whose file names no material

class MaterialReader {
 public:
  MaterialReader(const aiScene& source, Scene& scene) : source_(source), scene_(scene) {}

  Material read(const aiMaterial& from, bool scan) {
    Material material;
    aiString name;
    from.Get(AI_MATKEY_NAME, name);
    material.name = name.C_Str();
    material.double_sided = true;
    material.metallic = 0.0f;
    const bool plain = scan || material.name == AI_DEFAULT_MATERIAL_NAME;
    const glm::vec3 diffuse =
        plain ? glm::vec3(kPlainGrey) : color(from, AI_MATKEY_COLOR_DIFFUSE, glm::vec3(kPlainGrey));
    material.base_color = glm::vec4(diffuse, 1.0f);
    material.emission = glm::max(color(from, AI_MATKEY_COLOR_EMISSIVE, glm::vec3(0.0f)), glm::vec3(0.0f));
    material.roughness = plain ? 1.0f : roughness(from);
    float metallic = 0.0f;
    if (from.Get(AI_MATKEY_METALLIC_FACTOR, metallic) == AI_SUCCESS && std::isfinite(metallic))
      material.metallic = std::clamp(metallic, 0.0f, 1.0f);
    float opacity = 1.0f;
    if (from.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 0.999f)
      scene_.warnings.push_back(fmt::format("material '{}': transparency is drawn opaque", material.name));
    material.base_color_map = slot(from, {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR});
    material.normal_map = slot(from, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
    material.emission_map = slot(from, {aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR});
    if (material.emission_map && material.emission == glm::vec3(0.0f)) material.emission = glm::vec3(1.0f);
    return material;
  }

 private:
  static glm::vec3 color(const aiMaterial& from, const char* key, unsigned type, unsigned index,
                         const glm::vec3& otherwise) {
    aiColor3D c;
    if (from.Get(key, type, index, c) != AI_SUCCESS ||
        !(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b)))
      return otherwise;
    return glm::clamp(glm::vec3(c.r, c.g, c.b), 0.0f, 1e6f);
  }

  static float roughness(const aiMaterial& from) {
    float value = 1.0f;
    if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, value) == AI_SUCCESS && std::isfinite(value))
      return std::clamp(value, 0.0f, 1.0f);
    const glm::vec3 specular = color(from, AI_MATKEY_COLOR_SPECULAR, glm::vec3(0.0f));
    float exponent = 0.0f;
    if (specular == glm::vec3(0.0f) || from.Get(AI_MATKEY_SHININESS, exponent) != AI_SUCCESS ||
        !(exponent > 0.0f))
      return 1.0f;
    return std::clamp(std::pow(2.0f / (exponent + 2.0f), 0.25f), 0.0f, 1.0f);
  }

  static Wrap wrapOf(const aiMaterial& from, aiTextureType type, bool u) {
    int mode = aiTextureMapMode_Wrap;
    from.Get(u ? "$tex.mapmodeu" : "$tex.mapmodev", static_cast<unsigned>(type), 0, mode);
    return mode == aiTextureMapMode_Clamp    ? Wrap::kClampToEdge
           : mode == aiTextureMapMode_Mirror ? Wrap::kMirroredRepeat
                                             : Wrap::kRepeat;
  }

  TextureSlot slot(const aiMaterial& from, std::initializer_list<aiTextureType> types) {
    TextureSlot out;
    for (const aiTextureType type : types) {
      aiString path;
      if (from.GetTexture(type, 0, &path) != AI_SUCCESS || path.length == 0) continue;
      out.texture = textureOf(path);
      int uv_set = 0;
      from.Get(AI_MATKEY_UVWSRC(type, 0), uv_set);
      out.uv_set = std::clamp(uv_set, 0, AI_MAX_NUMBER_OF_TEXTURECOORDS - 1);
      out.wrap_u = wrapOf(from, type, true), out.wrap_v = wrapOf(from, type, false);
      break;
    }
    return out;
  }

  int textureOf(const aiString& path) {
    const std::string name = path.C_Str();
    const auto known = textures_.find(name);
    if (known != textures_.end()) return known->second;
    Texture texture;
    texture.name = name;
    if (const aiTexture* embedded = source_.GetEmbeddedTexture(name.c_str()); embedded && embedded->pcData) {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
      if (embedded->mHeight == 0) {
        texture.rgba.assign(bytes, bytes + embedded->mWidth);
      } else {
        texture.width = static_cast<int>(embedded->mWidth),
        texture.height = static_cast<int>(embedded->mHeight);
        for (std::size_t i = 0; i < std::size_t(embedded->mWidth) * embedded->mHeight; ++i) {
          const aiTexel& texel = embedded->pcData[i];
          texture.rgba.insert(texture.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
        }
      }
    }
    scene_.textures.push_back(std::move(texture));
    return textures_[name] = static_cast<int>(scene_.textures.size()) - 1;
  }

  const aiScene& source_;
  Scene& scene_;
  std::map<std::string, int> textures_;
};

}  // namespace

void readAssimpMaterials(const aiScene& source, bool scan, Scene& scene) {
  MaterialReader reader(source, scene);
  for (unsigned i = 0; i < source.mNumMaterials; ++i)
    scene.materials.push_back(reader.read(*source.mMaterials[i], scan));
  if (scene.materials.empty()) scene.materials.emplace_back().double_sided = true;
  // Vertex colours are the colour; a grey would darken them.
  for (unsigned i = 0; scan && i < source.mNumMeshes; ++i)
    if (source.mMeshes[i]->mColors[0] && source.mMeshes[i]->mMaterialIndex < scene.materials.size())
      scene.materials[source.mMeshes[i]->mMaterialIndex].base_color = glm::vec4(1.0f);
}

}  // namespace gloam

#endif
