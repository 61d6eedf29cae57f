// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Two soft bags of sweets that crouch, jump, bend and swell: a skin for what bends and stretches, a morph target for what
// bulges. Squeezed bags keep about their volume.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"
#include "scene/sampled_motion.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f;
constexpr float kHeight_m = 0.95f, kHalfWidth_m = 0.34f, kHalfDepth_m = 0.22f;
constexpr float kSeam = 0.92f;  // of the height: above it front and back are pressed together
constexpr int kJoints = 6;      // along the height, at equal distances
constexpr float kBulge = 0.3f;  // how much wider the morph target is

/// A bag as a surface: angle about the vertical (0 at +X, growing towards +Z), t from bottom to top.
struct Bag {
  float bulge = 0.0f;
  glm::vec3 at(float angle, float t) const {
    const float b = 1.0f - std::min(1.0f, t / 0.13f);
    const float foot = std::sqrt(std::max(0.0f, 1.0f - std::pow(b, 2.4f)));  // the bottom's rounded edge
    const float up = std::clamp((t - 0.2f) / (kSeam - 0.2f), 0.0f, 1.0f);
    const float closing = std::pow(1.0f - up * up, 0.8f);
    const float over = std::max(0.0f, (t - 0.985f) / 0.015f);
    const float end = std::sqrt(1.0f - 0.6f * over * over);  // the upper edge is rounded
    const float waist = 1.0f - 0.07f * std::sin(kPi * std::clamp(t / kSeam, 0.0f, 1.0f));
    const float swell = 1.0f + bulge * std::sin(kPi * std::clamp(t / kSeam, 0.0f, 1.0f));
    const float x = std::cos(angle), half_width = kHalfWidth_m * foot * waist;
    // Folds run down from the seam.
    const float folds =
        1.0f + 0.13f * std::cos(13.0f * x + 0.8f) * smoothStep(0.5f, 0.85f, t) * smoothStep(0.99f, 0.9f, t);
    const float depth = (0.018f * foot + (kHalfDepth_m - 0.018f) * foot * closing * folds) * end;
    const float crimp =
        0.016f * std::sin(26.0f * x) * smoothStep(kSeam - 0.04f, kSeam + 0.02f, t) * (1.0f - x * x);
    return {x * half_width * (0.4f + 0.6f * swell), kHeight_m * t, std::sin(angle) * depth * swell + crimp};
  }
  glm::vec3 normal(float angle, float t) const {
    if (t < 1e-4f) return {0, -1, 0};
    const float h = 2e-3f, low = std::min(t, 0.997f) - 5e-4f;
    const glm::vec3 round = at(angle + h, t > 0.997f ? 0.997f : t) - at(angle - h, t > 0.997f ? 0.997f : t);
    const glm::vec3 up = at(angle, low + 1e-3f) - at(angle, std::max(1e-5f, low));
    return glm::normalize(glm::cross(up, round));
  }
};

/// Heights of the rows: close together at the bottom's edge and at the seam's end.
float rowHeight(float v) {
  static const std::vector<std::pair<float, float>> curve = {
      {0.0f, 0.0f},          {0.16f, 0.045f}, {0.24f, 0.13f}, {0.82f, kSeam - 0.03f},
      {0.9f, kSeam + 0.01f}, {0.95f, 0.985f}, {1.0f, 1.0f}};
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (v > curve[i].first) continue;
    const float x = (v - curve[i - 1].first) / (curve[i].first - curve[i - 1].first);
    // Round steps at both ends of the bag.
    const float eased = i == 1 ? x * x : i + 1 == curve.size() ? x * (2.0f - x) : x;
    return glm::mix(curve[i - 1].second, curve[i].second, eased);
  }
  return 1.0f;
}

Mesh bagMesh(const Detail& detail) {
  const int around = 4 * detail(19), rows = detail(56);
  const auto meshOf = [&](const Bag& bag) {
    Mesh mesh = shapes::surface(around, rows, [&](float u, float v) {
      const float angle = -2 * kPi * u, t = rowHeight(1.0f - v);
      const glm::vec3 n = bag.normal(angle, t);
      const glm::vec3 side = glm::cross(glm::vec3(0, 1, 0), n);
      return shapes::SurfacePoint{bag.at(angle, t), n, glm::length(side) > 1e-3f ? side : glm::vec3(1, 0, 0)};
    });
    // The seam's upper edge, from back to front.
    Mesh edge = shapes::surface(around / 2, 1, [&](float u, float v) {
      const float angle = kPi * (1.0f - u);
      return shapes::SurfacePoint{bag.at(v < 0.5f && u > 0.0f ? -angle : angle, 1.0f), {0, 1, 0}, {1, 0, 0}};
    });
    for (glm::vec2& uv : edge.uv_sets[0]) uv.y = 0.01f;
    shapes::append(mesh, edge);
    return mesh;
  };
  Mesh mesh = meshOf({});
  const Mesh wide = meshOf({kBulge});
  MorphTarget target;
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    target.positions.push_back(wide.positions[i] - mesh.positions[i]);
    target.normals.push_back(wide.normals[i] - mesh.normals[i]);
  }
  mesh.morph_targets = {std::move(target)};
  mesh.influences = 4;
  for (const glm::vec3& p : mesh.positions) {
    const float x = std::clamp(p.y / kHeight_m, 0.0f, 1.0f) * float(kJoints - 1);
    const int below = std::min(int(x), kJoints - 2);
    const float above = smoothStep(0.0f, 1.0f, x - float(below));
    // Joints without weight are 0.
    mesh.joints.insert(mesh.joints.end(), {std::uint16_t(above < 1.0f ? below : 0),
                                           std::uint16_t(above > 0.0f ? below + 1 : 0), 0, 0});
    mesh.weights.insert(mesh.weights.end(), {1.0f - above, above, 0.0f, 0.0f});
  }
  return mesh;
}

struct Look {
  glm::vec3 ground, stripe;
  std::uint32_t seed;
};

/// Foil with slanted stripes, a window of sweets in front and behind, a silver seam.
int foil(SceneBuilder& builder, const std::string& name, const Look& look) {
  static const std::array<glm::vec3, 6> sweets = {{{0.75f, 0.05f, 0.04f},
                                                   {0.85f, 0.6f, 0.05f},
                                                   {0.12f, 0.5f, 0.1f},
                                                   {0.06f, 0.2f, 0.65f},
                                                   {0.8f, 0.3f, 0.5f},
                                                   {0.85f, 0.82f, 0.75f}}};
  return addPainted(
      builder, name,
      [&](float u, float v) {
        const float slant = 10.0f * u + 3.0f * v, f = slant - std::floor(slant);
        glm::vec3 c =
            glm::mix(look.ground, look.stripe, smoothStep(0.0f, 0.04f, f) * smoothStep(0.44f, 0.4f, f));
        const float x = std::fmod(2.0f * u, 1.0f), wx = (x - 0.5f) / 0.27f, wy = (v - 0.52f) / 0.2f;
        const float window = wx * wx * wx * wx + wy * wy * wy * wy;
        c = glm::mix(c, {0.82f, 0.8f, 0.74f}, smoothStep(1.35f, 1.25f, window));
        if (window < 1.0f) {
          c = {0.3f, 0.16f, 0.08f};
          // Each cell of a lattice holds a bean that lies as chance will have it; a later one covers earlier ones.
          const float gx = 12.0f * x, gy = 16.0f * v;
          for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
              const int cx = int(gx) + dx, cy = int(gy) + dy;
              const auto chance = [&](int k) {
                return tilingNoise(float(cx) + 0.5f * float(k & 1), float(cy) + 0.37f * float(k + 1), 64,
                                   look.seed + std::uint32_t(k));
              };
              const float turn = 6.0f * chance(0), px = gx - float(cx) - 0.5f - 0.3f * chance(1),
                          py = gy - float(cy) - 0.5f - 0.3f * chance(2);
              const float a = (px * std::cos(turn) + py * std::sin(turn)) / 0.62f,
                          b = (py * std::cos(turn) - px * std::sin(turn)) / 0.4f;
              const float inside = a * a + b * b;
              const int hue = int(3.0f + 4.9f * chance(3) + 6.0f) % 6;
              if (inside < 1.0f) c = sweets[std::size_t(hue)] * (1.0f - 0.55f * inside * inside);
            }
          }
        }
        const float seam = smoothStep(0.115f, 0.105f, v);
        const float ribs = 0.9f + 0.1f * std::sin(2 * kPi * 48.0f * u);
        return glm::mix(c, glm::vec3(0.72f, 0.73f, 0.75f) * ribs, seam);
      },
      512, 512);
}

using Curve = std::vector<std::pair<float, float>>;

/// A bag's act: it crouches, jumps, lands and wobbles, then watches the other one jump.
struct Act {
  float start_s = 0.0f, toward = 1.0f;  // the other bag stands towards +-X
  float phase(float t) const { return std::fmod(t - start_s + 2.0f * kSeconds, kSeconds); }
  /// 1: as flat as it gets; negative: stretched.
  float squeeze(float t) const {
    static const Curve curve = {{0.0f, 0.0f},   {0.5f, 0.95f},  {0.68f, -0.45f}, {0.95f, -0.1f},
                                {1.2f, -0.3f},  {1.38f, 1.0f},  {1.62f, -0.32f}, {1.86f, 0.4f},
                                {2.1f, -0.18f}, {2.35f, 0.12f}, {2.6f, 0.0f},    {3.2f, 0.14f},
                                {4.0f, 0.0f}};
    return easedThrough(curve, phase(t));
  }
  float jump(float t) const {
    const float x = (phase(t) - 0.6f) / 0.57f;  // seconds in the air: 9.8 m / s^2 takes it 0.4 m up
    return x > 0.0f && x < 1.0f ? 4.0f * 0.4f * x * (1.0f - x) : 0.0f;
  }
  /// Of the whole bag, in radians; positive leans to +X.
  float bend(float t) const {
    const Curve curve = {{0.0f, 0.0f},
                         {0.5f, -0.1f * toward},
                         {0.9f, 0.55f * toward},
                         {1.35f, -0.35f * toward},
                         {1.75f, 0.12f * toward},
                         {2.1f, 0.0f},
                         {2.6f, -0.35f * toward},
                         {3.1f, 0.3f * toward},
                         {3.6f, -0.12f * toward},
                         {4.0f, 0.0f}};
    return easedThrough(curve, phase(t));
  }
  float twist(float t) const {
    const Curve curve = {{0.0f, 0.0f},    {0.5f, -0.35f}, {0.95f, 0.6f},
                         {1.45f, -0.15f}, {2.0f, 0.0f},   {4.0f, 0.0f}};
    return easedThrough(curve, phase(t));
  }
};

void addBag(SceneBuilder& builder, const std::string& name, const Detail& detail, int material,
            const glm::vec3& at, float turn_rad, const Act& act) {
  const int stand = builder.node(name + " stand", kNone, at);
  builder.at(stand).rotation = glm::angleAxis(turn_rad, glm::vec3(0, 1, 0));
  addMotion(builder, stand, kSeconds, [=](float t) { return at + glm::vec3(0, act.jump(t), 0); });
  std::vector<int> joints;
  std::vector<glm::mat4> joint_from_mesh;
  const float apart = kHeight_m / float(kJoints - 1);
  for (int j = 0; j < kJoints; ++j) {
    const int joint = builder.node(name + " joint " + std::to_string(j), j == 0 ? stand : joints.back(),
                                   {0, j == 0 ? 0.0f : apart, 0});
    joints.push_back(joint);
    glm::mat4 inverse(1.0f);
    inverse[3] = glm::vec4(0, -apart * float(j), 0, 1);
    joint_from_mesh.push_back(inverse);
    if (j == 0) continue;
    addMotion(builder, joint, kSeconds,
              [=](float t) { return glm::vec3(0, apart * (1.0f - 0.34f * act.squeeze(t)), 0); });
    const float share = 1.0f / float(kJoints - 1);
    addTurning(builder, joint, kSeconds, [=](float t) {
      return glm::angleAxis(-share * act.bend(t), glm::vec3(0, 0, 1)) *
             glm::angleAxis(share * act.twist(t), glm::vec3(0, 1, 0));
    });
  }
  const int bag = builder.place(name, bagMesh(detail), material);
  builder.at(bag).skin = builder.skin(joints, std::move(joint_from_mesh));
  builder.at(bag).morph_weights = {0.0f};
  addMorphing(builder, bag, kSeconds, [=](float t) { return act.squeeze(t); });
}

}  // namespace

Scene makePackages(const Detail& detail, NamedValues&) {
  SceneBuilder builder("packages");
  const float cell = detail.cell(0.075f);
  builder.place("table", shapes::withUvScale(shapes::slab(1.7f, 1.2f, 0.12f, 0.03f, cell), {2.0f, 1.4f}),
                addBoards(builder, "table", {0.5f, 0.38f, 0.25f}), {0, 0, 0.1f});
  builder.place("back wall",
                shapes::moved(shapes::roundedBox({1.7f, 1.05f, 0.05f}, 0.02f, 1.5f * cell, 2), {0, 1.05f, 0}),
                addPlaster(builder, "wall", {0.7f, 0.68f, 0.63f}, {0.36f, 0.46f, 0.3f}, 0.78f, 1.2f),
                {0, -0.11f, -0.98f});
  const int warm = foil(builder, "red foil", {{0.7f, 0.045f, 0.03f}, {0.85f, 0.5f, 0.04f}, 11});
  const int cool = foil(builder, "green foil", {{0.04f, 0.36f, 0.2f}, {0.1f, 0.55f, 0.62f}, 29});
  addBag(builder, "red bag", detail, warm, {-0.56f, 0.0f, 0.05f}, 0.3f, {0.0f, 1.0f});
  addBag(builder, "green bag", detail, cool, {0.56f, 0.0f, -0.05f}, -0.25f, {2.0f, -1.0f});
  builder.camera({0.7f, 1.35f, 3.35f}, {0.02f, 0.66f, -0.05f}, 36);
  builder.sky("mild?azimuth=25&elevation=45");
  return builder.finish();
}

}  // namespace gloam
