// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of sets against closed forms, and against plain gathering.
#include <gloam/lights.h>

#include "math/sampling.h"
#include "vpls/walks_test_stage.h"

namespace gloam::vpls {
namespace {

// 4 pi I leaves a lamp; after b walls of albedo rho in a closed box, rho^b of it. Each set holds all of it.
TEST(Walks, EachBounceInAClosedBoxHoldsItsPower) {
  const glm::vec3 albedo{0.9f, 0.5f, 0.25f};
  const Made made =
      make(boxWithLamp(albedo, {0.3f, -0.2f, 0.5f}), {.sets = 16, .indirect = 60, .bounces = 4});
  ASSERT_EQ(made.sets.size(), 16u);
  for (std::size_t s = 0; s < 16; ++s) {
    glm::vec3 want = 4.0f * kPi * glm::vec3(3, 2, 1);
    for (std::uint32_t b = 1; b <= 4; ++b) {
      want *= albedo;
      expectNear(made.flux(s, b), want, 1e-4f, "set " + std::to_string(s) + ", bounce " + std::to_string(b));
    }
    EXPECT_EQ(made.sets[s].lamps, 1u);
    EXPECT_EQ(made.sets[s].direct, 1u);
    EXPECT_LE(made.sets[s].count, 114u);
    EXPECT_GE(made.sets[s].count, 55u);
  }
}

TEST(Walks, WhatGlowsInABoxLightsItWithAllItsPower) {
  SceneBuilder builder("glowing");
  addBox(builder, glm::vec3(0.5f));
  const int glow = builder.diffuse("glow", glm::vec3(0.0f));
  builder.material(glow).emission = {5, 3, 1};
  builder.place("square", squareAt(0.2f, 0.1f), glow);
  const Made made = make(builder.finish(), {.sets = 4, .indirect = 32, .bounces = 2});
  for (std::size_t s = 0; s < 4; ++s) {
    expectNear(made.flux(s, 1), 0.5f * 2.0f * kPi * 0.16f * glm::vec3(5, 3, 1), 1e-4f, "first");
    glm::vec3 direct(0.0f);
    for (const WalkVpl& row : made.of(s).first(made.sets[s].direct)) direct += row.light;
    expectNear(direct, 0.16f * glm::vec3(5, 3, 1), 1e-4f, "square metres times radiance");
  }
}

TEST(Walks, SpotsSendWhatTheirConeHolds) {
  Scene scene = boxWithLamp(glm::vec3(1.0f), {0, 0, 0}, Light::Type::kSpot);
  for (const float outer_deg : {20.0f, 60.0f, 100.0f}) {
    scene.lights[0].inner_cone_rad = glm::radians(0.5f * outer_deg);
    scene.lights[0].outer_cone_rad = glm::radians(outer_deg);
    const float cos_inner = std::cos(0.5f * glm::radians(outer_deg)),
                cos_outer = std::cos(glm::radians(outer_deg));
    const glm::vec3 want =
        2.0f * kPi * glm::vec3(3, 2, 1) * ((1.0f - cos_inner) + (cos_inner - cos_outer) / 3.0f);
    const Made made = make(scene, {.sets = 1, .indirect = 1024, .bounces = 1});
    expectNear(made.flux(0, 1), want, 0.01f, std::to_string(outer_deg));
  }
}

// Below the middle of the square: four times a quarter's form factor to a parallel element at its corner.
TEST(Walks, AreaLightAgainstItsFormFactor) {
  const glm::vec3 radiance{4, 2, 1};
  const float root = std::sqrt(2.0f);
  const glm::vec3 want =
      4.0f * radiance * (1.0f / root) * std::atan(1.0f / root);  // pi L 4 / (2 pi) (2 / root) atan(1 / root)
  const Made made = make(glowingSquare(radiance), {.sets = 64, .direct = 16, .indirect = 0, .bounces = 0});
  glm::vec3 mean(0.0f);
  float squares = 0.0f;
  for (std::size_t s = 0; s < 64; ++s) {
    const glm::vec3 got = irradiance(made.of(s), {0, 0, 0}, {0, 1, 0});
    expectNear(got, want, 0.3f, "set " + std::to_string(s));
    mean += got / 64.0f;
    squares += (got.r - want.r) * (got.r - want.r) / 64.0f;
  }
  // Sets know of each other: the mean of all errs by less than a mean of strangers, a root of 64 less than each.
  expectNear(mean, want, 0.003f, "all");
  EXPECT_LT(std::abs(mean.r - want.r), 2.0f * std::sqrt(squares) / 8.0f + 1e-4f);
  for (std::size_t s = 1; s < 64; ++s) EXPECT_NE(made.of(s)[0].end.position, made.of(0)[0].end.position);
}

TEST(Walks, EvenSkyLightsAPlaneFromBothSides) {
  SceneBuilder builder("sky");
  builder.place("floor", squareAt(2.0f, 0.0f), builder.diffuse("floor", glm::vec3(0.5f)));
  Scene scene = builder.finish();
  scene.environment.name = "even";
  scene.environment.width = 64;
  scene.environment.height = 32;
  scene.environment.radiance.assign(64 * 32, glm::vec3(2.0f));
  const Made made = make(scene, {.sets = 64, .direct = 16, .indirect = 16, .bounces = 1, .focus = false});
  glm::vec3 facing(0.0f), lit(0.0f);
  for (std::size_t s = 0; s < 64; ++s) {
    const auto direct = made.of(s).first(made.sets[s].direct);
    EXPECT_EQ(direct.size(), 16u);
    facing += irradiance(direct, {0, 0, 0}, glm::normalize(glm::vec3(1, 2, 3))) / 64.0f;
    lit += made.flux(s, 1) / 64.0f;
  }
  expectNear(facing, glm::vec3(2.0f * kPi), 0.01f, "pi L");
  expectNear(lit, glm::vec3(2.0f * 16.0f * 0.5f * 2.0f * kPi), 0.01f, "both sides");
}

// A sun of one texel, brighter than half floats hold, takes its part of the rows and no more, and keeps its light.
TEST(Walks, SmallSunKeepsItsLight) {
  SceneBuilder builder("sun");
  builder.place("floor", squareAt(2.0f, 0.0f), builder.diffuse("floor", glm::vec3(0.5f)));
  Scene scene = builder.finish();
  Environment& sky = scene.environment;
  sky.name = "sun";
  sky.width = 256;
  sky.height = 128;
  sky.radiance.assign(256 * 128, glm::vec3(0.2f));
  sky.radiance[30 * 256 + 40] = glm::vec3(1e6f, 5e5f, 1e5f);
  sky.rotation_rad = 1.0f;
  const float row = kPi / 128.0f;
  const float solid_angle = (std::cos(30.0f * row) - std::cos(31.0f * row)) * 2.0f * kPi / 256.0f;
  const glm::vec3 sun = solid_angle * glm::vec3(1e6f, 5e5f, 1e5f);
  const Made made = make(scene, {.sets = 16, .direct = 32, .indirect = 0, .bounces = 0});
  glm::vec3 bright(0.0f), rest(0.0f);
  int suns = 0;
  for (const WalkVpl& light : made.rows) {
    const bool is_sun = light.light.r > 2.0f * light.light.b;
    (is_sun ? bright : rest) += light.light / 16.0f;
    suns += is_sun ? 1 : 0;
  }
  expectNear(bright, sun, 0.02f, "sun");
  expectNear(rest, glm::vec3(0.2f * 4.0f * kPi), 0.05f, "sky");
  EXPECT_GT(suns, 16 * 12);
  EXPECT_LT(suns, 16 * 20);
  const float sine = std::sin(kPi * (0.5f - 30.5f / 128.0f)),
              angle = (40.5f / 256.0f - 0.5f) * 2.0f * kPi - 1.0f;
  const float across = std::sqrt(1.0f - sine * sine);
  for (const WalkVpl& light : made.rows) {
    if (light.light.r > 2.0f * light.light.b) {
      EXPECT_GT(
          glm::dot(light.end.position, glm::vec3(across * std::cos(angle), sine, across * std::sin(angle))),
          0.999f);
    }
  }
}

TEST(Walks, SunsAndDiscs) {
  SceneBuilder builder("sun");
  builder.place("floor", squareAt(2.0f, 0.0f), builder.diffuse("floor", glm::vec3(0.5f)));
  builder.light(lampOf(Light::Type::kDirectional), {0, 5, 0}, glm::normalize(glm::vec3(1, -1, 0)));
  Scene scene = builder.finish();
  const glm::vec3 lit = 0.5f * 16.0f / std::sqrt(2.0f) * glm::vec3(3, 2, 1);
  Made made = make(scene, {.sets = 4, .direct = 8, .indirect = 4096, .bounces = 1});  // about what is seen
  for (std::size_t s = 0; s < 4; ++s) expectNear(made.flux(s, 1), lit, 0.02f, "lit");
  made = make(scene, {.sets = 4, .direct = 8, .indirect = 64, .bounces = 1, .focus = false});
  for (std::size_t s = 0; s < 4; ++s) {
    ASSERT_EQ(made.sets[s].lamps, 1u);
    expectNear(irradiance(made.of(s).first(1), {0, 0, 0}, {0, 1, 0}), glm::vec3(3, 2, 1) / std::sqrt(2.0f),
               1e-4f, "sun");
    expectNear(made.flux(s, 1), lit, 1e-3f, "lit");
  }
  const std::string disc[] = {"disc?azimuth=30&elevation=50&radius=4&irradiance=3"};
  scene.lights[0].intensity = glm::vec3(0.0f);
  scene.environment = describeLights(AnimatedLights::parse(disc).at(0.0f));
  made = make(scene, {.sets = 4, .direct = 8, .indirect = 0, .bounces = 0});
  for (std::size_t s = 0; s < 4; ++s) {
    EXPECT_EQ(made.sets[s].lamps, 0u);
    glm::vec3 sum(0.0f);
    for (const WalkVpl& row : made.of(s)) sum += row.light;
    expectNear(sum, glm::vec3(3.0f), 0.01f, "disc");
  }
}

// ---- Against plain gathering --------------------------------------------------------------------------------------

/// Light that arrives at a point by up to `bounces` surfaces, by paths from the point (cosine-weighted); lamps apart.
struct Gathering {
  const visibility::HostWorld& world;
  glm::vec3 lamp, intensity;

  glm::vec3 albedo(const trace::Hit& hit) const { return glm::vec3(material(hit).base_color); }
  const Material& material(const trace::Hit& hit) const {
    const Scene& scene = world.scene();
    const auto mesh = std::size_t(world.posed().instances[std::size_t(hit.instance)].mesh);
    return scene.materials[std::size_t(scene.meshes[mesh].material)];
  }
  glm::vec3 fromLamp(const glm::vec3& place, const glm::vec3& normal) const {
    const glm::vec3 between = lamp - place;
    const float distance = glm::length(between), cosine = glm::dot(between, normal) / distance;
    if (cosine <= 0.0f || world.tracer().occluded(trace::Ray{place, between / distance, 0.0f, distance}))
      return glm::vec3(0.0f);
    return intensity * cosine / (distance * distance);
  }
  glm::vec3 irradiance(const glm::vec3& place, const glm::vec3& normal, int bounces, int rays,
                       sampling::Rng& rng) const {
    glm::vec3 sum(0.0f);
    for (int i = 0; i < rays; ++i) {
      const glm::vec3 way = sampling::frame(normal) * sampling::cosineHemisphere(rng.next2());
      const trace::Hit hit = world.tracer().closest({place, way});
      if (!hit) continue;
      sum += kPi * material(hit).emission;
      if (bounces == 0) continue;
      const glm::vec3 side =
          glm::dot(hit.geometric_normal, way) > 0.0f ? -hit.geometric_normal : hit.geometric_normal;
      sum += albedo(hit) * irradiance(place + hit.distance * way + 1e-4f * side, side, bounces - 1, 1, rng);
    }
    return sum / float(rays) + fromLamp(place, normal);
  }
};

// Walks and visibility together, in a room with a lamp, a ceiling light and a box in the way.
TEST(Walks, LightOfARoomIsWhatPathsFromTheReceiverFind) {
  SceneBuilder builder("room");
  addBox(builder, {0.7f, 0.5f, 0.3f});
  const int glow = builder.diffuse("glow", glm::vec3(0.0f));
  builder.material(glow).emission = {6, 5, 4};
  builder.place("light", squareAt(0.3f, 0.8f), glow);
  builder.place("block", shapes::roundedBox({0.25f, 0.25f, 0.25f}, 0.02f, 0.25f, 1),
                builder.diffuse("block", glm::vec3(0.6f)), {0.3f, 0, 0});
  const glm::vec3 lamp(-0.5f, -0.3f, 0.4f), intensity(0.6f, 0.8f, 1.0f);
  builder.light(lampOf(Light::Type::kPoint, intensity), lamp);
  const Scene scene = builder.finish();
  std::vector<visibility::SightPoint> points;
  const std::pair<glm::vec3, glm::vec3> places[] = {{{0.0f, -0.9f, 0.0f}, {0, 1, 0}},
                                                    {{0.5f, -0.9f, 0.0f}, {0, 1, 0}},
                                                    {{-0.9f, 0.2f, -0.3f}, {1, 0, 0}},
                                                    {{0.6f, 0.0f, 0.6f}, {0, 0, -1}}};
  constexpr int kSets = 64;
  for (const auto& [place, normal] : places) {
    for (std::uint32_t s = 0; s < kSets; ++s) points.push_back({place, 1e-4f, normal, s});
  }
  Stage stage(scene);
  Walks walks;
  gpu::BufferRef visible;
  stage.frame.draw(
      pose(scene, 0.0f), frame::cameraAt({0, 3, 6}, {0, 0, 0}), {.width = 8, .height = 8},
      [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
        walks = stage.walker.record(
            graph, inputs, {.sets = kSets, .direct = 32, .indirect = 96, .bounces = 2}, stage.sight.world());
        const visibility::Question question{.points = graph.upload("test.points", points),
                                            .point_count = std::uint32_t(points.size()),
                                            .lights = walks.rows,
                                            .light_bytes = sizeof(WalkVpl),
                                            .sets = walks.sets,
                                            .set_count = walks.set_count,
                                            .words = walks.words()};
        visible =
            stage.sight.record(graph, "test.visibility", inputs.scene, question, visibility::Means::kHost);
        return frame::Lighting{};
      });
  const auto rows = walks.rows.buffer().download<WalkVpl>();
  const auto sets = walks.sets.buffer().download<SightSet>();
  const auto bits = visible.buffer().download<std::uint32_t>();
  const Gathering gathering{stage.sight.world(), lamp, intensity};
  sampling::Rng rng(3);
  for (std::size_t k = 0; k < std::size(places); ++k) {
    glm::vec3 got(0.0f), way;
    for (std::size_t p = k * kSets; p < (k + 1) * kSets; ++p) {
      const SightSet& set = sets[points[p].set];
      for (std::uint32_t i = 0; i < set.count; ++i) {
        if ((bits[i / 32 * points.size() + p] >> (i % 32) & 1u) == 0) continue;
        const glm::vec3 light = walkIrradiance(rows[set.first + i], points[p].position, way);
        got += light * std::max(0.0f, glm::dot(way, points[p].normal)) / float(kSets);
      }
    }
    const auto& [place, normal] = places[k];
    expectNear(got, gathering.irradiance(place + 1e-4f * normal, normal, 2, 30000, rng), 0.03f,
               "place " + std::to_string(k));
  }
}

}  // namespace
}  // namespace gloam::vpls
