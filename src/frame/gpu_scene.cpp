// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Uploading what does not change: all meshes' vertices end to end in one buffer an attribute.
#include "frame/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace gloam::frame {

namespace {

/// Vertices of all meshes, as the shaders pull them.
struct VertexArrays {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> uvs;
  std::vector<glm::uvec2> colors;
  std::vector<std::uint32_t> indices;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Where the texture coordinates of each slot, and of the lightmap, begin; sets that they share are stored once.
glm::uvec4 appendUvs(VertexArrays& arrays, const Mesh& mesh, const Material& material,
                     std::uint32_t& first_lightmap_uv) {
  std::vector<std::uint32_t> first_of_set(mesh.uv_sets.size(), kAbsent);
  glm::uvec4 first(kAbsent);
  const auto firstOf = [&](int uv_set) {
    if (uv_set < 0 || std::size_t(uv_set) >= mesh.uv_sets.size()) return kAbsent;
    const auto& set = mesh.uv_sets[std::size_t(uv_set)];
    if (set.size() != mesh.vertexCount()) return kAbsent;
    std::uint32_t& place = first_of_set[std::size_t(uv_set)];
    if (place == kAbsent) {
      place = static_cast<std::uint32_t>(arrays.uvs.size());
      append(arrays.uvs, set);
    }
    return place;
  };
  const auto slots = textureSlots(material);
  for (int s = 0; s < kTextureSlots; ++s) {
    const TextureSlot& slot = *slots[std::size_t(s)];
    if (slot) first[s] = firstOf(slot.uv_set);
  }
  if (mesh.transfer && mesh.transfer->ofTexels()) first_lightmap_uv = firstOf(mesh.transfer->uv_set);
  return first;
}

std::uint32_t appendColors(VertexArrays& arrays, const Mesh& mesh) {
  if (mesh.colors.size() != mesh.vertexCount() || mesh.colors.empty()) return kAbsent;
  const auto first = static_cast<std::uint32_t>(arrays.colors.size());
  for (const glm::vec4& c : mesh.colors) {
    arrays.colors.emplace_back(glm::packUnorm2x16(glm::vec2(c.x, c.y)),
                               glm::packUnorm2x16(glm::vec2(c.z, c.w)));
  }
  return first;
}

GpuMesh appendMesh(VertexArrays& arrays, const Mesh& mesh, const Material& material) {
  const std::string place = "mesh '" + mesh.name + "'";
  if (mesh.normals.size() != mesh.vertexCount())
    throw Error(place, fmt::format("{} normals for {} vertices", mesh.normals.size(), mesh.vertexCount()));
  GpuMesh result;
  result.name = mesh.name;
  result.vertex_count = static_cast<std::uint32_t>(mesh.vertexCount());
  result.index_count = static_cast<std::uint32_t>(mesh.indices.size() / 3 * 3);
  result.alpha_mask = material.alpha_mask;
  const auto slots = textureSlots(material);
  result.textured =
      std::any_of(slots.begin(), slots.end(), [](const TextureSlot* slot) { return bool(*slot); });
  result.vertex_colors = mesh.colors.size() == mesh.vertexCount();
  result.transfer = mesh.transfer;
  result.row.first_vertex = static_cast<std::uint32_t>(arrays.positions.size());
  result.row.first_index = static_cast<std::uint32_t>(arrays.indices.size());
  result.row.material = static_cast<std::uint32_t>(mesh.material);
  result.row.first_color = appendColors(arrays, mesh);
  result.row.first_uv = appendUvs(arrays, mesh, material, result.first_lightmap_uv);
  result.bounds_min = glm::vec3(std::numeric_limits<float>::max());
  result.bounds_max = -result.bounds_min;
  for (const glm::vec3& p : mesh.positions) {
    result.bounds_min = glm::min(result.bounds_min, p);
    result.bounds_max = glm::max(result.bounds_max, p);
  }
  append(arrays.positions, mesh.positions);
  append(arrays.normals, mesh.normals);
  append(arrays.tangents, mesh.tangents);
  arrays.tangents.resize(arrays.positions.size(), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  append(arrays.indices, mesh.indices);
  return result;
}

MaterialRow rowOf(const Material& material) {
  MaterialRow row{};
  row.base_color = material.base_color;
  row.emission = material.emission;
  row.metallic = material.metallic;
  row.roughness = material.roughness;
  row.specular = material.specular;
  row.normal_scale = material.normal_scale;
  row.alpha_cutoff = material.alpha_cutoff;
  row.flags = material.normal_map ? kMaterialNormalMap : 0u;
  const auto slots = textureSlots(material);
  for (int s = 0; s < kTextureSlots; ++s) {
    const glm::mat3& m = slots[std::size_t(s)]->texture_from_uv;
    row.texture_from_uv[s] = glm::vec4(m[0][0], m[0][1], m[1][0], m[1][1]);
    row.texture_offset[s] = glm::vec2(m[2][0], m[2][1]);
  }
  return row;
}

}  // namespace

GpuScene::GpuScene(gpu::Device& device, const Scene& scene)
    : device_(device), textures_(device, scene), carriers_(scene), volume_places_(scene) {
  VertexArrays arrays;
  std::vector<MeshRow> rows;
  for (const Mesh& mesh : scene.meshes) {
    meshes_.push_back(appendMesh(arrays, mesh, scene.materials[std::size_t(mesh.material)]));
    rows.push_back(meshes_.back().row);
  }
  std::vector<std::byte> materials(scene.materials.size() * kMaterialStride);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const MaterialRow row = rowOf(scene.materials[i]);
    std::memcpy(&materials[i * kMaterialStride], &row, sizeof(row));
  }
  static_vertices_ = static_cast<std::uint32_t>(arrays.positions.size());
  positions_ = gpu::Buffer(device, "frame.positions", arrays.positions);
  normals_ = gpu::Buffer(device, "frame.normals", arrays.normals);
  tangents_ = gpu::Buffer(device, "frame.tangents", arrays.tangents);
  uvs_ = gpu::Buffer(device, "frame.uvs", arrays.uvs);
  colors_ = gpu::Buffer(device, "frame.colors", arrays.colors);
  indices_ = gpu::Buffer(device, "frame.indices", arrays.indices);
  mesh_rows_ = gpu::Buffer(device, "frame.meshes", rows);
  material_rows_ = gpu::Buffer(device, "frame.materials", materials);
}

}  // namespace gloam::frame
