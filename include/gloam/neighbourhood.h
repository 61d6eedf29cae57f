// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Neighbourhood transfer (Sloan, Kautz, Snyder 2002, section 7; PRT-6): a grid of transfer matrices round an object, by which
// it throws soft shadow, glossy reflection and caustics on whatever moves through.
#pragma once

#include <gloam/scene.h>

namespace gloam {

/// In the axes of the node that carries it. At point (x, y, z), x first, of a grid: from the light's coefficients (a bands) to
/// those of the radiance that arrives there (b bands). Visibility stands as in GlossyTransfer: V of (a + b - 1) bands, of which
/// the matrix is GS_ij = sum over k of Gamma_ijk V_k; here V has no tangent plane, it is that of free space.
/// Points stand in the node's own coordinates, directions in its axes without scale, as those of transfer. They are even in
/// the object's box and grow apart beyond it: along each axis point i has place q = (i - (size - 1) / 2) spacing and stands
/// at centre + q where |q| <= core, else at centre +- (core + growth (exp((|q| - core) / growth) - 1)).
struct NeighbourhoodTransfer {
  glm::vec3 centre{0.0f}, spacing{1.0f}, core{0.0f}, growth{1.0f};
  glm::ivec3 size{0};                    ///< points along each axis, 2 at least
  int light_order = 0, field_order = 0;  ///< a and b
  int bounces = 0;                       ///< contained in `indirect`
  std::vector<float> visibility;         ///< [point][coefficient]
  std::vector<float> indirect;           ///< [point][i][j][rgb], i < b^2, j < a^2; empty without bounces
  std::size_t points() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
  glm::ivec3 pointAt(std::size_t number) const {
    const std::size_t x = std::size_t(size.x), y = std::size_t(size.y);
    return {int(number % x), int(number / x % y), int(number / (x * y))};
  }
  std::size_t numberOf(const glm::ivec3& point) const {
    return std::size_t(point.x) +
           std::size_t(size.x) * (std::size_t(point.y) + std::size_t(size.y) * std::size_t(point.z));
  }
  std::size_t visibilityCount() const {
    const int bands = light_order + field_order - 1;
    return std::size_t(bands * bands);
  }
  std::size_t matrixCount() const {
    return std::size_t(light_order * light_order * field_order * field_order);
  }
  /// Where a place of the grid lies, of which points have whole numbers.
  glm::vec3 position(const glm::vec3& place) const {
    const glm::vec3 q = (place - 0.5f * glm::vec3(size - 1)) * spacing, beyond = glm::abs(q) - core;
    const glm::vec3 far = core + growth * (glm::exp(glm::max(beyond, 0.0f) / growth) - 1.0f);
    return centre + glm::sign(q) * glm::mix(glm::abs(q), far, glm::greaterThan(beyond, glm::vec3(0.0f)));
  }
  glm::vec3 position(std::size_t point) const { return position(glm::vec3(pointAt(point))); }
  /// The inverse: the place in the grid, 0 to size - 1 along each axis, beyond that outside.
  glm::vec3 placeOf(const glm::vec3& at) const {
    const glm::vec3 way = at - centre, beyond = glm::abs(way) - core;
    const glm::vec3 far = core + growth * glm::log(1.0f + glm::max(beyond, 0.0f) / growth);
    const glm::vec3 q = glm::mix(glm::abs(way), far, glm::greaterThan(beyond, glm::vec3(0.0f)));
    return glm::sign(way) * q / spacing + 0.5f * glm::vec3(size - 1);
  }
  /// From the centre to the border.
  glm::vec3 half() const { return position(glm::vec3(size - 1)) - centre; }
};

inline constexpr int kDefaultNeighbourhoodPoints = 20;

struct NeighbourhoodOptions {
  glm::ivec3 size{kDefaultNeighbourhoodPoints, 0, 0};  ///< points along each axis, 2 to 128; y and z 0: as x
  float reach = 1.0f;  ///< how far the grid goes beyond the object, in lengths of its longest side; 0 to 16
  int order = 5;       ///< bands of light and of radiance, 3 to 6
  bool thrown = true;  ///< light that the object throws, too, as far as its meshes carry transfer
  int directions = 10000;            ///< from a point, 256 to 65536; rounded up to whole tiles of 16
  int thrown_directions = 2048;      ///< of the same set, 64 to 65536: along which thrown light is gathered
  int threads = 0;                   ///< 0: all cores. The result does not depend on it
  float time_s = 0.0f;               ///< instant at which the object is posed
  std::size_t memory_bytes = 0;      ///< most that the bake may take; 0: what the machine has
  int error_points = 1000;           ///< at random in the grid, at which the error is measured; 0: it is not
  std::filesystem::path checkpoint;  ///< as BakeOptions::checkpoint
  bool keep_checkpoint = false;      ///< as BakeOptions::keep_checkpoint; to be removed by the caller
};

struct NeighbourhoodEstimate {
  glm::ivec3 size{0};
  std::size_t points = 0, rays = 0;
  std::size_t memory_bytes = 0, file_bytes = 0;
};

struct NeighbourhoodReport {
  std::size_t points = 0, inside = 0;  ///< in all, and of these in the object
  std::size_t rays = 0, thrown_rays = 0;
  double seconds = 0.0;
  bool resumed = false;
  /// Relative RMSE of irradiance as the grid gives it, interpolated, against that of visibility traced at the place itself;
  /// at random places of the grid outside the object, on surfaces of all directions, under light whose coefficients fall
  /// with their band as 1 / (l + 1). Near: in the object's box, widened by a quarter of its longest side. Worst: at one of
  /// these places, relative to their RMS irradiance.
  double error = 0.0, near_error = 0.0, worst_error = 0.0;
};

/// Nodes that a neighbourhood can be baked for: the objects of BakeOptions::apart.
std::vector<int> neighbourhoodNodes(const Scene& scene, float time_s = 0.0f);
/// Of these the ones that animation moves, or anything below them, and then those that stand in the grid of one that moves
/// (`reach` as NeighbourhoodOptions has it) at any time: what may shadow one another, none of them baked into the other.
/// Empty where nothing moves.
std::vector<int> neighbourhoodNodesThatMeet(const Scene& scene, float reach, float time_s = 0.0f);

/// Throws Error where the options are out of range.
NeighbourhoodEstimate estimateNeighbourhood(const Scene& scene, int node,
                                            const NeighbourhoodOptions& options);

/// Of the rigid meshes at and below a node, in free space. Light that the object throws is made of its meshes' own transfer
/// (bakeTransfer with `apart`) and of mirror-like metals, which are followed ray by ray. Same bits for any number of threads.
/// Throws Error for options out of range, a node without rigid triangles and a grid that does not fit into memory;
/// Interrupted when asked to stop (the checkpoint stays).
NeighbourhoodTransfer bakeNeighbourhood(const Scene& scene, int node, const NeighbourhoodOptions& options,
                                        const Progress& progress = {}, NeighbourhoodReport* report = nullptr);

}  // namespace gloam
