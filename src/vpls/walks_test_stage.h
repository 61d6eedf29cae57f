// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// For tests of walks: scenes with known light, and the sets that are made of them.
#pragma once

#include <numbers>

#include "frame/test_frame.h"
#include "visibility/host_world.h"
#include "vpls/walks.h"

namespace gloam::vpls {

using visibility::SightSet;

inline constexpr float kPi = std::numbers::pi_v<float>;

struct Made {
  std::vector<WalkVpl> rows;
  std::vector<SightSet> sets;
  std::uint32_t stride = 0;
  std::span<const WalkVpl> of(std::size_t s) const {
    return std::span(rows).subspan(sets[s].first, sets[s].count);
  }
  /// Watts that leave surfaces in a set, at one bounce.
  glm::vec3 flux(std::size_t s, std::uint32_t bounce) const {
    glm::vec3 sum(0.0f);
    for (const WalkVpl& row : of(s)) sum += row.bounce == bounce ? kPi * row.light : glm::vec3(0.0f);
    return sum;
  }
};

/// A walker and a scene, frame after frame.
struct Stage {
  explicit Stage(const Scene& scene) : frame(scene), sight(gpu::testDevice()) {}
  Made make(const Scene& scene, const WalkOptions& options, float time_s = 0.0f) {
    Walks walks;
    frame.draw(pose(scene, time_s), frame::cameraAt({0, 3, 6}, {0, 0, 0}), {.width = 8, .height = 8},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 walks = walker.record(graph, inputs, options, sight.world());
                 return frame::Lighting{};
               });
    Made made;
    made.stride = walks.stride;
    if (walks.set_count == 0) return made;
    made.rows = walks.rows.buffer().download<WalkVpl>();
    made.sets = walks.sets.buffer().download<SightSet>();
    return made;
  }
  frame::TestFrame frame;
  visibility::Visibility sight;
  Walker walker;
};

inline Made make(const Scene& scene, const WalkOptions& options) {
  return Stage(scene).make(scene, options);
}

inline glm::vec3 irradiance(std::span<const WalkVpl> rows, const glm::vec3& place, const glm::vec3& normal) {
  glm::vec3 sum(0.0f), way;
  for (const WalkVpl& row : rows) {
    const glm::vec3 light = walkIrradiance(row, place, way);
    sum += light * std::max(0.0f, glm::dot(way, normal));
  }
  return sum;
}

inline Light lampOf(Light::Type type, const glm::vec3& intensity = {3, 2, 1}) {
  Light light;
  light.name = "lamp";
  light.type = type;
  light.intensity = intensity;
  return light;
}

inline Mesh squareAt(float half, float height) {
  return shapes::patch({-half, height, half}, {1, 0, 0}, {0, 0, -1}, {0.0f, half, 2 * half},
                       {0.0f, half, 2 * half});
}

inline void addBox(SceneBuilder& builder, const glm::vec3& albedo) {
  builder.place("box", shapes::roundedBox({1, 1, 1}, 0.05f, 0.5f, 2), builder.diffuse("white", albedo));
}

inline Scene boxWithLamp(const glm::vec3& albedo, const glm::vec3& lamp,
                         Light::Type type = Light::Type::kPoint) {
  SceneBuilder builder("box");
  addBox(builder, albedo);
  builder.light(lampOf(type), lamp);
  return builder.finish();
}

/// A square of side 2 that glows, a metre above a plane.
inline Scene glowingSquare(const glm::vec3& radiance, const glm::vec3& albedo = glm::vec3(0.5f)) {
  SceneBuilder builder("square");
  const int glow = builder.diffuse("glow", glm::vec3(0.0f));
  builder.material(glow).emission = radiance;
  builder.place("square", squareAt(1.0f, 1.0f), glow);
  builder.place("floor", squareAt(4.0f, 0.0f), builder.diffuse("floor", albedo));
  return builder.finish();
}

inline void expectNear(const glm::vec3& got, const glm::vec3& want, float relative, const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], relative * want[c] + 1e-7f) << what << ", " << c;
}

}  // namespace gloam::vpls
