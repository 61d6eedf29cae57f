// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tapered capsules melted into each other, as figure.cpp has them. Colour is not unrolled: u of a vertex is a tone between
// belly and back, v how light its strand of fur is, and the texture is a palette of both.
#include "scene/squirrel.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/implicit_surface.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"
#include "scene/soft_parts.h"

namespace gloam::squirrel {
namespace {

// Tones: fur from 0 to kFurEnd, then flat colours of the other bodies.
constexpr float kFurEnd = 0.7f, kEye = 0.75f, kNut = 0.85f, kNutCap = 0.95f;
constexpr float kBelly = 0.03f, kCream = 0.14f, kRusset = 0.36f, kBrown = 0.56f;

enum Group { kTrunk, kLimbs, kHead, kEars, kTail, kGroups };

using Parts = std::vector<TaperedCapsule>;

void addBothSides(Parts& parts, const TaperedCapsule& left) {
  parts.push_back(left);
  const auto mirrored = [](glm::vec3 p) { return glm::vec3(-p.x, p.y, p.z); };
  parts.push_back({mirrored(left.a), mirrored(left.b), left.radius_a, left.radius_b});
}

std::array<Parts, kGroups> groups() {
  std::array<Parts, kGroups> g;
  g[kTrunk] = {{{0, 0.22f, -0.02f}, {0, 0.45f, 0.03f}, 0.2f, 0.142f},
               {{0, 0.45f, 0.03f}, {0, 0.6f, 0.06f}, 0.142f, 0.1f}};
  Parts& limbs = g[kLimbs];
  addBothSides(limbs, {{0.135f, 0.14f, -0.03f}, {0.155f, 0.19f, 0.08f}, 0.125f, 0.1f});    // haunch
  addBothSides(limbs, {{0.14f, 0.045f, 0.06f}, {0.165f, 0.036f, 0.26f}, 0.045f, 0.037f});  // foot
  addBothSides(limbs, {{0.115f, 0.5f, 0.06f}, {0.16f, 0.37f, 0.13f}, 0.055f, 0.045f});     // arm
  addBothSides(limbs, {{0.16f, 0.37f, 0.13f}, {0.062f, 0.41f, 0.255f}, 0.042f, 0.034f});
  addBothSides(limbs, {{0.06f, 0.41f, 0.26f}, {0.045f, 0.43f, 0.29f}, 0.034f, 0.026f});  // paw
  g[kHead] = {{{0, 0.695f, 0.055f}, {0, 0.7f, 0.085f}, 0.128f, 0.122f},
              {{0, 0.67f, 0.13f}, {0, 0.648f, 0.215f}, 0.082f, 0.045f}};
  addBothSides(g[kHead], {{0.05f, 0.648f, 0.1f}, {0.062f, 0.655f, 0.12f}, 0.075f, 0.06f});  // cheek
  addBothSides(g[kEars], {{0.072f, 0.79f, 0.03f}, {0.098f, 0.89f, 0.01f}, 0.044f, 0.019f});
  const glm::vec3 bends[] = {{0, 0.09f, -0.16f}, {0, 0.12f, -0.32f},  {0, 0.33f, -0.43f},
                             {0, 0.56f, -0.4f},  {0, 0.755f, -0.33f}, {0, 0.86f, -0.37f},
                             {0, 0.86f, -0.5f},  {0, 0.77f, -0.555f}};
  const float radii[] = {0.065f, 0.105f, 0.142f, 0.155f, 0.14f, 0.115f, 0.085f, 0.045f};
  for (int i = 0; i + 1 < 8; ++i) g[kTail].push_back({bends[i], bends[i + 1], radii[i], radii[i + 1]});
  return g;
}

float distanceTo(const Parts& parts, const glm::vec3& p, float reach) {
  float d = 1e9f;
  for (const TaperedCapsule& part : parts) d = smoothMinimum(d, gloam::distanceTo(part, p), reach);
  return d;
}

/// Tufts: the tail's surface rises and falls along it.
float tufts(const glm::vec3& p) {
  return 0.007f * std::sin(34.0f * p.y + 16.0f * (p.z + 0.4f)) + 0.004f * std::sin(60.0f * p.x + 21.0f * p.y);
}

float toneAt(const std::array<Parts, kGroups>& g, const glm::vec3& p, const glm::vec3& n) {
  const float side = std::abs(p.x);
  float tone = kRusset + 0.12f * smoothStep(0.1f, -0.9f, n.z);  // darker towards the back
  if (distanceTo(g[kTail], p, 0.05f) < 0.02f && p.z < -0.17f) {
    tone = glm::mix(kBrown, kRusset, smoothStep(-0.2f, 0.7f, std::abs(n.x)));
    return glm::mix(tone, kCream, smoothStep(0.8f, 0.93f, p.y) * 0.7f);
  }
  // Belly and throat, then muzzle and cheeks.
  const float belly =
      smoothStep(0.35f, 0.8f, n.z) * smoothStep(0.12f, 0.06f, side) * smoothStep(0.1f, 0.2f, p.y);
  tone = glm::mix(tone, kBelly, p.y < 0.62f ? belly : 0.0f);
  const float muzzle =
      smoothStep(0.15f, 0.21f, p.z) * smoothStep(0.69f, 0.64f, p.y) * smoothStep(0.56f, 0.6f, p.y);
  tone = glm::mix(tone, kCream, 0.9f * muzzle);
  const float eye = glm::length(glm::vec3(side, p.y, p.z) - glm::vec3(0.082f, 0.722f, 0.165f));
  tone = glm::mix(tone, kCream, 0.9f * smoothStep(0.052f, 0.036f, eye));
  if (distanceTo(g[kEars], p, 0.01f) < 0.012f) tone = glm::mix(tone, kBrown, smoothStep(0.82f, 0.88f, p.y));
  const bool paws = (p.y < 0.09f && p.z > 0.12f) || (p.z > 0.21f && p.y > 0.35f && p.y < 0.48f);
  return paws ? kBrown : tone;
}

void appendFlat(Mesh& mesh, Mesh body, float tone) {
  for (glm::vec2& uv : body.uv_sets[0]) uv = {tone, 0.5f};
  shapes::append(mesh, body);
}

Mesh ellipsoid(const glm::vec3& middle, const glm::vec3& half, int frequency) {
  const glm::mat4 placed = glm::scale(glm::translate(glm::mat4(1.0f), middle), half);
  return shapes::transformed(shapes::icosphere(1.0f, frequency), placed);
}

}  // namespace

Mesh model(float cell) {
  const std::array<Parts, kGroups> g = groups();
  const auto distance = [&](const glm::vec3& p) {
    float d = distanceTo(g[kTrunk], p, 0.1f);
    d = smoothMinimum(d, distanceTo(g[kLimbs], p, 0.045f), 0.06f);
    d = smoothMinimum(d, distanceTo(g[kHead], p, 0.05f), 0.05f);
    d = smoothMinimum(d, distanceTo(g[kEars], p, 0.01f), 0.03f);
    const float tail = distanceTo(g[kTail], p, 0.06f);
    const float free = smoothStep(-0.12f, -0.24f, p.z);  // of the trunk
    return smoothMinimum(d, tail < 0.1f ? tail + free * tufts(p) : tail, 0.05f);
  };
  Mesh mesh = meshOfSurface(distance, {-0.38f, -0.08f, -0.74f}, {0.38f, 1.06f, 0.4f}, cell);
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    const float strand = 0.5f + 0.5f * tilingNoise(14.0f * (p.x + p.z), 9.0f * p.y + 4.0f * p.z, 64, 77);
    mesh.uv_sets[0][i] = {std::clamp(toneAt(g, p, mesh.normals[i]), 0.01f, kFurEnd - 0.06f), strand};
  }
  const int round = std::max(3, int(0.09f / cell));
  for (const float side : {-1.0f, 1.0f})
    appendFlat(mesh, ellipsoid({0.077f * side, 0.722f, 0.158f}, glm::vec3(0.027f), round), kEye);
  appendFlat(mesh, ellipsoid({0, 0.66f, 0.255f}, {0.021f, 0.016f, 0.016f}, round), kEye);
  appendFlat(mesh, ellipsoid({0, 0.43f, 0.305f}, {0.05f, 0.066f, 0.05f}, round), kNut);
  appendFlat(mesh, ellipsoid({0, 0.476f, 0.305f}, {0.058f, 0.034f, 0.058f}, round), kNutCap);
  return mesh;
}

int fur(SceneBuilder& builder) {
  return addPainted(
      builder, "fur",
      [](float u, float v) {
        if (u > 0.5f * (kNut + kNutCap)) return glm::vec3(0.16f, 0.09f, 0.035f);
        if (u > 0.5f * (kEye + kNut)) return glm::vec3(0.45f, 0.23f, 0.06f);
        if (u > kFurEnd) return glm::vec3(0.012f, 0.01f, 0.01f);
        const glm::vec3 belly(0.82f, 0.74f, 0.6f), cream(0.75f, 0.5f, 0.28f), russet(0.56f, 0.17f, 0.045f),
            brown(0.24f, 0.075f, 0.028f);
        glm::vec3 c = glm::mix(belly, cream, smoothStep(kBelly, kCream, u));
        c = glm::mix(c, russet, smoothStep(kCream, kRusset, u));
        c = glm::mix(c, brown, smoothStep(kRusset, kBrown, u));
        return c * (0.82f + 0.36f * v);
      },
      256, 64);
}

}  // namespace gloam::squirrel
