// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the surface is made of at a point of a triangle: material, textures and vertex colours, on the CPU. Textures are
// read bilinearly at full resolution (no mip levels), sRGB decoded before they are interpolated.
#pragma once

#include <gloam/scene.h>

namespace gloam::trace {

/// A place on a mesh: (1 - u - v) p0 + u p1 + v p2 of that triangle's vertices.
struct SurfacePoint {
  int triangle = 0;
  float u = 0.0f, v = 0.0f;
};

/// One attribute at a point.
template <typename T>
T interpolate(const Mesh& mesh, const std::vector<T>& attribute, const SurfacePoint& point) {
  const std::uint32_t* corner = &mesh.indices[std::size_t(point.triangle) * 3];
  return attribute[corner[0]] * (1.0f - point.u - point.v) + attribute[corner[1]] * point.u +
         attribute[corner[2]] * point.v;
}

/// Texel under (u, v) of the slot's own set, before factors: linear, 0 to 1. White where the slot is empty.
glm::vec4 sampleTexture(const Scene& scene, const TextureSlot& slot, glm::vec2 uv, bool srgb);
/// The same at a point of a mesh; uv is (0, 0) where the mesh lacks the slot's set.
glm::vec4 sampleTexture(const Scene& scene, const TextureSlot& slot, const Mesh& mesh,
                        const SurfacePoint& point, bool srgb);

/// Base colour times its map times vertex colour, linear; w is alpha.
glm::vec4 baseColor(const Scene& scene, const Mesh& mesh, const SurfacePoint& point);
/// x: metallic, y: roughness.
glm::vec2 metallicRoughness(const Scene& scene, const Mesh& mesh, const SurfacePoint& point);
/// Radiance that the surface sends out of itself, the same on both sides.
glm::vec3 emission(const Scene& scene, const Mesh& mesh, const SurfacePoint& point);

/// All factors at once: vertex colours at `point`, textures at `texture_point`, which may lie beside it (and beyond the
/// triangle): whoever averages over a footprint moves the textures alone.
struct MaterialPoint {
  glm::vec4 base_color{1.0f};  ///< linear; w is alpha
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emission{0.0f};
};
MaterialPoint materialAt(const Scene& scene, const Mesh& mesh, const SurfacePoint& point,
                         const SurfacePoint& texture_point);
/// Tilts a unit normal as a normal map's texel (0 to 1) says, in the frame that glTF prescribes: tangent made perpendicular
/// to the normal, bitangent by the sign in w. The normal itself where the tangent has no direction.
glm::vec3 mappedNormal(const glm::vec3& normal, const glm::vec4& tangent, const glm::vec3& texel,
                       float scale);

/// k_d = base (1 - metallic), held to 0..1: no surface sends back more than it receives.
glm::vec3 diffuseAlbedo(const Scene& scene, const Mesh& mesh, const SurfacePoint& point);
/// k_d + k_s, held to 0..1: what leaves of light that arrives, both lobes together.
glm::vec3 reflectance(const Scene& scene, const Mesh& mesh, const SurfacePoint& point);

}  // namespace gloam::trace
