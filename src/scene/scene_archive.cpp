// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/scene_archive.h"

#include <cstring>
#include <type_traits>

namespace gloam {
namespace {

/// Says once which members travel, for both directions.
template <typename Archive>
void fields(Archive& a, TextureSlot& v) {
  a(v.texture, v.uv_set, v.wrap_u, v.wrap_v, v.nearest, v.texture_from_uv);
}
template <typename Archive>
void fields(Archive& a, Texture& v) {
  a(v.name, v.width, v.height, v.rgba);
}
template <typename Archive>
void fields(Archive& a, Material& v) {
  a(v.name, v.base_color, v.metallic, v.roughness, v.specular, v.emission, v.normal_scale, v.occlusion_strength,
    v.alpha_mask, v.alpha_cutoff, v.double_sided, v.base_color_map, v.metallic_roughness_map, v.normal_map,
    v.occlusion_map, v.emission_map);
}
template <typename Archive>
void fields(Archive& a, MorphTarget& v) {
  a(v.positions, v.normals, v.tangents);
}
template <typename Archive>
void fields(Archive& a, Mesh& v) {
  a(v.name, v.positions, v.normals, v.tangents, v.uv_sets, v.colors, v.influences, v.joints, v.weights,
    v.morph_targets, v.indices, v.material);
}
template <typename Archive>
void fields(Archive& a, Camera& v) {
  a(v.name, v.perspective, v.vertical_fov_rad, v.aspect, v.half_height, v.z_near, v.z_far);
}
template <typename Archive>
void fields(Archive& a, Light& v) {
  a(v.name, v.type, v.intensity, v.range, v.inner_cone_rad, v.outer_cone_rad);
}
template <typename Archive>
void fields(Archive& a, Skin& v) {
  a(v.joints, v.joint_from_mesh);
}
template <typename Archive>
void fields(Archive& a, Node& v) {
  bool has_matrix = v.matrix.has_value();
  glm::mat4 matrix = v.matrix.value_or(glm::mat4(1.0f));
  a(v.name, v.parent, v.children, v.translation, v.rotation, v.scale, has_matrix, matrix, v.meshes, v.skin,
    v.camera, v.light, v.morph_weights, v.instances);
  v.matrix = has_matrix ? std::optional(matrix) : std::nullopt;
}
template <typename Archive>
void fields(Archive& a, AnimationChannel& v) {
  a(v.node, v.path, v.interpolation, v.times_s, v.values, v.components);
}
template <typename Archive>
void fields(Archive& a, Animation& v) {
  a(v.name, v.channels);
}
template <typename Archive>
void fields(Archive& a, Scene& v) {
  a(v.name, v.textures, v.materials, v.meshes, v.nodes, v.roots, v.cameras, v.lights, v.skins, v.animations,
    v.warnings);
}

template <typename T>
inline constexpr bool kPlain = std::is_trivially_copyable_v<T> && !std::is_same_v<T, TextureSlot>;

class Packer {
 public:
  std::vector<std::uint8_t> bytes;
  template <typename... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  void raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    std::memcpy(&bytes[at], data, size);
  }
  void one(std::string& s) {
    std::uint64_t size = s.size();
    raw(&size, sizeof size), raw(s.data(), s.size());
  }
  template <typename T>
  void one(std::vector<T>& v) {
    std::uint64_t size = v.size();
    raw(&size, sizeof size);
    if constexpr (kPlain<T>)
      raw(v.data(), v.size() * sizeof(T));
    else
      for (T& value : v) one(value);
  }
  template <typename T>
  void one(T& value) {
    if constexpr (kPlain<T>)
      raw(&value, sizeof value);
    else
      fields(*this, value);
  }
};

class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <typename... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  void raw(void* data, std::uint64_t size) {
    if (size > bytes_.size()) throw Error("import: the scene that came back is cut off");
    if (size) std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  /// A size that the rest of the bytes cannot hold is wrong.
  std::uint64_t size(std::size_t bytes_each) {
    std::uint64_t count = 0;
    raw(&count, sizeof count);
    if (count > bytes_.size() / bytes_each) throw Error("import: the scene that came back is cut off");
    return count;
  }
  void one(std::string& s) {
    s.resize(size(1));
    raw(s.data(), s.size());
  }
  /// Any bits but 0 and 1 in a bool are undefined behaviour.
  void one(bool& value) {
    std::uint8_t byte = 0;
    raw(&byte, 1);
    value = byte != 0;
  }
  template <typename T>
  void one(std::vector<T>& v) {
    v.resize(size(kPlain<T> ? sizeof(T) : sizeof(std::uint64_t)));  // others hold at least one size
    if constexpr (kPlain<T>)
      raw(v.data(), v.size() * sizeof(T));
    else
      for (T& value : v) one(value);
  }
  template <typename T>
  void one(T& value) {
    if constexpr (kPlain<T>)
      raw(&value, sizeof value);
    else
      fields(*this, value);
  }
  std::span<const std::uint8_t> bytes_;
};

}  // namespace

std::vector<std::uint8_t> packScene(Scene& scene) {
  Packer packer;
  fields(packer, scene);
  return std::move(packer.bytes);
}

Scene unpackScene(std::span<const std::uint8_t> bytes) {
  Scene scene;
  Unpacker unpacker(bytes);
  fields(unpacker, scene);
  return scene;
}

}  // namespace gloam
