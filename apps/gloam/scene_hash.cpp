// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Every struct is taken apart by a structured binding that names all its members: one more member, and this file does not
// compile until it is hashed too. Two multiply-and-rotate lanes over 64-bit words with a final mix (the 64-bit finaliser of
// MurmurHash3); not meant against an adversary, who could write into the cache anyway.
#include "scene_hash.h"

#include <fmt/core.h>

#include <bit>
#include <cstring>
#include <type_traits>

namespace gloam::cli {
namespace {

class Hash {
 public:
  void bytes(const void* data, std::size_t size) {
    word(size);
    const auto* at = static_cast<const unsigned char*>(data);
    for (; size >= 8; at += 8, size -= 8) {
      std::uint64_t value;
      std::memcpy(&value, at, 8);
      word(value);
    }
    std::uint64_t rest = 0;
    if (size > 0) std::memcpy(&rest, at, size);
    word(rest);
  }

  std::string text() const {
    return fmt::format("{:016x}{:016x}", mixed(a_ ^ b_), mixed(b_ + 0x9e3779b97f4a7c15u));
  }

 private:
  void word(std::uint64_t value) {
    a_ = std::rotl(a_ ^ (value * 0x87c37b91114253d5u), 31) * 5 + 0x52dce729u;
    b_ = std::rotl(b_ + (value * 0x4cf5ad432745937fu), 27) * 0x9fb21c651e98df25u;
  }
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdu;
    x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53u;
    return x ^ (x >> 33);
  }

  std::uint64_t a_ = 0x243f6a8885a308d3u, b_ = 0x13198a2e03707344u;  // digits of pi
};

/// Types whose bytes are their value: no padding, no pointers.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, glm::vec2> ||
    std::is_same_v<T, glm::vec3> || std::is_same_v<T, glm::vec4> || std::is_same_v<T, glm::quat> ||
    std::is_same_v<T, glm::mat3> || std::is_same_v<T, glm::mat4>;

template <Plain T>
void add(Hash& hash, const T& value) {
  hash.bytes(&value, sizeof value);
}

void add(Hash& hash, const std::string& value) {
  hash.bytes(value.data(), value.size());
}

template <class T>
void add(Hash& hash, const std::optional<T>& value) {
  add(hash, value.has_value());
  if (value) add(hash, *value);
}

template <Plain T>
void add(Hash& hash, const std::vector<T>& values) {
  hash.bytes(values.data(), values.size() * sizeof(T));
}

template <class... Members>
void addAll(Hash& hash, const Members&... members);

void add(Hash& hash, const Texture& texture) {
  const auto& [name, width, height, rgba] = texture;
  addAll(hash, name, width, height, rgba);
}

void add(Hash& hash, const TextureSlot& slot) {
  const auto& [texture, uv_set, wrap_u, wrap_v, nearest, texture_from_uv] = slot;
  addAll(hash, texture, uv_set, wrap_u, wrap_v, nearest, texture_from_uv);
}

void add(Hash& hash, const Material& material) {
  const auto& [name, base_color, metallic, roughness, specular, emission, normal_scale, occlusion_strength,
               alpha_mask, alpha_cutoff, double_sided, base_color_map, metallic_roughness_map, normal_map,
               occlusion_map, emission_map] = material;
  addAll(hash, name, base_color, metallic, roughness, specular, emission, normal_scale, occlusion_strength,
         alpha_mask, alpha_cutoff, double_sided, base_color_map, metallic_roughness_map, normal_map,
         occlusion_map, emission_map);
}

void add(Hash& hash, const MorphTarget& target) {
  const auto& [positions, normals, tangents] = target;
  addAll(hash, positions, normals, tangents);
}

void add(Hash& hash, const Transfer& transfer) {
  const auto& [order, bounces, directions, direct, indirect] = transfer;
  addAll(hash, order, bounces, directions, direct, indirect);
}

void add(Hash& hash, const Mesh& mesh) {
  const auto& [name, positions, normals, tangents, uv_sets, colors, influences, joints, weights,
               morph_targets, indices, material, transfer] = mesh;
  addAll(hash, name, positions, normals, tangents, uv_sets, colors, influences, joints, weights,
         morph_targets, indices, material, transfer != nullptr);
  if (transfer) add(hash, *transfer);
}

void add(Hash& hash, const Camera& camera) {
  const auto& [name, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far] = camera;
  addAll(hash, name, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far);
}

void add(Hash& hash, const Light& light) {
  const auto& [name, type, intensity, range, inner_cone_rad, outer_cone_rad] = light;
  addAll(hash, name, type, intensity, range, inner_cone_rad, outer_cone_rad);
}

void add(Hash& hash, const Skin& skin) {
  const auto& [joints, joint_from_mesh] = skin;
  addAll(hash, joints, joint_from_mesh);
}

void add(Hash& hash, const Node& node) {
  const auto& [name, parent, children, translation, rotation, scale, matrix, meshes, skin, camera, light,
               morph_weights, instances] = node;
  addAll(hash, name, parent, children, translation, rotation, scale, matrix, meshes, skin, camera, light,
         morph_weights, instances);
}

void add(Hash& hash, const AnimationChannel& channel) {
  const auto& [node, path, interpolation, times_s, values, components] = channel;
  addAll(hash, node, path, interpolation, times_s, values, components);
}

void add(Hash& hash, const Animation& animation);

template <class T>
requires(!Plain<T>) void add(Hash& hash, const std::vector<T>& values) {
  add(hash, values.size());
  for (const T& value : values) add(hash, value);
}

template <class... Members>
void addAll(Hash& hash, const Members&... members) {
  (add(hash, members), ...);
}

void add(Hash& hash, const Animation& animation) {
  const auto& [name, channels] = animation;
  addAll(hash, name, channels);
}

}  // namespace

std::string bakeKey(const Scene& scene, const BakeOptions& options) {
  Hash hash;
  const auto& [name, textures, materials, meshes, nodes, roots, cameras, lights, skins, animations,
               environment, warnings] = scene;
  addAll(hash, std::string(GLOAM_VERSION), name, textures, materials, meshes, nodes, roots, cameras, lights,
         skins, animations);
  const auto& [kind, order, bounces, directions, bounce_directions, threads, time_s, checkpoint] = options;
  addAll(hash, kind, order, bounces, directions, bounce_directions, time_s);
  return hash.text();
}

}  // namespace gloam::cli
