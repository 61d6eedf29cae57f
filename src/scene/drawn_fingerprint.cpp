// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/drawn_fingerprint.h"

namespace gloam {
namespace {

// 0 and -0 stand at the same place.
template <class Vector>
Vector withoutSignOfZero(const Vector& place) {
  return place + Vector(0.0f);
}
glm::mat4 withoutSignOfZero(glm::mat4 place) {
  for (int column = 0; column < 4; ++column) place[column] += glm::vec4(0.0f);
  return place;
}

Fingerprint drawn(const Texture& texture) {
  const auto& [name, width, height, rgba] = texture;
  Fingerprint print;
  addAll(print, width, height, rgba);
  return print;
}

// By its pixels: files order textures by their use, and leave out what nothing shows.
void addDrawn(Fingerprint& print, const TextureSlot& slot, const std::vector<Fingerprint>& textures) {
  const auto& [texture, uv_set, wrap_u, wrap_v, nearest, texture_from_uv] = slot;
  add(print, bool(slot));
  if (!slot) return;
  const Fingerprint& pixels = textures[std::size_t(texture)];
  addAll(print, pixels.words[0], pixels.words[1], uv_set, wrap_u, wrap_v, nearest, texture_from_uv);
}

void addDrawn(Fingerprint& print, const Material& material, const std::vector<Fingerprint>& textures) {
  const auto& [name, base_color, metallic, roughness, specular, emission, normal_scale, occlusion_strength,
               alpha_mask, alpha_cutoff, double_sided, base_color_map, metallic_roughness_map, normal_map,
               occlusion_map, emission_map] = material;
  addAll(print, base_color, metallic, roughness, specular, emission, alpha_mask, double_sided);
  if (normal_map) add(print, normal_scale);
  if (alpha_mask) add(print, alpha_cutoff);
  for (const TextureSlot* slot : {&base_color_map, &metallic_roughness_map, &normal_map, &emission_map}) {
    addDrawn(print, *slot, textures);
  }
}

// Tangents carry nothing without a normal map, nor do coordinates without any, and files leave them out there.
void addDrawn(Fingerprint& print, const Mesh& mesh, const Material& material) {
  addAll(print, mesh.positions, mesh.normals);
  if (material.normal_map) add(print, mesh.tangents);
  if (material.base_color_map || material.metallic_roughness_map || material.normal_map ||
      material.emission_map) {
    add(print, mesh.uv_sets.size());
    for (const auto& uv_set : mesh.uv_sets) add(print, uv_set);
  }
  addAll(print, mesh.colors, mesh.indices, mesh.material);
}

void addDrawn(Fingerprint& print, const Instance& instance) {
  const auto& [mesh, node, world_from_object, deformed_positions, deformed_normals, deformed_tangents] =
      instance;
  addAll(print, mesh, withoutSignOfZero(world_from_object), deformed_positions, deformed_normals);
}

void addDrawn(Fingerprint& print, const PosedLight& posed) {
  const auto& [name, type, intensity, range, inner_cone_rad, outer_cone_rad] = posed.light;
  addAll(print, type, intensity, range, inner_cone_rad, outer_cone_rad, withoutSignOfZero(posed.position),
         withoutSignOfZero(posed.direction));
}

template <class T>
void addEach(Fingerprint& print, const std::vector<T>& values) {
  add(print, values.size());
  for (const T& value : values) addDrawn(print, value);
}

}  // namespace

Fingerprint drawnFingerprint(const Scene& scene, const PosedScene& posed) {
  Fingerprint print;
  std::vector<Fingerprint> textures;
  textures.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) textures.push_back(drawn(texture));
  add(print, scene.materials.size());
  for (const Material& material : scene.materials) addDrawn(print, material, textures);
  add(print, scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) addDrawn(print, mesh, scene.materials[std::size_t(mesh.material)]);
  addEach(print, posed.instances);
  addEach(print, posed.lights);
  return print;
}

Fingerprint drawnFingerprint(const Environment& environment) {
  Fingerprint print;
  if (environment.empty()) return print;
  addAll(print, environment.width, environment.height, environment.radiance, environment.rotation_rad,
         environment.intensity);
  return print;
}

Fingerprint drawnFingerprint(const PosedCamera& posed) {
  Fingerprint print;
  const auto& [name, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far] = posed.camera;
  addAll(print, perspective, vertical_fov_rad, aspect, half_height, z_near, z_far,
         withoutSignOfZero(posed.world_from_view));
  return print;
}

}  // namespace gloam
