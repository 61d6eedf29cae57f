// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "vpls/vpls.h"

#include <numbers>

#include "frame/test_frame.h"

namespace gloam::vpls {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const glm::vec3 kIntensity{3.0f, 2.0f, 1.0f};

struct Made {
  std::vector<VplRow> rows;
  std::uint32_t count = 0, capacity = 0;
  int size = 0;
  Warnings warnings;
  glm::vec3 flux{0.0f};
};

Made make(const Scene& scene, const VplOptions& options, float time_s = 0.0f) {
  frame::TestFrame frame(scene);
  const PosedScene posed = pose(scene, time_s);
  Made made;
  Vpls vpls;
  frame.draw(posed, frame::cameraAt({0, 3, 6}, {0, 0, 0}), {.width = 16, .height = 16},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               vpls = recordVpls(graph, inputs, options);
               return frame::Lighting{};
             });
  made.capacity = vpls.capacity;
  made.size = vpls.maps.size;
  made.warnings = frame.warnings;
  if (vpls.capacity == 0) return made;
  made.rows = vpls.rows.buffer().download<VplRow>();
  made.count = vpls.count.buffer().download<std::uint32_t>().at(0);
  for (const VplRow& row : made.rows) made.flux += kPi * row.intensity;
  return made;
}

Light lampOf(Light::Type type, float inner_deg = 20.0f, float outer_deg = 40.0f) {
  Light light;
  light.name = "lamp";
  light.type = type;
  light.intensity = kIntensity;
  light.inner_cone_rad = glm::radians(inner_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

/// A square of half side 50 at height 0 of that albedo, and a lamp that shines down from above it.
Scene planeUnder(const Light& light, const glm::vec3& albedo = glm::vec3(1.0f), float height = 1.0f,
                 float half = 50.0f) {
  SceneBuilder builder("plane");
  builder.place("plane",
                shapes::patch({-half, 0, half}, {1, 0, 0}, {0, 0, -1}, {0.0f, 2 * half}, {0.0f, 2 * half}),
                builder.diffuse("white", albedo));
  Scene scene = builder.finish();
  scene.lights.push_back(light);
  Node node;
  node.light = 0;
  node.translation = {0.0f, height, 0.0f};
  node.rotation = glm::angleAxis(-0.5f * kPi, glm::vec3(1, 0, 0));  // -Z to -Y
  scene.roots.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(node);
  return scene;
}

Scene closedBox(const glm::vec3& albedo, const glm::vec3& lamp) {
  SceneBuilder builder("box");
  builder.place("box", shapes::roundedBox({1, 1, 1}, 0.05f, 0.5f, 2), builder.diffuse("white", albedo));
  builder.light(lampOf(Light::Type::kPoint), lamp);
  return builder.finish();
}

void expectNear(const glm::vec3& got, const glm::vec3& want, float relative, const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], relative * want[c] + 1e-9f) << what << ", " << c;
}

constexpr Sampling kAllSamplings[] = {Sampling::kGrid, Sampling::kQuasi, Sampling::kImportance};

// A lamp in a closed box of albedo rho: 4 pi I rho leaves its walls, wherever the lamp stands and whatever the map.
TEST(Vpls, FluxOfAClosedBoxIsAllThatTheLampSends) {
  const glm::vec3 albedo{0.9f, 0.5f, 0.25f};
  for (const int size : {16, 50, 256}) {
    for (const Sampling sampling : kAllSamplings) {
      const Made made = make(closedBox(albedo, {0.3f, -0.2f, 0.5f}),
                             {.count = 200, .map_size = size, .sampling = sampling});
      expectNear(made.flux, 4.0f * kPi * kIntensity * albedo, size == 16 ? 0.02f : 0.005f,
                 std::to_string(size) + " texels, sampling " + std::to_string(int(sampling)));
    }
  }
}

// The integral of the cone's squared ramp over its solid angle, in closed form.
TEST(Vpls, FluxOfASpotOverAWhitePlaneIsTheSpots) {
  for (const float outer : {12.0f, 40.0f, 58.0f, 75.0f}) {
    const float cos_inner = std::cos(glm::radians(0.5f * outer)), cos_outer = std::cos(glm::radians(outer));
    const glm::vec3 want = 2.0f * kPi * kIntensity * ((1.0f - cos_inner) + (cos_inner - cos_outer) / 3.0f);
    for (const int size : {32, 128}) {
      const Made made =
          make(planeUnder(lampOf(Light::Type::kSpot, 0.5f * outer, outer)), {.count = 256, .map_size = size});
      expectNear(made.flux, want, 0.005f, std::to_string(outer) + " degrees");
    }
  }
}

/// A table of 1 m, 0.8 m above the floor, under a spot at 2 m.
Scene tableUnderASpot() {
  Scene scene = planeUnder(lampOf(Light::Type::kSpot, 40.0f, 40.0f), glm::vec3(0.5f), 2.0f);
  const Mesh floor = scene.meshes.at(0);
  Mesh table = floor;
  for (glm::vec3& p : table.positions) p = {0.01f * p.x, 0.8f, 0.01f * p.z};
  scene.meshes.push_back(table);
  scene.nodes.at(0).meshes.push_back(1);
  return scene;
}

/// What the spot sends onto the table.
float fluxOnTable() {
  return 0.5f * 3.0f * 4.0f * std::atan(0.25f / (1.2f * std::sqrt(0.5f + 1.2f * 1.2f)));
}

// Cells that the edges of a table cross: their lights lie on the table or on the floor, not between, with the flux of each.
TEST(Vpls, LightsStandOnSurfacesWhereCellsHoldEdges) {
  const Made made = make(tableUnderASpot(), {.count = 256, .map_size = 256});
  int on_table = 0, on_floor = 0;
  float flux_on_table = 0.0f;
  for (std::uint32_t i = 0; i < made.count; ++i) {
    const glm::vec3 at = made.rows[i].position;
    const bool is_on_table =
        std::abs(at.y - 0.8f) < 1e-3f && std::abs(at.x) < 0.501f && std::abs(at.z) < 0.501f;
    on_table += is_on_table;
    flux_on_table += is_on_table ? kPi * made.rows[i].intensity.x : 0.0f;
    on_floor += std::abs(at.y) < 1e-3f;
  }
  EXPECT_EQ(std::uint32_t(on_table + on_floor), made.count);
  EXPECT_GT(on_table, 20);
  EXPECT_GT(on_floor, 20);
  const float cos_outer = std::cos(glm::radians(40.0f));
  EXPECT_NEAR(made.flux.x, 0.5f * 3.0f * 2.0f * kPi * (1.0f - cos_outer), 0.01f * made.flux.x);
  EXPECT_NEAR(flux_on_table, fluxOnTable(), 0.02f * flux_on_table);
}

// One light of a whole map: more texels than a loop of a shader may go over on some drivers.
TEST(Vpls, FewLightsOfLargeMapsHaveAllFlux) {
  const Scene scene = planeUnder(lampOf(Light::Type::kSpot, 40.0f, 40.0f), glm::vec3(0.5f));
  for (const int size : {256, 1024, 2048}) {
    const Made made = make(scene, {.count = 1, .map_size = size});
    const float want = 0.5f * 3.0f * 2.0f * kPi * (1.0f - std::cos(glm::radians(40.0f)));
    EXPECT_EQ(made.count, 1u) << size;
    EXPECT_NEAR(made.flux.x, want, 0.01f * want) << size;
  }
  const Made table = make(tableUnderASpot(), {.count = 4, .map_size = 2048});
  EXPECT_EQ(table.count, 8u);  // in each cell one on the table, one on the floor
  float flux_on_table = 0.0f;
  for (const VplRow& row : table.rows) flux_on_table += row.position.y > 0.79f ? kPi * row.intensity.x : 0.0f;
  EXPECT_NEAR(flux_on_table, fluxOnTable(), 0.02f * flux_on_table);
}

TEST(Vpls, FluxOfASunIsIrradianceTimesArea) {
  const Made made = make(planeUnder(lampOf(Light::Type::kDirectional), glm::vec3(0.5f), 1.0f, 2.0f),
                         {.count = 256, .map_size = 256});
  expectNear(made.flux, 0.5f * 16.0f * kIntensity, 0.01f, "sun");
}

// On a plane under a point light each virtual light is a cell: where it is, how much falls there, how large it is.
TEST(Vpls, CellsAreWhatFallsOnThem) {
  const Made made = make(planeUnder(lampOf(Light::Type::kSpot, 40.0f, 40.0f), glm::vec3(0.5f)),
                         {.count = 1024, .map_size = 256});
  ASSERT_GT(made.count, 700u);
  ASSERT_LT(made.count, 1000u);  // corners of the map are outside the cone
  const float cell = 2.0f * std::tan(glm::radians(40.0f)) / 32.0f;
  for (std::uint32_t i = 0; i < made.count; ++i) {
    const VplRow& row = made.rows[i];
    EXPECT_NEAR(row.position.y, 0.0f, 1e-4f);
    EXPECT_NEAR(row.normal.y, 1.0f, 1e-3f);
    const float radius = glm::length(row.position);
    if (radius > 0.7f) continue;  // the edge of the cone
    const float d = std::sqrt(1.0f + radius * radius);
    EXPECT_NEAR(kPi * row.intensity.x, 0.5f * 3.0f * cell * cell / (d * d * d), 0.01f * row.intensity.x);
    EXPECT_NEAR(row.bound * kPi, cell * cell, 0.01f * cell * cell);
  }
  for (std::size_t i = made.count; i < made.rows.size(); ++i)
    EXPECT_EQ(made.rows[i].intensity, glm::vec3(0.0f));
}

// As much flux on each side of a plane as by the grid, in every way of choosing; by importance all lights are alike.
TEST(Vpls, ChosenLightsFallWhereFluxIs) {
  const Scene scene = planeUnder(lampOf(Light::Type::kPoint));
  const auto momentOf = [](const Made& made) {
    float sum = 0.0f, all = 0.0f;
    for (const VplRow& row : made.rows) {
      sum += row.intensity.x * std::min(glm::length(row.position), 3.0f);
      all += row.intensity.x;
    }
    return sum / all;
  };
  const float want = momentOf(make(scene, {.count = 6000, .map_size = 256}));
  for (const Sampling sampling : kAllSamplings) {
    const Made made = make(scene, {.count = 1500, .map_size = 256, .sampling = sampling});
    EXPECT_NEAR(momentOf(made), want, 0.03f * want) << int(sampling);
  }
}

// A lamp that moves a thousandth of its height moves no light of the grid by more than a few of these, and changes no flux
// by more than a few parts in a hundred: nothing pops.
TEST(Vpls, LightsGlideWithTheirLamp) {
  Scene scene = closedBox(glm::vec3(0.8f), {0.1f, 0.2f, 0.3f});
  const VplOptions options{.count = 256, .map_size = 128};
  const Made before = make(scene, options);
  for (Node& node : scene.nodes) {
    if (node.light >= 0) node.translation += glm::vec3(1e-3f, -1e-3f, 1e-3f);
  }
  const Made after = make(scene, options);
  ASSERT_EQ(before.count, after.count);
  for (std::uint32_t i = 0; i < before.count; ++i) {
    EXPECT_LT(glm::distance(before.rows[i].position, after.rows[i].position), 0.012f) << i;
    EXPECT_NEAR(before.rows[i].intensity.x, after.rows[i].intensity.x, 0.05f * before.rows[i].intensity.x);
  }
}

TEST(Vpls, SpotsThatTurnKeepTheirAxes) {
  Warnings warnings;
  glm::vec3 right(0.0f);
  for (int i = 0; i <= 360; ++i) {
    frame::LightRow row{};
    row.kind = frame::kLightSpot;
    row.cos_outer = 0.8f;
    const float angle = glm::radians(float(i)), lean = 0.9f;  // round the vertical, shining down and out
    row.direction = {std::sin(lean) * std::cos(angle), -std::cos(lean), std::sin(lean) * std::sin(angle)};
    const auto maps = planReflectiveMaps({&row, 1}, glm::vec3(-1), glm::vec3(1), 64, 8, warnings);
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_NEAR(
        glm::dot(glm::normalize(maps[0].view.corner + 32.0f * (maps[0].view.step_x + maps[0].view.step_y)),
                 row.direction),
        1.0f, 1e-5f);
    const glm::vec3 now = glm::normalize(maps[0].view.step_x);
    if (i > 0) {
      EXPECT_GT(glm::dot(now, right), 0.99f) << i;
    }
    right = now;
  }
}

TEST(Vpls, WhatIsAskedForBadlyHasAnAnswer) {
  const VplOptions few{.count = 64, .map_size = 64};
  Light dark = lampOf(Light::Type::kPoint);
  dark.intensity = glm::vec3(0.0f);
  EXPECT_EQ(make(planeUnder(dark), few).capacity, 0u);
  EXPECT_EQ(make(planeUnder(lampOf(Light::Type::kPoint)), {.count = 0}).capacity, 0u);
  // Spots that are a line, or a hemisphere; a lamp that looks away, or stands in the plane.
  expectNear(make(planeUnder(lampOf(Light::Type::kSpot, 0.0f, 0.0f)), few).flux, glm::vec3(0.0f), 0.0f,
             "line");
  const Made half = make(planeUnder(lampOf(Light::Type::kSpot, 0.0f, 90.0f)), few);
  expectNear(half.flux, 2.0f * kPi * kIntensity / 3.0f, 0.02f, "hemisphere");
  EXPECT_EQ(make(planeUnder(lampOf(Light::Type::kSpot), glm::vec3(1.0f), -1e-9f), few).flux, glm::vec3(0.0f));
  for (const VplRow& row : half.rows) {
    EXPECT_TRUE(std::isfinite(row.intensity.x + row.position.x + row.normal.x + row.bound));
  }
  const Made away = make(planeUnder(lampOf(Light::Type::kSpot), glm::vec3(1.0f), -1.0f), few);
  EXPECT_EQ(away.count, 0u);
}

// Spots wider than a hemisphere light by a cube of maps: the same closed form.
TEST(Vpls, FluxOfSpotsWiderThanAHemisphere) {
  for (const float outer : {90.0f, 120.0f, 180.0f}) {
    Scene scene = closedBox(glm::vec3(0.5f), {0.3f, -0.2f, 0.5f});
    scene.lights.at(0) = lampOf(Light::Type::kSpot, 0.5f * outer, outer);
    const float cos_inner = std::cos(glm::radians(0.5f * outer)), cos_outer = std::cos(glm::radians(outer));
    const glm::vec3 want = kPi * kIntensity * ((1.0f - cos_inner) + (cos_inner - cos_outer) / 3.0f);
    expectNear(make(scene, {.count = 600, .map_size = 128}).flux, want, 0.01f,
               std::to_string(outer) + " degrees");
  }
}

// A lamp in a solid thing lights that from inside and nothing else.
TEST(Vpls, ALampInsideAWallLightsTheWallAlone) {
  Scene scene = planeUnder(lampOf(Light::Type::kPoint), glm::vec3(0.5f), 1.0f, 3.0f);
  Mesh box = shapes::roundedBox({0.4f, 0.4f, 0.4f}, 0.05f, 0.1f, 2);
  for (glm::vec3& p : box.positions) p.y += 1.0f;
  box.material = 0;
  scene.meshes.push_back(box);
  scene.nodes.at(0).meshes.push_back(1);
  const Made made = make(scene, {.count = 600, .map_size = 128});
  EXPECT_GT(made.count, 0u);
  for (std::uint32_t i = 0; i < made.count; ++i) {
    const VplRow& row = made.rows[i];
    EXPECT_LT(glm::distance(row.position, glm::vec3(0, 1, 0)), 0.71f);
    EXPECT_GT(glm::dot(row.normal, glm::vec3(0, 1, 0) - row.position), 0.0f);
  }
  expectNear(made.flux, 4.0f * kPi * kIntensity * 0.5f, 0.02f, "inside");
}

// What is near to a lamp is lit however far the scene reaches.
TEST(Vpls, LampsLightWhatIsNearInScenesOfAnySize) {
  for (const float half : {50.0f, 1e4f, 1e6f}) {
    const Made made = make(planeUnder(lampOf(Light::Type::kSpot, 20.0f, 40.0f), glm::vec3(1.0f), 1.0f, half),
                           {.count = 64});
    const float cos_inner = std::cos(glm::radians(20.0f)), cos_outer = std::cos(glm::radians(40.0f));
    const glm::vec3 want = 2.0f * kPi * kIntensity * ((1.0f - cos_inner) + (cos_inner - cos_outer) / 3.0f);
    expectNear(made.flux, want, 0.01f, std::to_string(half) + " m");
    for (std::uint32_t i = 0; i < made.count; ++i) EXPECT_NEAR(made.rows[i].position.y, 0.0f, 1e-3f) << half;
  }
}

TEST(Vpls, AHundredThousandLightsAreThatMany) {
  const Made made =
      make(planeUnder(lampOf(Light::Type::kSpot, 39.0f, 40.0f)), {.count = 100000, .map_size = 64});
  EXPECT_EQ(made.capacity, (2u * 316u * 316u + kVplChunk - 1) / kVplChunk * kVplChunk);
  EXPECT_GE(made.size, 632);
  EXPECT_GT(made.count, 70000u);
  for (std::uint32_t i = 1; i < made.count; i += 999) EXPECT_GT(made.rows[i].intensity.x, 0.0f);
}

// Lamps share what is asked for, cubes among their faces; what is beyond the maps is said.
TEST(Vpls, LampsShareLights) {
  frame::LightRow point{}, sun{};
  point.kind = frame::kLightPoint;
  sun.kind = frame::kLightDirectional;
  sun.direction = {0, -1, 0};
  const std::vector<frame::LightRow> lights = {point, sun};
  Warnings warnings;
  const auto maps = planReflectiveMaps(lights, glm::vec3(-1), glm::vec3(1), 64, 100, warnings);
  ASSERT_EQ(maps.size(), 7u);
  EXPECT_EQ(gridsOf(maps, 512), (std::vector<int>{7, 7, 7, 7, 7, 7, 16}));
  EXPECT_EQ(gridsOf(maps, 1), std::vector<int>(7, 1));
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(planReflectiveMaps(lights, glm::vec3(-1), glm::vec3(1), 64, 6, warnings).size(), 6u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("1 lamps send no indirect light"), std::string::npos);
}

}  // namespace
}  // namespace gloam::vpls
