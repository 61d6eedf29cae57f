// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/scene_fingerprint.h"

#include <fmt/format.h>
#include <gloam/lights.h>
#include <gloam/neighbourhood.h>
#include <gloam/volume.h>

#include <bit>
#include <cstring>

namespace gloam {
namespace {

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdu;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53u;
  return x ^ (x >> 33);
}

}  // namespace

void Fingerprint::addBytes(const void* data, std::size_t size) {
  std::uint64_t a = words[0], b = words[1];
  const auto word = [&](std::uint64_t value) {
    a = std::rotl(a ^ (value * 0x87c37b91114253d5u), 31) * 5 + 0x52dce729u;
    b = std::rotl(b + (value * 0x4cf5ad432745937fu), 27) * 0x9fb21c651e98df25u;
  };
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
  words[0] = a;
  words[1] = b;
}

std::string Fingerprint::text() const {
  return fmt::format("{:016x}{:016x}", mixed(words[0] ^ words[1]), mixed(words[1] + 0x9e3779b97f4a7c15u));
}

void add(Fingerprint& print, const std::string& value) {
  print.addBytes(value.data(), value.size());
}

// The overloads below stand in the namespace itself, not in a nameless one: templates find them by their argument's.

template <class T>
static void add(Fingerprint& print, const std::optional<T>& value) {
  add(print, value.has_value());
  if (value) add(print, *value);
}

template <class T>
requires(!PlainValue<T>) static void add(Fingerprint& print, const std::vector<T>& values) {
  add(print, values.size());
  for (const T& value : values) add(print, value);
}

static void add(Fingerprint& print, const Texture& texture) {
  const auto& [name, width, height, rgba] = texture;
  addAll(print, name, width, height, rgba);
}

static void add(Fingerprint& print, const TextureSlot& slot) {
  const auto& [texture, uv_set, wrap_u, wrap_v, nearest, texture_from_uv] = slot;
  addAll(print, texture, uv_set, wrap_u, wrap_v, nearest, texture_from_uv);
}

static void add(Fingerprint& print, const Material& material) {
  const auto& [name, base_color, metallic, roughness, specular, emission, normal_scale, occlusion_strength,
               alpha_mask, alpha_cutoff, double_sided, base_color_map, metallic_roughness_map, normal_map,
               occlusion_map, emission_map] = material;
  addAll(print, name, base_color, metallic, roughness, specular, emission, normal_scale, occlusion_strength,
         alpha_mask, alpha_cutoff, double_sided, base_color_map, metallic_roughness_map, normal_map,
         occlusion_map, emission_map);
}

static void add(Fingerprint& print, const MorphTarget& target) {
  const auto& [positions, normals, tangents] = target;
  addAll(print, positions, normals, tangents);
}

static void add(Fingerprint& print, const GlossyTransfer& glossy) {
  const auto& [light_order, field_order, exponent, visibility, indirect] = glossy;
  addAll(print, light_order, field_order, exponent, visibility, indirect);
}

static void add(Fingerprint& print, const Transfer& transfer) {
  // What it was expanded from says nothing more.
  const auto& [order, bounces, directions, object, direct, indirect, glossy, texel_width, texel_height, uv_set,
               compressed] = transfer;
  addAll(print, order, bounces, directions, object, direct, indirect, glossy, texel_width, texel_height, uv_set);
}

static void add(Fingerprint& print, const sh::ShRgb& light) {
  addAll(print, light.order);
  print.addBytes(light.c.data(), sizeof light.c);
}

static void add(Fingerprint& print, const NeighbourhoodTransfer& transfer) {
  const auto& [centre, spacing, core, growth, size, light_order, field_order, bounces, visibility, indirect] =
      transfer;
  addAll(print, centre, spacing, core, growth, size, light_order, field_order, bounces, visibility, indirect);
}

static void add(Fingerprint& print, const Volume& volume) {
  const auto& [name, size, bounds_min, bounds_max, density, albedo, asymmetry, transfer] = volume;
  addAll(print, name, size, bounds_min, bounds_max, density, albedo, asymmetry, transfer != nullptr);
  if (transfer) add(print, *transfer);
}

static void add(Fingerprint& print, const Mesh& mesh) {
  const auto& [name, positions, normals, tangents, uv_sets, colors, influences, joints, weights,
               morph_targets, indices, material, transfer] = mesh;
  addAll(print, name, positions, normals, tangents, uv_sets, colors, influences, joints, weights,
         morph_targets, indices, material, transfer != nullptr);
  if (transfer) add(print, *transfer);
}

static void add(Fingerprint& print, const Camera& camera) {
  const auto& [name, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far] = camera;
  addAll(print, name, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far);
}

static void add(Fingerprint& print, const Light& light) {
  const auto& [name, type, intensity, range, inner_cone_rad, outer_cone_rad] = light;
  addAll(print, name, type, intensity, range, inner_cone_rad, outer_cone_rad);
}

static void add(Fingerprint& print, const Skin& skin) {
  const auto& [joints, joint_from_mesh] = skin;
  addAll(print, joints, joint_from_mesh);
}

static void add(Fingerprint& print, const Node& node) {
  const auto& [name, parent, children, translation, rotation, scale, matrix, meshes, skin, camera, light,
               morph_weights, instances, neighbourhood, volume] = node;
  addAll(print, name, parent, children, translation, rotation, scale, matrix, meshes, skin, camera, light,
         morph_weights, instances, neighbourhood != nullptr, volume != nullptr);
  if (neighbourhood) add(print, *neighbourhood);
  if (volume) add(print, *volume);
}

static void add(Fingerprint& print, const AnimationChannel& channel) {
  const auto& [node, path, interpolation, times_s, values, components] = channel;
  addAll(print, node, path, interpolation, times_s, values, components);
}

static void add(Fingerprint& print, const Animation& animation) {
  const auto& [name, channels] = animation;
  addAll(print, name, channels);
}

static void add(Fingerprint& print, const Instance& instance) {
  const auto& [mesh, node, world_from_object, deformed_positions, deformed_normals, deformed_tangents] =
      instance;
  addAll(print, mesh, node, world_from_object, deformed_positions, deformed_normals, deformed_tangents);
}

static void add(Fingerprint& print, const PosedLight& posed) {
  const auto& [light, position, direction] = posed;
  addAll(print, light, position, direction);
}

void add(Fingerprint& print, const PosedCamera& posed) {
  const auto& [camera, world_from_view] = posed;
  addAll(print, camera, world_from_view);
}

void add(Fingerprint& print, const PosedScene& posed) {
  const auto& [time_s, instances, cameras, lights, bounds_min, bounds_max] = posed;
  addAll(print, time_s, instances, cameras, lights, bounds_min, bounds_max);
}

void add(Fingerprint& print, const Environment& environment) {
  const auto& [name, width, height, radiance, rotation_rad, intensity, warnings, lights] = environment;
  addAll(print, name, width, height, radiance, rotation_rad, intensity, lights != nullptr);
  if (lights) add(print, lights->sh);
}

void add(Fingerprint& print, const Scene& scene) {
  const auto& [name, textures, materials, meshes, nodes, roots, cameras, lights, skins, animations,
               environment, warnings] = scene;
  addAll(print, name, textures, materials, meshes, nodes, roots, cameras, lights, skins, animations);
}

}  // namespace gloam
