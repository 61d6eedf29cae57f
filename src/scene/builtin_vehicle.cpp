// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A small car under a sky, or on a wet floor under two glowing panels: in kind of Figure 1 (c) and (d) of Segovia and Wald 2008,
// whose vehicle is a motorcycle.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/painted_textures.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kLength = 3.6f, kWheel = 0.3f, kAxle = 1.12f;

/// Height of the roof line over the sills at x = -1 (tail) … 1 (nose).
float roofAt(float x) {
  const float body = 0.42f * std::pow(1.0f - std::pow(std::abs(x), 6.0f), 0.5f) + 0.06f * (1.0f - x) * 0.5f;
  const float cabin = 0.42f * smoothStep(-0.92f, -0.5f, x) * (1.0f - smoothStep(0.05f, 0.42f, x));
  return body + cabin;
}

/// Around the body at x by an angle: a rounded section between sill and roof.
glm::vec3 bodyAt(float along, float angle) {
  const float x = 1.0f - 2.0f * along, half_height = 0.5f * roofAt(x);
  const float narrow = std::pow(1.0f - std::pow(std::abs(x), 5.0f), 0.5f);
  const auto rounded = [](float c) { return std::copysign(std::pow(std::abs(c), 0.45f), c); };
  const float up = rounded(std::sin(angle)),
              lean = 1.0f - 0.22f * smoothStep(0.1f, 1.0f, up) * half_height / 0.4f;
  return {0.5f * kLength * x, half_height * (1.0f + up), 0.74f * narrow * lean * rounded(std::cos(angle))};
}

Mesh body(const Detail& detail) {
  return shapes::surface(detail(96), detail(72), [](float u, float v) {
    const float angle = 2 * kPi * u, along = 0.003f + 0.994f * v, step = 1e-3f;
    const glm::vec3 around = bodyAt(along, angle + step) - bodyAt(along, angle - step);
    const glm::vec3 back = bodyAt(std::min(along + step, 1.0f), angle) - bodyAt(along - step, angle);
    const glm::vec3 normal = glm::cross(back, around);
    return shapes::SurfacePoint{bodyAt(along, angle), glm::normalize(normal), glm::normalize(around)};
  });
}

/// Paint, with windows where the cabin rises.
int paintwork(SceneBuilder& builder, const glm::vec3& color, float roughness) {
  const int index = builder.metal("paintwork", glm::vec3(1.0f), roughness);
  builder.material(index).metallic = 0.45f;
  builder.material(index).base_color_map.texture =
      builder.texture(paint("paintwork", 256, 256, [&](float u, float v) {
        const float x = 1.0f - 2.0f * v, up = std::sin(2 * kPi * u);
        const bool glass = x > -0.72f && x < 0.3f && up > 0.06f && up < 0.75f && std::abs(x + 0.2f) > 0.03f;
        const bool screen = x > 0.1f && x < 0.36f && up > 0.75f;
        return stored(glass || screen ? glm::vec3(0.04f, 0.05f, 0.06f) : color);
      }));
  return index;
}

void addVehicle(SceneBuilder& builder, const Detail& detail, const glm::vec3& color, float roughness,
                float turn_deg) {
  const int car = builder.node("vehicle");
  builder.at(car).rotation = glm::angleAxis(glm::radians(turn_deg), glm::vec3(0, 1, 0));
  builder.place("body", body(detail), paintwork(builder, color, roughness), {0, 0.24f, 0}, car);
  const int rubber = builder.glossy("rubber", glm::vec3(0.04f), 0.7f),
            rim = builder.metal("rims", glm::vec3(0.7f), 0.6f);
  const glm::mat4 lying = glm::rotate(glm::mat4(1.0f), 0.5f * kPi, {1, 0, 0});
  for (const float x : {-kAxle, kAxle}) {
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 hub(x, kWheel, 0.66f * side);
      builder.place("tyre",
                    shapes::transformed(shapes::torus(kWheel - 0.09f, 0.09f, detail(36), detail(14)), lying),
                    rubber, hub, car);
      builder.place("rim",
                    shapes::transformed(
                        shapes::moved(shapes::cylinder(kWheel - 0.12f, 0.08f, 0.02f, detail(28), detail(2)),
                                      {0, -0.04f, 0}),
                        lying),
                    rim, hub, car);
    }
  }
  builder.place("mirror rod", shapes::cylinder(0.012f, 1.5f, 0.003f, detail(10), detail(8)),
                builder.diffuse("aerial", glm::vec3(0.1f)), {-1.1f, 0.7f, 0.3f}, car);
}

}  // namespace

Scene makeVehicle(const Detail& detail, NamedValues& values) {
  SceneBuilder builder("vehicle");
  addVehicle(builder, detail, {0.7f, 0.12f, 0.08f}, float(values.take("roughness", 0.6, 0.3, 1)), 32.0f);
  const int slabs = builder.diffuse("slabs", {0.5f, 0.48f, 0.45f});
  builder.material(slabs).normal_map.texture =
      builder.texture(paintNormals("slab normals", 256, 256, [](float u, float v) {
        const float x = u - std::floor(u), y = v - std::floor(v);
        return 0.02f * smoothStep(0.0f, 0.05f, std::min(std::min(x, 1 - x), std::min(y, 1 - y))) +
               0.006f * tilingNoise(u * 32, v * 32, 32, 9);
      }));
  builder.place("ground", shapes::withUvScale(shapes::ground(14, 14, detail(28), detail(28)), {14, 14}),
                slabs);
  builder.camera({3.2f, 1.5f, 4.4f}, {0, 0.45f, 0}, 40);
  builder.sky("mild?elevation=38&azimuth=60");
  return builder.finish();
}

Scene makeWetFloor(const Detail& detail, NamedValues& values) {
  SceneBuilder builder("wet_floor");
  const float roughness = float(values.take("roughness", 0.55, 0.3, 1));
  addVehicle(builder, detail, {0.1f, 0.28f, 0.6f}, 0.6f, 28.0f);
  const int wet = builder.metal("wet floor", glm::vec3(0.35f, 0.36f, 0.38f), roughness);
  builder.material(wet).metallic = 0.6f;
  builder.material(wet).normal_map.texture =
      builder.texture(paintNormals("ripples", 256, 256, [](float u, float v) {
        return 0.006f * tilingNoise(u * 16, v * 16, 16, 5) + 0.004f * tilingNoise(u * 40, v * 40, 40, 6);
      }));
  builder.place("floor", shapes::withUvScale(shapes::ground(12, 10, detail(24), detail(20)), {5, 4}), wet);
  builder.place("wall", shapes::box({-6, 0, -3.6f}, {6, 3, -3.5f}, detail.cell(0.3f)),
                builder.diffuse("wall", {0.4f, 0.38f, 0.36f}));
  const glm::vec3 colors[] = {{9.0f, 7.4f, 5.2f}, {4.0f, 6.0f, 9.0f}};
  for (int i = 0; i < 2; ++i) {
    const int light = builder.diffuse(i ? "cool panel" : "warm panel", glm::vec3(0.0f));
    builder.material(light).emission = colors[i];
    const float x = i ? 0.6f : -2.4f;
    builder.place(
        i ? "cool panel" : "warm panel",
        shapes::patch({x, 2.6f, 0.4f}, {1.8f, 0, 0}, {0, 0, -0.8f}, shapes::steps(4), shapes::steps(2)),
        light);
  }
  builder.camera({3.0f, 1.35f, 4.6f}, {0, 0.5f, -0.2f}, 40);
  return builder.finish();
}

}  // namespace gloam
