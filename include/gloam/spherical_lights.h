// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres that send light (SL-1, SL-2; Guerrero, Jeschke, Wimmer 2008): which points of an object's surface say how bright a
// sphere of its set (gloam/spheres.h) is, direction by direction, and of which colour. Made once a model; everything may move and
// the light may change without making it again.
#pragma once

#include <gloam/sh.h>
#include <gloam/spheres.h>

#include <array>

namespace gloam {

inline constexpr int kEmissionDirections = 92;  ///< vertices of an icosahedron, its edges cut in three
inline constexpr int kEmissionOrder = 4;        ///< bands of what a sphere sends

/// A point of the surface, (1 - u - v) p0 + u p1 + v p2 of a triangle.
struct EmissionSample {
  std::int32_t part = kNone;   ///< which of the object's meshes; kNone: the sphere sends nothing that way
  std::uint32_t triangle = 0;  ///< of that mesh
  float u = 0.0f, v = 0.0f;
  std::int32_t side = 1;  ///< -1: lit on the other side of what its normals say
};

/// One sphere. Directions and coefficients are in the axes of the set's shape space.
struct SphereEmission {
  std::array<EmissionSample, kEmissionDirections> samples;  ///< in the order of emissionDirections()
  sh::ShRgb
      albedo;  ///< c_S: diffuse, linear, of the surface as seen from the centre; its mean where nothing is seen
  sh::ShRgb glow;  ///< radiance that the surface sends out of itself, 0 where it does not
};

struct SetEmission {
  std::string fingerprint;  ///< of the geometry and the spheres that this belongs to, 32 hexadecimal digits
  std::vector<SphereEmission> spheres;
};

struct SceneEmission {
  std::vector<SetEmission> sets;  ///< one for each of SceneSpheres::sets
  Warnings warnings;
  /// What device or file holds of it.
  std::size_t bytes() const;
};

struct EmissionOptions {
  int albedo_directions = 1000;  ///< a sphere, 92 to 100000
  int threads = 0;               ///< 0: all cores. The result does not depend on it
};

/// Unit vectors, evenly spread, the same for every sphere.
const std::array<glm::vec3, kEmissionDirections>& emissionDirections();

/// Rays from each sphere's centre: the farthest back face of those parts of the surface that the sphere is nearest to by
/// |p - c| / r; nothing where others alone are met; where the centre lies outside, the front face that the opposite ray meets.
/// Throws Error for options out of range and sets of another scene, Interrupted when asked to stop.
SceneEmission sampleEmission(const Scene& scene, const SceneSpheres& spheres,
                             const EmissionOptions& options = {}, const Progress& progress = {});

/// docs/formats/emission.md. Writes beside the target and renames.
void writeEmission(const SceneEmission& emission, const std::filesystem::path& path);
/// Throws Error that names the field, also where it belongs to other spheres or another scene.
SceneEmission readEmission(const std::filesystem::path& path, const Scene& scene,
                           const SceneSpheres& spheres);

}  // namespace gloam
