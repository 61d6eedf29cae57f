// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Random numbers: Jarzynski, Olano 2020 (pcg, pcg4d). Sequences: van der Corput 1935; Sobol 1967 with Owen scrambling
// by a hash (Laine, Karras 2011; Burley 2020; Vegdahl 2021); Roberts 2018 (R2). Warps: Shirley, Chiu 1997; Duff et al. 2017;
// Heitz 2019; Gonzalez 2010 (spherical Fibonacci).
#include "math/sampling.h"

#include <gloam/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace gloam::sampling {
namespace {

std::uint32_t reversedBits(std::uint32_t v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  return (v >> 16) | (v << 16);
}

/// Second Sobol dimension: column k of its matrix is row k of Pascal's triangle modulo 2, by x -> x ^ (x >> 1).
std::uint32_t sobolSecond(std::uint32_t i) {
  std::uint32_t result = 0;
  for (std::uint32_t column = 0x80000000u; i != 0; i >>= 1, column ^= column >> 1)
    if ((i & 1u) != 0) result ^= column;
  return result;
}

/// Owen scrambling of a fraction: each bit is flipped by a hash of the bits above it.
std::uint32_t owenScrambled(std::uint32_t bits, std::uint32_t seed) {
  std::uint32_t v = reversedBits(bits);
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return reversedBits(v);
}

float clampedRoot(float value) {
  return std::sqrt(std::max(0.0f, value));
}

glm::vec3 aboutZ(float z, float azimuth_turns) {
  const float radius = clampedRoot(1.0f - z * z), phi = 2.0f * kPi * azimuth_turns;
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

}  // namespace

std::uint32_t pcgHash(std::uint32_t value) {
  const std::uint32_t state = value * 747796405u + 2891336453u;
  const std::uint32_t word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

glm::uvec4 pcg4d(const glm::uvec4& key) {
  glm::uvec4 v = key * 1664525u + 1013904223u;
  const auto mix = [&v] {
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
  };
  mix();
  v ^= v >> 16u;
  mix();
  return v;
}

float toUnitFloat(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

std::uint32_t Rng::nextUint() {
  if (counter_ % 4 == 0) block_ = pcg4d({counter_ / 4, substream_, stream_, seed_});
  return block_[static_cast<glm::length_t>(counter_++ % 4)];
}

glm::vec2 Rng::next2() {
  const float x = next();
  return {x, next()};
}

glm::vec3 Rng::next3() {
  const glm::vec2 xy = next2();
  return {xy, next()};
}

std::uint32_t Rng::below(std::uint32_t bound) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(nextUint()) * bound) >> 32);
}

float radicalInverse(std::uint32_t base, std::uint64_t i) {
  const double inverse = 1.0 / base;
  double digit = inverse, value = 0.0;
  for (; i != 0; i /= base, digit *= inverse) value += static_cast<double>(i % base) * digit;
  return std::min(static_cast<float>(value), 0x1.fffffep-1f);
}

glm::vec2 r2(std::uint32_t i) {
  // 1 / g and 1 / g^2 in 32-bit fixed point, g^3 = g + 1; the recurrence starts at 1/2.
  constexpr std::uint32_t kFirst = 3242174889u, kSecond = 2447445414u;
  return {toUnitFloat(0x80000000u + kFirst * i), toUnitFloat(0x80000000u + kSecond * i)};
}

glm::vec2 sobol2(std::uint32_t i) {
  return {toUnitFloat(reversedBits(i)), toUnitFloat(sobolSecond(i))};
}

glm::vec2 sobol2(std::uint32_t i, std::uint32_t seed) {
  const std::uint32_t k = owenScrambled(i, pcgHash(seed));  // aligned blocks stay aligned blocks
  return {toUnitFloat(owenScrambled(reversedBits(k), pcgHash(seed ^ 0x68bc21ebu))),
          toUnitFloat(owenScrambled(sobolSecond(k), pcgHash(seed ^ 0x02e5be93u)))};
}

glm::vec3 uniformSphere(const glm::vec2& u) {
  return aboutZ(1.0f - 2.0f * u.x, u.y);
}
glm::vec3 uniformHemisphere(const glm::vec2& u) {
  return aboutZ(1.0f - u.x, u.y);
}

glm::vec3 cosineHemisphere(const glm::vec2& u) {
  const glm::vec2 d = uniformDisc(u);
  return {d, clampedRoot(1.0f - d.x * d.x - d.y * d.y)};
}

glm::vec3 phongLobe(const glm::vec2& u, float exponent) {
  // z = (1 - u)^(1 / (n + 1)), and 1 - z^2 without cancellation for narrow lobes.
  const double log_z = std::log1p(-static_cast<double>(u.x)) / (static_cast<double>(exponent) + 1.0);
  const auto radius = static_cast<float>(std::sqrt(-std::expm1(2.0 * log_z)));
  const float phi = 2.0f * kPi * u.y;
  return {radius * std::cos(phi), radius * std::sin(phi), static_cast<float>(std::exp(log_z))};
}

glm::vec3 uniformCone(const glm::vec2& u, float cos_half_angle) {
  const float height = u.x * (1.0f - cos_half_angle), phi = 2.0f * kPi * u.y;  // 1 - z
  const float radius = clampedRoot(height * (2.0f - height));
  return {radius * std::cos(phi), radius * std::sin(phi), 1.0f - height};
}

glm::vec2 uniformDisc(const glm::vec2& u) {
  const glm::vec2 p = 2.0f * u - 1.0f;
  if (p.x == 0.0f && p.y == 0.0f) return glm::vec2(0.0f);
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const float radius = wide ? p.x : p.y;
  const float phi = wide ? 0.25f * kPi * (p.y / p.x) : 0.5f * kPi - 0.25f * kPi * (p.x / p.y);
  return {radius * std::cos(phi), radius * std::sin(phi)};
}

glm::vec3 uniformTriangle(const glm::vec2& u) {
  glm::vec2 b = 0.5f * u;
  const float offset = b.y - b.x;  // folds the square's halves onto the triangle
  if (offset > 0.0f) {
    b.y += offset;
  } else {
    b.x -= offset;
  }
  return {b.x, b.y, 1.0f - b.x - b.y};
}

glm::mat3 frame(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

glm::vec3 fibonacciDirection(std::uint32_t i, std::uint32_t count) {
  constexpr double kGolden = 0.61803398874989484820;
  const double z = 1.0 - (2.0 * i + 1.0) / count, radius = std::sqrt(1.0 - z * z);
  const double turns = i * kGolden, phi = 2.0 * 3.14159265358979323846 * (turns - std::floor(turns));
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

std::vector<glm::vec3> fibonacciSphere(int count) {
  if (count < 1 || count > 1 << 24)
    throw Error("directions", "a set of " + std::to_string(count) + ", expected 1 to 16777216");
  std::vector<glm::vec3> directions(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < directions.size(); ++i)
    directions[i] = fibonacciDirection(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(count));
  return directions;
}

std::vector<glm::vec3> stratifiedSphere(int rows, std::uint32_t seed) {
  if (rows < 1 || rows > 2048)
    throw Error("directions", "a grid of " + std::to_string(rows) + " rows, expected 1 to 2048");
  std::vector<glm::vec3> directions;
  Rng random(seed);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column) {
      const glm::vec2 u = random.next2();
      directions.push_back(
          uniformSphere({(static_cast<float>(row) + u.x) / static_cast<float>(rows),
                         (static_cast<float>(column) + u.y) / static_cast<float>(2 * rows)}));
    }
  return directions;
}

}  // namespace gloam::sampling
