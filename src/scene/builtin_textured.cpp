// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Everything that a material's textures can say: colour, roughness and metal, normals, alpha masks, a texture transform.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/painted_textures.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kSize = 256;

float noise(float u, float v, int cells, std::uint32_t seed) {
  return 0.65f * tilingNoise(u * float(cells), v * float(cells), cells, seed) +
         0.35f * tilingNoise(2.0f * u * float(cells), 2.0f * v * float(cells), 2 * cells, seed + 1);
}

float fraction(float x) {
  return x - std::floor(x);
}

/// Bricks in running bond, 2 wide and 4 high: how far from the joint (0 in it, 1 on the brick), and which brick.
struct Brick {
  float inside;
  int number;
};
Brick brickAt(float u, float v) {
  const float y = fraction(v) * 4.0f;
  const int row = int(y);
  const float x = fraction(u + (row % 2 ? 0.25f : 0.0f)) * 2.0f;
  const float edge_x = std::min(fraction(x), 1.0f - fraction(x)) * 2.0f,
              edge_y = std::min(fraction(y), 1.0f - fraction(y));
  return {smoothStep(0.05f, 0.13f, std::min(edge_x, edge_y)), row * 2 + int(x)};
}

int bricks(SceneBuilder& builder) {
  const int color = builder.texture(paint("brick colour", kSize, kSize, [](float u, float v) {
    const Brick brick = brickAt(u, v);
    const float tone = 1.0f + 0.3f * tilingNoise(float(brick.number) * 3.7f + 0.5f, 0.5f, 64, 7) +
                       0.18f * noise(u, v, 16, 3);
    const glm::vec3 clay = glm::vec3(0.42f, 0.14f, 0.075f) * tone;
    const glm::vec3 mortar = glm::vec3(0.42f, 0.39f, 0.34f) * (1.0f + 0.15f * noise(u, v, 32, 5));
    return stored(glm::mix(mortar, clay, brick.inside));
  }));
  const int normals = builder.texture(paintNormals("brick normals", kSize, kSize, [](float u, float v) {
    return 0.012f * brickAt(u, v).inside + 0.0022f * noise(fraction(u), fraction(v), 16, 3);
  }));
  const int index = builder.diffuse("bricks", glm::vec3(1.0f));
  builder.material(index).base_color_map.texture = color;
  builder.material(index).normal_map.texture = normals;
  return index;
}

int tiles(SceneBuilder& builder) {
  // 2 x 2 tiles: dark and light, bevelled, with roughness that differs.
  const auto edge = [](float u, float v) {
    const float x = fraction(2 * u), y = fraction(2 * v);
    return std::min(std::min(x, 1 - x), std::min(y, 1 - y));
  };
  const auto dark = [](float u, float v) { return (int(fraction(u) * 2) + int(fraction(v) * 2)) % 2 == 1; };
  const int color = builder.texture(paint("tile colour", kSize, kSize, [&](float u, float v) {
    const glm::vec3 tile = dark(u, v) ? glm::vec3(0.09f, 0.13f, 0.15f) : glm::vec3(0.68f, 0.63f, 0.54f);
    const float veins = 1.0f + 0.22f * noise(u, v, 8, 11);
    return stored(
        glm::mix(glm::vec3(0.2f, 0.18f, 0.16f), tile * veins, smoothStep(0.008f, 0.03f, edge(u, v))));
  }));
  const int normals = builder.texture(paintNormals("tile normals", kSize, kSize, [&](float u, float v) {
    return 0.012f * smoothStep(0.0f, 0.06f, edge(u, v));
  }));
  const int rough = builder.texture(paint("tile roughness", kSize, kSize, [&](float u, float v) {
    const float polished = dark(u, v) ? 0.28f : 0.5f;
    const float value = edge(u, v) < 0.02f ? 0.95f : polished + 0.08f * noise(u, v, 8, 13);
    return glm::vec4(1.0f, value, 0.0f, 1.0f);
  }));
  const int index = builder.glossy("tiles", glm::vec3(1.0f), 1.0f);
  Material& m = builder.material(index);
  m.base_color_map.texture = color;
  m.normal_map.texture = normals;
  m.metallic_roughness_map.texture = rough;
  m.metallic = 1.0f;  // the map's blue channel says where
  return index;
}

/// Painted metal: worn through to copper in spots, the paint turned and scaled by KHR_texture_transform.
int wornPaint(SceneBuilder& builder) {
  const auto bare = [](float u, float v) { return smoothStep(0.12f, 0.2f, noise(u, v, 6, 21)); };
  const int color = builder.texture(paint("worn colour", kSize, kSize, [&](float u, float v) {
    const bool stripe = fraction(4.0f * (u + v)) < 0.5f;
    const glm::vec3 enamel = stripe ? glm::vec3(0.05f, 0.22f, 0.33f) : glm::vec3(0.72f, 0.66f, 0.5f);
    return stored(glm::mix(enamel, glm::vec3(0.9f, 0.55f, 0.4f), bare(u, v)));
  }));
  const int rough = builder.texture(paint("worn metal", kSize, kSize, [&](float u, float v) {
    return glm::vec4(1.0f, glm::mix(0.45f, 0.3f, bare(u, v)), bare(u, v), 1.0f);
  }));
  const int index = builder.metal("worn paint", glm::vec3(1.0f), 1.0f);
  Material& m = builder.material(index);
  m.base_color_map.texture = color;
  m.metallic_roughness_map.texture = rough;
  // Twice as many stripes, turned by 30 degrees: columns are the images of u and v.
  const float c = 2.0f * std::cos(kPi / 6), s = 2.0f * std::sin(kPi / 6);
  m.base_color_map.texture_from_uv = glm::mat3(c, -s, 0, s, c, 0, 0.1f, 0.2f, 1);
  m.metallic_roughness_map.texture_from_uv = m.base_color_map.texture_from_uv;
  return index;
}

int leafMaterial(SceneBuilder& builder) {
  // A leaf's half width along it, saw-toothed; the stem at v = 1.
  const auto half_width = [](float v) {
    const float body = 0.40f * std::pow(std::sin(kPi * std::pow(1.0f - v, 0.75f)), 0.85f);
    return body * (0.9f + 0.1f * fraction(14.0f * v)) + 0.012f;
  };
  const int color = builder.texture(paint("leaf", kSize / 2, kSize, [&](float u, float v) {
    const float across = std::abs(u - 0.5f);
    const float vein =
        std::min(across * 40.0f, 6.0f * std::abs(fraction(9.0f * (v - 0.9f * across)) - 0.5f) + 0.6f);
    const glm::vec3 green =
        glm::mix(glm::vec3(0.26f, 0.42f, 0.1f), glm::vec3(0.07f, 0.2f, 0.045f), std::min(1.0f, vein));
    return stored(green * (1.0f + 0.2f * noise(u, v, 8, 31)), across < half_width(v) ? 1.0f : 0.0f);
  }));
  const int index = builder.diffuse("leaf", glm::vec3(1.0f));
  Material& m = builder.material(index);
  m.base_color_map.texture = color;
  m.base_color_map.wrap_u = m.base_color_map.wrap_v = Wrap::kClampToEdge;
  m.alpha_mask = true;
  m.double_sided = true;
  return index;
}

/// A leaf that leaves the stem at the origin along +Z and droops: v = 1 at the stem.
Mesh leaf(const Detail& detail, float length, float rise_rad, float droop_rad) {
  return shapes::surface(detail(8), detail(14), [&](float u, float v) {
    const float t = 1.0f - v;                     // from stem to tip, an arc of growing droop
    const float x = (0.5f - u) * 0.52f * length;  // to the right, looking from the stem to the tip
    glm::vec3 p(x, 0, 0);
    const int steps = 24;
    float angle = rise_rad;
    for (int i = 0; i < steps; ++i) {
      angle = rise_rad - droop_rad * t * (float(i) + 0.5f) / steps;
      p += t * length / steps * glm::vec3(0, std::sin(angle), std::cos(angle));
    }
    // A shallow channel along the middle.
    const glm::vec3 up(0, std::cos(angle), -std::sin(angle));
    const float fold = 0.5f;
    p += up * fold * std::abs(x) * std::abs(x) / (0.26f * length);
    const float slope = 2.0f * fold * x / (0.26f * length);
    return shapes::SurfacePoint{p, up - glm::vec3(slope, 0, 0), {-1, 0, 0}};
  });
}

void addPlant(SceneBuilder& builder, const Detail& detail, const glm::vec3& at) {
  const int clay = builder.diffuse("pot", {0.5f, 0.22f, 0.12f});
  builder.place("pot",
                shapes::revolve({shapes::line({0.0f, 0.34f}, {0.19f, 0.34f}, 4),
                                 shapes::line({0.19f, 0.34f}, {0.19f, 0.4f}, 2),
                                 shapes::line({0.19f, 0.4f}, {0.225f, 0.4f}, 1),
                                 shapes::line({0.225f, 0.4f}, {0.16f, 0.0f}, detail(14))},
                                detail(36)),
                clay, at);
  Mesh leaves;
  leaves.uv_sets.resize(1);
  const int count = 26;
  for (int i = 0; i < count; ++i) {
    const float ring = float(i) / float(count - 1), around = 2.39996f * float(i);  // the golden angle
    const Mesh one = leaf(detail, 0.34f + 0.24f * ring, 1.45f - 0.9f * ring, 0.5f + 1.1f * ring);
    glm::mat4 placed = glm::translate(glm::mat4(1.0f), {0, 0.36f + 0.05f * (1.0f - ring), 0});
    placed = glm::rotate(placed, around, {0, 1, 0});
    placed = glm::translate(placed, {0, 0, 0.02f + 0.07f * ring});
    shapes::append(leaves, shapes::transformed(one, placed));
  }
  builder.place("leaves", std::move(leaves), leafMaterial(builder), at);
}

}  // namespace

Scene makeTextured(const Detail& detail, NamedValues&) {
  SceneBuilder builder("textured");
  const int cells = detail(84), brick = bricks(builder);
  builder.place("floor", shapes::withUvScale(shapes::ground(4, 3, cells, detail(63)), {5, 3.75f}),
                tiles(builder), {0, 0, 0.3f});
  builder.place("wall",
                shapes::withUvScale(shapes::patch({-2, 2.1f, -1.2f}, {4, 0, 0}, {0, -2.1f, 0},
                                                  shapes::steps(cells), shapes::steps(detail(44))),
                                    {10, 5.25f}),
                brick);
  addPlant(builder, detail, {-0.85f, 0, -0.45f});
  const int worn = wornPaint(builder);
  // The seam of its longitudes looks away from the camera.
  const Mesh ball = shapes::withUvScale(shapes::uvSphere(0.42f, detail(72), detail(36)), {2, 1});
  builder.place("worn ball", shapes::transformed(ball, glm::rotate(glm::mat4(1.0f), kPi, {0, 1, 0})), worn,
                {0.25f, 0.42f, 0.25f});
  builder.place("block",
                shapes::transformed(shapes::roundedBox({0.3f, 0.3f, 0.3f}, 0.02f, detail.cell(0.04f), 2),
                                    glm::rotate(glm::mat4(1.0f), 0.5f, {0, 1, 0})),
                brick, {1.15f, 0.3f, -0.35f});
  builder.camera({0.55f, 1.5f, 4.3f}, {0.05f, 0.62f, -0.2f}, 34);
  builder.sky("mild?elevation=40&azimuth=-35");
  return builder.finish();
}

}  // namespace gloam
