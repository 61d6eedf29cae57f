// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Random numbers, quasi-random sequences, and warps from the unit square onto sphere, hemisphere and lobes.
// Everything follows from its arguments alone: no hidden state, the same bits on any thread. Points u lie in
// [0, 1).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gloam::sampling {

inline constexpr float kPi = 3.14159265358979323846f;

// ---- Random numbers ----

/// PCG's output permutation as a hash (Jarzynski, Olano 2020).
std::uint32_t pcgHash(std::uint32_t value);
/// Four words hashed together ("pcg4d", same paper): a counter-based generator (pixel, sample, dimension,
/// seed).
glm::uvec4 pcg4d(const glm::uvec4& key);
/// The upper 24 bits as a float in [0, 1).
float toUnitFloat(std::uint32_t bits);

/// A stream of numbers: number i of stream (seed, stream) is a hash of all three, so that streams can be
/// entered anywhere (resume, other thread counts).
class Rng {
 public:
  explicit Rng(std::uint32_t seed, std::uint32_t stream = 0, std::uint32_t substream = 0)
      : seed_(seed), stream_(stream), substream_(substream) {}
  std::uint32_t nextUint();
  float next() { return toUnitFloat(nextUint()); }
  glm::vec2 next2();
  glm::vec3 next3();
  std::uint32_t below(std::uint32_t bound);  ///< 0 … bound - 1, unbiased to 2^-32

 private:
  std::uint32_t seed_, stream_, substream_, counter_ = 0;
  glm::uvec4 block_{0u};
};

// ---- Quasi-random sequences ----

float radicalInverse(std::uint32_t base, std::uint64_t i);
/// Roberts' R2 sequence, an additive recurrence in fixed point: exact for every i.
glm::vec2 r2(std::uint32_t i);
/// Point i of the first two Sobol dimensions, a (0, 2)-sequence: any 2^k aligned points form a net.
glm::vec2 sobol2(std::uint32_t i);
/// The same, Owen-scrambled by a hash (Burley 2020): a random set for every seed, each as even.
glm::vec2 sobol2(std::uint32_t i, std::uint32_t seed);

// ---- Warps ----

glm::vec3 uniformSphere(const glm::vec2& u);                      ///< pdf 1 / 4 pi
glm::vec3 uniformHemisphere(const glm::vec2& u);                  ///< about +Z, pdf 1 / 2 pi
glm::vec3 cosineHemisphere(const glm::vec2& u);                   ///< about +Z, pdf z / pi
glm::vec3 phongLobe(const glm::vec2& u, float exponent);          ///< about +Z, pdf (n + 1) / 2 pi z^n
glm::vec3 uniformCone(const glm::vec2& u, float cos_half_angle);  ///< about +Z, pdf 1 / (2 pi (1 - cos))
glm::vec2 uniformDisc(const glm::vec2& u);      ///< concentric (Shirley, Chiu 1997), pdf 1 / pi
glm::vec3 uniformTriangle(const glm::vec2& u);  ///< barycentric coordinates (Heitz 2019)
/// Right-handed orthonormal frame whose third column is the unit normal (Duff et al. 2017): world_from_local.
glm::mat3 frame(const glm::vec3& normal);

// ---- Sets of directions ----

/// Spherical Fibonacci point i of count: even, low error for smooth functions.
glm::vec3 fibonacciDirection(std::uint32_t i, std::uint32_t count);
std::vector<glm::vec3> fibonacciSphere(int count);
/// One random point in each cell of an equal-area grid of rows x 2 rows.
std::vector<glm::vec3> stratifiedSphere(int rows, std::uint32_t seed);

/// A set of directions in groups ("tiles") of 16 neighbours, for ray packets. Tiles follow one another so
/// that any number of first tiles is spread evenly over the sphere: a pass may use a prefix, each direction
/// then standing for 4 pi / (its number of directions).
struct TiledDirections {
  static constexpr int kTileSize = 16;
  struct Cone {
    glm::vec3 axis;
    float cos_half_angle;  ///< of the cone about the axis that holds the tile's directions
  };
  std::vector<float> x, y, z;  ///< direction k of tile t stands at 16 t + k
  std::vector<Cone> cones;     ///< one a tile
  std::vector<int>
      even_prefixes;  ///< numbers of tiles at which the prefix is as even as a set of its own; last: all

  int tiles() const { return static_cast<int>(cones.size()); }
  int count() const { return tiles() * kTileSize; }
  glm::vec3 direction(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {x[k], y[k], z[k]};
  }
  /// Solid angle of each direction where `tile_count` first tiles are used.
  static float solidAngle(int tile_count) { return 4.0f * kPi / static_cast<float>(tile_count * kTileSize); }
};
/// `count` is rounded up to whole tiles (1 to 2^24 directions, else Error). The set is the union of `levels`
/// spherical Fibonacci sets of 1/2, 1/4, … of all directions, least first; at their ends, even_prefixes, the
/// error of a prefix is that of such a set. Between them it is no more than that of random directions. One
/// level gives the most compact tiles and the fastest rays; two cost about 20 % of the rate, three 27 %
/// (docs/sh.md). `seed` turns the set.
TiledDirections makeTiledDirections(int count, int levels = 1, std::uint32_t seed = 0);

}  // namespace gloam::sampling
