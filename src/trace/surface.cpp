// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/brdf.h"

namespace gloam::trace {
namespace {

// IEC 61966-2-1.
std::array<float, 256> makeSrgbTable() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    table[std::size_t(i)] = float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return table;
}

int wrapTexel(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::kClampToEdge:
      return std::clamp(i, 0, size - 1);
    case Wrap::kMirroredRepeat: {
      const int period = ((i % (2 * size)) + 2 * size) % (2 * size);
      return period < size ? period : 2 * size - 1 - period;
    }
    case Wrap::kRepeat:
      break;
  }
  return ((i % size) + size) % size;
}

glm::vec4 texel(const Texture& texture, const TextureSlot& slot, int x, int y, bool srgb) {
  static const std::array<float, 256> from_srgb = makeSrgbTable();
  const std::size_t column = std::size_t(wrapTexel(x, texture.width, slot.wrap_u));
  const std::size_t row = std::size_t(wrapTexel(y, texture.height, slot.wrap_v));
  const std::uint8_t* c = &texture.rgba[(row * std::size_t(texture.width) + column) * 4];
  const float alpha = float(c[3]) / 255.0f;
  if (srgb) return {from_srgb[c[0]], from_srgb[c[1]], from_srgb[c[2]], alpha};
  return {float(c[0]) / 255.0f, float(c[1]) / 255.0f, float(c[2]) / 255.0f, alpha};
}

// Coordinates beyond what an int holds are brought back into a few periods first.
float reduce(float coordinate, Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0f;
  if (wrap == Wrap::kClampToEdge) return std::clamp(coordinate, -1.0f, 2.0f);
  return coordinate - 2.0f * std::floor(coordinate * 0.5f);
}

}  // namespace

glm::vec4 sampleTexture(const Scene& scene, const TextureSlot& slot, glm::vec2 uv, bool srgb) {
  if (!slot) return glm::vec4(1.0f);
  const Texture& texture = scene.textures[std::size_t(slot.texture)];
  if (texture.rgba.empty()) return glm::vec4(1.0f);
  const glm::vec3 moved = slot.texture_from_uv * glm::vec3(uv, 1.0f);
  const float x = reduce(moved.x, slot.wrap_u) * float(texture.width);
  const float y = reduce(moved.y, slot.wrap_v) * float(texture.height);
  if (slot.nearest) return texel(texture, slot, int(std::floor(x)), int(std::floor(y)), srgb);
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float fx = x - 0.5f - left, fy = y - 0.5f - top;
  const int x0 = int(left), y0 = int(top);
  const glm::vec4 upper =
      glm::mix(texel(texture, slot, x0, y0, srgb), texel(texture, slot, x0 + 1, y0, srgb), fx);
  const glm::vec4 lower =
      glm::mix(texel(texture, slot, x0, y0 + 1, srgb), texel(texture, slot, x0 + 1, y0 + 1, srgb), fx);
  return glm::mix(upper, lower, fy);
}

glm::vec4 sampleTexture(const Scene& scene, const TextureSlot& slot, const Mesh& mesh,
                        const SurfacePoint& point, bool srgb) {
  if (!slot) return glm::vec4(1.0f);
  const std::size_t set = std::size_t(slot.uv_set);
  const bool has_set = set < mesh.uv_sets.size() && !mesh.uv_sets[set].empty();
  return sampleTexture(scene, slot, has_set ? interpolate(mesh, mesh.uv_sets[set], point) : glm::vec2(0.0f),
                       srgb);
}

glm::vec4 baseColor(const Scene& scene, const Mesh& mesh, const SurfacePoint& point) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  glm::vec4 color = material.base_color * sampleTexture(scene, material.base_color_map, mesh, point, true);
  if (!mesh.colors.empty()) color *= interpolate(mesh, mesh.colors, point);
  return color;
}

glm::vec2 metallicRoughness(const Scene& scene, const Mesh& mesh, const SurfacePoint& point) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  const glm::vec4 map = sampleTexture(scene, material.metallic_roughness_map, mesh, point, false);
  return {material.metallic * map.b, material.roughness * map.g};
}

glm::vec3 emission(const Scene& scene, const Mesh& mesh, const SurfacePoint& point) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  return material.emission * glm::vec3(sampleTexture(scene, material.emission_map, mesh, point, true));
}

MaterialPoint materialAt(const Scene& scene, const Mesh& mesh, const SurfacePoint& point,
                         const SurfacePoint& texture_point) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  MaterialPoint result;
  result.base_color =
      material.base_color * sampleTexture(scene, material.base_color_map, mesh, texture_point, true);
  if (!mesh.colors.empty()) result.base_color *= interpolate(mesh, mesh.colors, point);
  const glm::vec2 factors = metallicRoughness(scene, mesh, texture_point);
  result.metallic = factors.x;
  result.roughness = factors.y;
  result.emission = emission(scene, mesh, texture_point);
  return result;
}

glm::vec3 mappedNormal(const glm::vec3& normal, const glm::vec4& tangent, const glm::vec3& texel,
                       float scale) {
  const glm::vec3 along = glm::vec3(tangent) - normal * glm::dot(normal, glm::vec3(tangent));
  const float squared = glm::dot(along, along);
  if (squared < 1e-12f) return normal;
  const glm::vec3 t = along / std::sqrt(squared);
  const glm::vec3 b = glm::cross(normal, t) * (tangent.w < 0.0f ? -1.0f : 1.0f);
  const glm::vec3 m = (texel * 2.0f - 1.0f) * glm::vec3(scale, scale, 1.0f);
  const glm::vec3 tilted = m.x * t + m.y * b + m.z * normal;
  const float length = glm::length(tilted);
  return length > 0.0f ? tilted / length : normal;
}

glm::vec3 diffuseAlbedo(const Scene& scene, const Mesh& mesh, const SurfacePoint& point) {
  const float metallic = metallicRoughness(scene, mesh, point).x;
  return glm::clamp(glm::vec3(baseColor(scene, mesh, point)) * (1.0f - metallic), 0.0f, 1.0f);
}

glm::vec3 reflectance(const Scene& scene, const Mesh& mesh, const SurfacePoint& point) {
  const glm::vec2 factors = metallicRoughness(scene, mesh, point);
  const brdf::Lobes lobes = brdf::makeLobes(glm::vec3(baseColor(scene, mesh, point)), factors.x, factors.y,
                                            scene.materials[std::size_t(mesh.material)].specular);
  return glm::clamp(lobes.diffuse + lobes.specular, 0.0f, 1.0f);
}

}  // namespace gloam::trace
