// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Scenes with one right answer. Under white light from everywhere a white convex body has radiance 1, a white concave one
// tends to 1 with bounces; the inside of an open spherical bowl of albedo rho that covers the share a of its sphere has
// the direct radiance rho (1 - a) and tends to rho (1 - a) / (1 - rho a): from any inner point the bowl takes the share a
// of the cosine-weighted hemisphere, since equal areas of a sphere are seen under equal form factors.
#include <algorithm>
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

/// A closed bowl with a wall and a round rim; seen from its centre it opens at the elevation `rim_rad`.
Mesh thickBowl(float outer, float inner, float rim_rad, int rings, int segments) {
  const float middle = 0.5f * (outer + inner), wall = 0.5f * (outer - inner);
  const shapes::ProfilePoint rim{middle * std::cos(rim_rad), middle * std::sin(rim_rad)};
  return shapes::revolve(
      {shapes::joined({shapes::arc({0, 0}, inner, -0.5f * kPi, rim_rad, rings),
                       shapes::arc(rim, wall, rim_rad + kPi, rim_rad, std::max(4, rings / 5)),
                       shapes::arc({0, 0}, outer, rim_rad, -0.5f * kPi, rings)})},
      segments);
}

}  // namespace

Scene makeFurnace(const Detail& detail, NamedValues&) {
  SceneBuilder builder("furnace");
  builder.place("sphere", shapes::icosphere(1.0f, detail(24)), builder.diffuse("white", glm::vec3(1.0f)));
  builder.camera({0, 0, 5}, {0, 0, 0}, 30);
  builder.sky("uniform");
  return builder.finish();
}

Scene makeConcaveFurnace(const Detail& detail, NamedValues&) {
  SceneBuilder builder("furnace-concave");
  builder.place("bowl", thickBowl(1.0f, 0.84f, 0.0f, detail(36), detail(108)),
                builder.diffuse("white", glm::vec3(1.0f)));
  builder.camera({0, 3.2f, 3.2f}, {0, -0.35f, 0}, 30);
  builder.sky("uniform");
  return builder.finish();
}

Scene makeBowl(const Detail& detail, NamedValues& values) {
  const float coverage = float(values.take("coverage", 0.5, 0.05, 0.95));
  const float albedo = float(values.take("albedo", 0.5, 0, 1));
  SceneBuilder builder("bowl");
  const int material = builder.diffuse("inside", glm::vec3(albedo));
  builder.material(material).double_sided = true;
  builder.place("bowl", shapes::bowl(1.0f, coverage, detail(32)), material);
  builder.camera({0, 4.6f, 0.9f}, {0, -0.2f, 0}, 30);
  builder.sky("uniform");
  return builder.finish();
}

}  // namespace gloam
