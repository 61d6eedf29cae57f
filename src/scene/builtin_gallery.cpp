// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A gallery of large plain surfaces: two triangles a wall, with room for a lightmap in the second set of texture coordinates.
// Light that is kept at vertices shows no shadow here, light that is kept at texels does.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

/// A rectangle that faces cross(edge_v, edge_u).
struct Face {
  glm::vec3 origin, edge_u, edge_v;
  glm::vec2 size() const { return {glm::length(edge_u), glm::length(edge_v)}; }
};

/// Places rectangles in rows, the highest first. Returns where each begins, in metres, and the size of all.
std::vector<glm::vec2> packed(const std::vector<Face>& faces, float gutter, glm::vec2& size) {
  std::vector<std::size_t> order(faces.size());
  float widest = 0.0f, area = 0.0f;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    order[i] = i;
    widest = std::max(widest, faces[i].size().x);
    area += faces[i].size().x * faces[i].size().y;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return faces[a].size().y > faces[b].size().y; });
  const float width = std::max(widest, std::sqrt(area));
  std::vector<glm::vec2> places(faces.size());
  glm::vec2 at(0.0f);
  float row = 0.0f;
  size = glm::vec2(0.0f);
  for (const std::size_t i : order) {
    const glm::vec2 face = faces[i].size();
    if (at.x > 0.0f && at.x + face.x > width * 1.0001f) {
      at = {0.0f, at.y + row + gutter};
      row = 0.0f;
    }
    places[i] = at;
    size = glm::max(size, at + face);
    at.x += face.x + gutter;
    row = std::max(row, face.y);
  }
  return places;
}

/// Two triangles a face. TEXCOORD_0 in metres, TEXCOORD_1 for a lightmap: each face a chart of its own, a fortieth of the map
/// between them.
Mesh plainFaces(const std::vector<Face>& faces) {
  glm::vec2 size;
  packed(faces, 0.0f, size);
  const std::vector<glm::vec2> places = packed(faces, 0.025f * std::max(size.x, size.y), size);
  Mesh mesh;
  std::vector<glm::vec2> charts;
  const std::vector<float> whole = {0.0f, 1.0f};
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Mesh face = shapes::patch(faces[i].origin, faces[i].edge_u, faces[i].edge_v, whole, whole);
    for (const glm::vec2& uv : face.uv_sets[0]) charts.push_back((places[i] + uv * faces[i].size()) / size);
    shapes::append(mesh, shapes::withUvScale(face, faces[i].size()));
  }
  mesh.uv_sets.push_back(std::move(charts));
  return mesh;
}

/// A box that stands at y = 0; without its underside, which nobody sees.
std::vector<Face> standingBox(const glm::vec3& half, float height) {
  const float x = half.x, z = half.z, h = height;
  return {{{-x, h, -z}, {2 * x, 0, 0}, {0, 0, 2 * z}},
          {{-x, h, z}, {2 * x, 0, 0}, {0, -h, 0}},
          {{x, h, -z}, {-2 * x, 0, 0}, {0, -h, 0}},
          {{-x, h, -z}, {0, 0, 2 * z}, {0, -h, 0}},
          {{x, h, z}, {0, 0, -2 * z}, {0, -h, 0}}};
}

std::vector<Face> floatingBox(const glm::vec3& half, float low, float high) {
  std::vector<Face> faces = standingBox(half, high - low);
  faces.push_back({{-half.x, 0, half.z}, {2 * half.x, 0, 0}, {0, 0, -2 * half.z}});
  for (Face& face : faces) face.origin.y += low;
  return faces;
}

constexpr float kHalfWidth = 4.0f, kBack = -3.0f, kFront = 5.6f, kHeight = 3.6f;

/// A ceiling with a long opening, and the shaft above it.
std::vector<Face> ceiling(const glm::vec2& low, const glm::vec2& high, float shaft) {
  const float x = kHalfWidth, y = kHeight;
  const auto strip = [&](float x0, float x1, float z0, float z1) {
    return Face{{x0, y, z1}, {x1 - x0, 0, 0}, {0, 0, z0 - z1}};
  };
  const float top = y + shaft, w = high.x - low.x, d = high.y - low.y;
  return {strip(-x, x, kBack, low.y),
          strip(-x, x, high.y, kFront),
          strip(-x, low.x, low.y, high.y),
          strip(high.x, x, low.y, high.y),
          {{low.x, top, low.y}, {w, 0, 0}, {0, -shaft, 0}},
          {{high.x, top, high.y}, {-w, 0, 0}, {0, -shaft, 0}},
          {{low.x, top, high.y}, {0, 0, -d}, {0, -shaft, 0}},
          {{high.x, top, low.y}, {0, 0, d}, {0, -shaft, 0}}};
}

Mesh turned(Mesh mesh, float angle_deg) {
  return shapes::transformed(std::move(mesh),
                             glm::rotate(glm::mat4(1.0f), glm::radians(angle_deg), {0, 1, 0}));
}

}  // namespace

// Eight metres wide, nearly nine deep, closed on all sides; a skylight is all its light.
Scene makeGallery(const Detail& detail, NamedValues&) {
  SceneBuilder builder("gallery");
  const int white = builder.diffuse("plaster", {0.78f, 0.77f, 0.74f});
  const int stone = builder.diffuse("floor", {0.42f, 0.38f, 0.34f});
  const int red = builder.diffuse("red wall", {0.55f, 0.09f, 0.06f});
  const int wood = builder.diffuse("wood", {0.44f, 0.27f, 0.14f});
  const float x = kHalfWidth, y = kHeight, depth = kFront - kBack;
  builder.place("floor", plainFaces({{{-x, 0, kBack}, {2 * x, 0, 0}, {0, 0, depth}}}), stone);
  builder.place("back wall", plainFaces({{{-x, y, kBack}, {2 * x, 0, 0}, {0, -y, 0}}}), white);
  builder.place("front wall", plainFaces({{{x, y, kFront}, {-2 * x, 0, 0}, {0, -y, 0}}}), white);
  builder.place("left wall", plainFaces({{{-x, y, kFront}, {0, 0, -depth}, {0, -y, 0}}}), red);
  builder.place("right wall", plainFaces({{{x, y, kBack}, {0, 0, depth}, {0, -y, 0}}}), white);
  builder.place("ceiling", plainFaces(ceiling({-2.6f, -1.6f}, {2.6f, 0.9f}, 0.3f)), white);

  builder.place("screen", turned(plainFaces(standingBox({1.15f, 0, 0.08f}, 2.3f)), 24), white,
                {-0.35f, 0, -1.75f});
  builder.place("tall plinth", plainFaces(standingBox({0.32f, 0, 0.32f}, 1.05f)), white, {-2.35f, 0, -0.7f});
  builder.place("low plinth", turned(plainFaces(standingBox({0.45f, 0, 0.45f}, 0.6f)), 18), white,
                {1.9f, 0, -0.9f});
  builder.place("bench", plainFaces(floatingBox({0.9f, 0, 0.24f}, 0.4f, 0.47f)), wood, {0.1f, 0, 1.2f});
  builder.place("left foot", plainFaces(standingBox({0.05f, 0, 0.2f}, 0.4f)), wood, {-0.55f, 0, 1.2f});
  builder.place("right foot", plainFaces(standingBox({0.05f, 0, 0.2f}, 0.4f)), wood, {0.75f, 0, 1.2f});

  const int clay = builder.diffuse("clay", {0.62f, 0.36f, 0.24f});
  const int blue = builder.diffuse("blue", {0.12f, 0.26f, 0.5f});
  builder.place("knot", shapes::torusKnot(2, 3, 0.3f, 0.13f, 0.075f, detail(160), detail(14)), clay,
                {-2.35f, 1.05f + 0.225f, -0.7f});
  builder.place("ball", shapes::icosphere(0.36f, detail(14)), blue, {1.9f, 0.6f + 0.36f, -0.9f});
  builder.camera({1.3f, 1.75f, 5.3f}, {-0.15f, 1.2f, -0.8f}, 44);
  builder.sky("mild");
  Scene scene = builder.finish();
  scene.environment.intensity = 4.0f;  // little of the sky is seen from inside
  return scene;
}

}  // namespace gloam
