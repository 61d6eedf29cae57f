// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// assimp's scene in our terms. Lengths and indices of what assimp hands over are checked, as broken files get through it.
#include <fmt/format.h>

#include "scene/assimp_read.h"

#if GLOAM_HAS_ASSIMP
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <new>
#include <string_view>
#include <unordered_map>

#include "scene/assimp_parts.h"

namespace gloam {
namespace {

/// Vertices that agree in everything become one: .obj comes with a vertex for every corner.
void weldIdentical(Mesh& mesh) {
  const std::size_t n = mesh.vertexCount();
  const auto keyOf = [&](std::size_t i) {
    std::string key;
    const auto add = [&](const auto& array) {
      if (!array.empty()) key.append(reinterpret_cast<const char*>(&array[i]), sizeof array[i]);
    };
    add(mesh.positions), add(mesh.normals), add(mesh.colors);
    for (const auto& uv : mesh.uv_sets) add(uv);
    return key;
  };
  std::unordered_map<std::string, std::uint32_t> known;
  known.reserve(n);
  std::vector<std::uint32_t> target(n), source;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto [at, is_new] = known.emplace(keyOf(i), static_cast<std::uint32_t>(source.size()));
    if (is_new) source.push_back(i);
    target[i] = at->second;
  }
  if (source.size() == n) return;
  remapVertices(mesh, source);
  for (std::uint32_t& index : mesh.indices) index = target[index];
}

/// The strongest influences of each vertex, eight at most.
void readBones(const aiMesh& source, const AssimpNodes& nodes, Mesh& mesh, Skin& skin) {
  constexpr std::size_t kMost = 8;
  std::vector<std::vector<std::pair<float, std::uint16_t>>> of_vertex(mesh.vertexCount());
  for (unsigned b = 0; b < source.mNumBones && skin.joints.size() < 0xffff; ++b) {
    const aiBone& bone = *source.mBones[b];
    const auto node = nodes.by_name.find(bone.mName.C_Str());
    if (node == nodes.by_name.end()) continue;
    const auto joint = static_cast<std::uint16_t>(skin.joints.size());
    skin.joints.push_back(node->second);
    skin.joint_from_mesh.push_back(toGlm(bone.mOffsetMatrix));
    for (unsigned w = 0; w < bone.mNumWeights; ++w)
      if (bone.mWeights[w].mVertexId < of_vertex.size() && std::isfinite(bone.mWeights[w].mWeight))
        of_vertex[bone.mWeights[w].mVertexId].emplace_back(bone.mWeights[w].mWeight, joint);
  }
  if (skin.joints.empty()) return;
  std::size_t most = 1;
  for (auto& list : of_vertex) {
    std::sort(list.begin(), list.end(), std::greater<>());
    if (list.size() > kMost) list.resize(kMost);
    most = std::max(most, list.size());
  }
  const std::size_t influences = most <= 4 ? 4 : kMost;
  mesh.influences = static_cast<int>(influences);
  mesh.joints.assign(of_vertex.size() * influences, 0);
  mesh.weights.assign(of_vertex.size() * influences, 0.0f);
  for (std::size_t i = 0; i < of_vertex.size(); ++i)
    for (std::size_t k = 0; k < of_vertex[i].size(); ++k) {
      mesh.weights[i * influences + k] = of_vertex[i][k].first;
      mesh.joints[i * influences + k] = of_vertex[i][k].second;
    }
}

float linearFromSrgb(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

Mesh readMesh(const aiMesh& source, bool colors_are_srgb) {
  Mesh mesh;
  mesh.name = source.mName.C_Str();
  mesh.material = static_cast<int>(source.mMaterialIndex);
  const std::size_t n = source.mNumVertices;
  for (std::size_t i = 0; source.mVertices && i < n; ++i)
    mesh.positions.push_back(toGlm(source.mVertices[i]));
  for (std::size_t i = 0; source.mNormals && i < n; ++i) mesh.normals.push_back(toGlm(source.mNormals[i]));
  for (std::size_t i = 0; source.mColors[0] && i < n; ++i) {
    const aiColor4D& c = source.mColors[0][i];
    glm::vec4 color(c.r, c.g, c.b, c.a);
    for (int k = 0; k < 4; ++k) color[k] = std::isfinite(color[k]) ? std::clamp(color[k], 0.0f, 1.0f) : 1.0f;
    for (int k = 0; colors_are_srgb && k < 3; ++k) color[k] = linearFromSrgb(color[k]);
    mesh.colors.push_back(color);
  }
  for (int set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS && source.mTextureCoords[set]; ++set) {
    auto& uv = mesh.uv_sets.emplace_back();
    for (std::size_t i = 0; i < n; ++i) {
      const aiVector3D& t = source.mTextureCoords[set][i];
      const bool good = std::abs(t.x) < 1e6f && std::abs(t.y) < 1e6f;     // also false for NaN
      uv.push_back(good ? glm::vec2(t.x, 1.0f - t.y) : glm::vec2(0.0f));  // assimp's v is up
    }
  }
  for (unsigned f = 0; f < source.mNumFaces; ++f) {
    const aiFace& face = source.mFaces[f];
    if (face.mNumIndices != 3) continue;
    const unsigned* corner = face.mIndices;
    if (std::max({corner[0], corner[1], corner[2]}) >= mesh.positions.size())
      throw Error(fmt::format("mesh '{}': face {} names a vertex that is not there", mesh.name, f));
    mesh.indices.insert(mesh.indices.end(), corner, corner + 3);
  }
  return mesh;
}

void readMeshes(const aiScene& source, bool colors_are_srgb, const AssimpNodes& nodes, Scene& scene) {
  for (unsigned i = 0; i < source.mNumMeshes; ++i) {
    Mesh mesh = readMesh(*source.mMeshes[i], colors_are_srgb);
    Skin skin;
    if (source.mMeshes[i]->mNumBones > 0)
      readBones(*source.mMeshes[i], nodes, mesh, skin);
    else
      weldIdentical(mesh);
    const int index = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    for (const int user : nodes.users_of_mesh.at(i)) {
      int shown_by = user;
      if (!skin.joints.empty()) {  // one skin a node: skinned meshes get a node each
        shown_by = static_cast<int>(scene.nodes.size());
        scene.nodes.emplace_back().parent = user;
        scene.nodes[static_cast<std::size_t>(user)].children.push_back(shown_by);
        scene.nodes.back().skin = static_cast<int>(scene.skins.size());
      }
      scene.nodes[static_cast<std::size_t>(shown_by)].meshes.push_back(index);
    }
    if (!skin.joints.empty()) scene.skins.push_back(std::move(skin));
    if (source.mMeshes[i]->mNumAnimMeshes > 0)
      scene.warnings.push_back(
          fmt::format("mesh '{}': morph targets are left out", scene.meshes.back().name));
  }
}

/// What assimp says, in words that tell what to do about it where it has none.
std::string plainWords(const std::string& said) {
  if (said.find("No meshes remaining") != std::string::npos) return "it holds no triangles: expected faces";
  return "assimp cannot read it: " + said;
}

/// Text of 16-bit characters, which assimp takes for something else; its importers expect one byte a character.
void refuseWideText(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  char mark[2] = {};
  in.read(mark, 2);
  const std::string_view read(mark, std::size_t(in.gcount()));
  if (read == "\xff\xfe" || read == "\xfe\xff")
    throw Error(path.string(), "is UTF-16 text; expected ASCII or UTF-8");
}

}  // namespace

Scene importWithAssimp(const std::filesystem::path& path) {
  refuseWideText(path);
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType;
  if (extension == ".fbx") steps |= aiProcess_GlobalScale;  // to metres, by the unit that the file names
  const aiScene* source = importer.ReadFile(path.string(), steps);
  // assimp turns it into text.
  if (!source && std::string_view(importer.GetErrorString()).find("bad_alloc") != std::string_view::npos)
    throw std::bad_alloc();
  if (!source) throw Error(path.string(), plainWords(importer.GetErrorString()));
  if (!source->mRootNode) throw Error(path.string(), "assimp found nothing in it");
  const bool scan = extension == ".ply" || extension == ".off";
  Scene scene;
  try {
    readAssimpMaterials(*source, scan, scene);
    const AssimpNodes nodes = readAssimpNodes(*source, scene);
    readMeshes(*source, scan, nodes, scene);
    readAssimpCamerasAndLights(*source, nodes, scene);
    readAssimpAnimations(*source, nodes, scene);
  } catch (const Error& error) {
    throw Error(path.string(), error.what());
  }
  return scene;
}

}  // namespace gloam

#endif
