// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What sets are: steady, apart, chosen, and what becomes of odd numbers.
#include <tbb/global_control.h>

#include <cstring>

#include "math/sampling.h"
#include "shaders/vpls_test_shaders.h"
#include "vpls/walks_test_stage.h"

namespace gloam::vpls {
namespace {

// Most lights stay where they are, or nearly, when a lamp moves by a millimetre; none appears, none goes.
TEST(WalkSets, LightsGlide) {
  Scene scene = boxWithLamp(glm::vec3(0.7f), {0.3f, -0.2f, 0.5f});
  Stage stage(scene);
  const WalkOptions options{.sets = 16, .indirect = 48, .bounces = 3};
  const Made before = stage.make(scene, options);
  for (Node& node : scene.nodes) {
    if (node.light != kNone) node.translation.x += 1e-3f;
  }
  const Made after = stage.make(scene, options);
  ASSERT_EQ(before.rows.size(), after.rows.size());
  int far = 0, all = 0;
  for (std::size_t i = 0; i < before.rows.size(); ++i) {
    EXPECT_EQ(before.rows[i].end.kind, after.rows[i].end.kind);
    if (before.rows[i].end.kind != visibility::kSightSurface) continue;
    ++all;
    far += glm::distance(before.rows[i].end.position, after.rows[i].end.position) > 0.01f ? 1 : 0;
    expectNear(after.rows[i].light, before.rows[i].light, 1e-4f, "flux");
  }
  EXPECT_GT(all, 16 * 40);
  EXPECT_LT(far, all / 20);
  const Made again = stage.make(scene, options);
  EXPECT_EQ(std::memcmp(after.rows.data(), again.rows.data(), after.rows.size() * sizeof(WalkVpl)), 0);
}

TEST(WalkSets, SameLightsOnAnyNumberOfThreads) {
  const Scene scene = glowingSquare({4, 2, 1});
  const WalkOptions options{.sets = 64, .direct = 16, .indirect = 32, .bounces = 3};
  const Made many = make(scene, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Made few = make(scene, options);
  ASSERT_EQ(many.rows.size(), few.rows.size());
  EXPECT_EQ(std::memcmp(many.rows.data(), few.rows.data(), few.rows.size() * sizeof(WalkVpl)), 0);
}

TEST(WalkSets, ManyLampsAreChosenByPower) {
  SceneBuilder builder("lamps");
  builder.place("floor", squareAt(2.0f, 0.0f), builder.diffuse("floor", glm::vec3(0.5f)));
  glm::vec3 all(0.0f);
  for (int i = 0; i < 40; ++i) {
    const glm::vec3 intensity = float(i % 7 + 1) * glm::vec3(1.0f, 0.5f, 0.2f);
    builder.light(lampOf(Light::Type::kPoint, intensity), {float(i), 2, 0});
    all += intensity;
  }
  const Made made = make(builder.finish(), {.sets = 64, .direct = 0, .indirect = 0, .most_lamps = 8});
  glm::vec3 sum(0.0f);
  for (std::size_t s = 0; s < 64; ++s) {
    EXPECT_EQ(made.sets[s].lamps, 8u);
    for (const WalkVpl& row : made.of(s)) sum += row.light / 64.0f;
  }
  expectNear(sum, all, 1e-3f, "all");
}

TEST(WalkSets, TexturesGlowAndHolesLetPass) {
  SceneBuilder builder("half");
  const int glow = builder.diffuse("glow", glm::vec3(0.0f));
  const int map = builder.texture({"half", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
  builder.material(glow).emission = glm::vec3(4.0f);
  builder.material(glow).emission_map.texture = map;
  builder.material(glow).emission_map.nearest = true;
  Mesh square = squareAt(1.0f, 0.5f);
  square.uv_sets.assign(1, {});
  for (const glm::vec3& p : square.positions) square.uv_sets[0].emplace_back(0.5f * (p.x + 1.0f), 0.5f);
  builder.place("square", square, glow);
  const int fence = builder.diffuse("fence", glm::vec3(0.5f));
  builder.material(fence).alpha_mask = true;
  builder.material(fence).base_color.a = 0.0f;
  builder.place("fence", squareAt(3.0f, 0.3f), fence);
  builder.place("floor", squareAt(30.0f, 0.0f), builder.diffuse("floor", glm::vec3(1.0f)));
  const Made made = make(builder.finish(), {.sets = 16, .direct = 16, .indirect = 32, .bounces = 1});
  glm::vec3 direct(0.0f);
  for (std::size_t s = 0; s < 16; ++s) {
    for (const WalkVpl& row : made.of(s)) {
      if (row.bounce == 0) {
        direct += row.light / 16.0f;
        EXPECT_LE(row.end.position.x, 1e-4f);
      } else {
        EXPECT_NEAR(row.end.position.y, 0.0f, 1e-4f);
      }
    }
  }
  expectNear(direct, glm::vec3(2.0f * 4.0f), 0.02f, "half of it");
}

TEST(WalkSets, NoLightNoRows) {
  Scene dark = boxWithLamp(glm::vec3(0.5f), {0, 0, 0});
  dark.lights[0].intensity = glm::vec3(0.0f);
  for (const Scene& scene :
       {dark, glowingSquare(glm::vec3(0.0f)), glowingSquare({1, 1, 1}, glm::vec3(0.0f))}) {
    const Made made = make(scene, {.sets = 4, .direct = 8, .indirect = 8, .bounces = 2});
    ASSERT_EQ(made.sets.size(), 4u);
    for (std::size_t s = 0; s < 4; ++s) {
      for (const WalkVpl& row : made.of(s)) EXPECT_EQ(row.bounce, 0u);
      if (scene.name == "box") {
        EXPECT_EQ(made.sets[s].count, 0u);
      }
    }
  }
}

TEST(WalkSets, OddNumbersHaveAnswers) {
  const Scene scene = boxWithLamp(glm::vec3(0.5f), {0.1f, 0, 0});
  EXPECT_TRUE(make(scene, {.sets = 0}).sets.empty());
  EXPECT_TRUE(make(scene, {.sets = 4, .direct = 0, .indirect = 0, .most_lamps = 0}).sets.empty());
  EXPECT_THROW(make(scene, {.sets = 257}), Error);
  EXPECT_THROW(make(scene, {.sets = 4, .direct = -1}), Error);
  EXPECT_THROW(make(scene, {.sets = 4, .candidates = 0}), Error);
  EXPECT_THROW(make(scene, {.sets = 256, .indirect = 1 << 20}), Error);
  try {
    make(scene, {.sets = 256, .indirect = 1000, .candidates = 64});
    ADD_FAILURE() << "too many rows";
  } catch (const Error& error) {
    for (const char* named : {"256 sets", "direct 16", "indirect 1000", "bounces 1", "candidates 64"})
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
  }
  const Made many = make(scene, {.sets = 1, .direct = 0, .indirect = 100000, .bounces = 3});
  EXPECT_GT(many.sets.at(0).count, 99900u);
  expectNear(many.flux(0, 3), 4.0f * kPi * 0.125f * glm::vec3(3, 2, 1), 1e-3f, "third");
  const Made few =
      make(scene, {.sets = 4, .direct = 0, .indirect = 2, .bounces = 8});  // fewer rows than bounces
  expectNear(few.flux(3, 2), 4.0f * kPi * 0.25f * glm::vec3(3, 2, 1), 1e-4f, "second");
}

TEST(WalkSets, ShadersEvaluateThemAlike) {
  std::vector<WalkVpl> rows(64);
  std::vector<glm::vec3> places;
  sampling::Rng rng(5);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    WalkVpl& row = rows[i];
    row.end.kind = std::uint32_t(i % 4);
    row.end.position = row.end.kind == visibility::kSightDirectional ? sampling::uniformSphere(rng.next2())
                                                                     : 2.0f * rng.next3();
    row.end.normal = sampling::uniformSphere(rng.next2());
    row.light = rng.next3();
    row.bound = 0.1f * rng.next();
    row.cos_inner = i % 8 < 4 ? -1.0f : 0.9f;
    row.cos_outer = i % 8 < 4 ? -2.0f : 0.1f;
    row.range = i % 3 == 0 ? 0.0f : 2.0f;
    if (i < 16) places.push_back(2.0f * rng.next3());
  }
  gpu::Device& device = gpu::testDevice();
  gpu::FrameGraph graph(device);
  graph.begin();
  const auto out = graph.create(
      "test.arriving", gpu::BufferDesc{.bytes = rows.size() * places.size() * 2 * sizeof(glm::vec3)});
  graph.compute("test.arriving", walks_arriving_spv)
      .read("rows", graph.upload("test.rows", rows))
      .read("places", graph.upload("test.places", places))
      .write("arriving", out)
      .dispatchOver(int(rows.size()), int(places.size()));
  graph.execute();
  graph.wait();
  const auto got = out.buffer().download<glm::vec3>();
  for (std::size_t k = 0; k < rows.size() * places.size(); ++k) {
    glm::vec3 way;
    expectNear(got[2 * k], walkIrradiance(rows[k % rows.size()], places[k / rows.size()], way), 1e-4f,
               "irradiance");
    EXPECT_LT(glm::distance(got[2 * k + 1], way), 1e-5f);
  }
}

// All of it does from afar; nearer than the disc is wide, more of it than under a bound alone, and hardly more than there is.
TEST(WalkSets, LightOfALitSurfaceReachesWhatFacesIt) {
  WalkVpl row{};
  row.end.kind = visibility::kSightSurface;
  row.end.normal = glm::vec3(0.0f, 0.0f, -1.0f);
  row.light = glm::vec3(1.0f / kPi);  // flux 1
  row.bound = 0.04f;
  const float radius = std::sqrt(row.bound);
  for (const auto& [height, least, most] : {std::array{0.25f, 0.29f, 0.32f}, std::array{0.5f, 0.7f, 0.73f},
                                            std::array{1.0f, 1.0f, 1.09f}, std::array{4.0f, 1.0f, 1.01f}}) {
    row.end.position = glm::vec3(0.0f, 0.0f, height * radius);
    double flux = 0.0;
    constexpr int kRings = 4000;
    for (int i = 0; i < kRings; ++i) {  // of equal angles
      const float angle = 0.5f * kPi * (float(i) + 0.5f) / float(kRings),
                  x = height * radius * std::tan(angle),
                  wide = height * radius * 0.5f * kPi / float(kRings) / (std::cos(angle) * std::cos(angle));
      glm::vec3 way;
      const glm::vec3 light = walkIrradiance(row, glm::vec3(x, 0.0f, 0.0f), way);
      flux += double(light.x * way.z * 2.0f * kPi * x * wide);
    }
    EXPECT_GT(flux, least) << height;
    EXPECT_LT(flux, most) << height;
  }
}

// A corner under a small lamp, and far away, out of sight, thirty brighter ones: rows go to the corner, and its light stays true.
TEST(WalkSets, CandidatesAreChosenWhereTheCameraLooks) {
  SceneBuilder builder("corner");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  builder.place("floor", squareAt(1.0f, 0.0f), white);
  builder.place("wall", shapes::patch({-1, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0.0f, 2.0f}, {0.0f, 2.0f}), white);
  builder.light(lampOf(Light::Type::kPoint, glm::vec3(1.0f)), {0.2f, 1.0f, 0.3f});
  for (int i = 0; i < 30; ++i) {
    builder.place("far", squareAt(1.0f, 0.0f), white, {100.0f + 3.0f * float(i), 0, 0});
    builder.light(lampOf(Light::Type::kPoint, glm::vec3(3.0f)), {100.0f + 3.0f * float(i), 1, 0});
  }
  const Scene scene = builder.finish();
  const glm::vec3 place(0.1f, 0.4f, -1.0f), normal(0, 0, 1);
  constexpr std::size_t kSets = 64;
  const auto measured = [&](const WalkOptions& options, float want, float& mean) {
    const Made made = make(scene, options);
    float squares = 0.0f;
    mean = 0.0f;
    for (std::size_t s = 0; s < made.sets.size(); ++s) {
      const auto rows = made.of(s).subspan(made.sets[s].direct);
      const float light = irradiance(rows, place, normal).r;
      mean += light / float(made.sets.size());
      squares += (light - want) * (light - want) / float(made.sets.size());
    }
    return std::sqrt(squares);
  };
  float want, blind_mean, chosen_mean;
  measured({.sets = 1, .indirect = 500000, .most_lamps = 40}, 0.0f, want);
  const float blind = measured({.sets = kSets, .indirect = 32, .most_lamps = 40}, want, blind_mean);
  const float chosen =
      measured({.sets = kSets, .indirect = 32, .most_lamps = 40, .candidates = 32}, want, chosen_mean);
  EXPECT_LT(chosen, 0.4f * blind);
  EXPECT_NEAR(chosen_mean, want, 3.0f * chosen / std::sqrt(float(kSets)));
  EXPECT_NEAR(blind_mean, want, 3.0f * blind / std::sqrt(float(kSets)));
}

// In a wide scene each set errs less where the camera looks, and nobody's light is lost in the mean.
TEST(WalkSets, LightFromAfarComesDownWhereTheCameraLooks) {
  SceneBuilder builder("field");
  builder.place("ground", squareAt(40.0f, 0.0f), builder.diffuse("ground", glm::vec3(0.5f)));
  builder.place("box", shapes::roundedBox({1, 1, 1}, 0.05f, 0.5f, 2),
                builder.diffuse("white", glm::vec3(0.8f)));
  builder.light(lampOf(Light::Type::kDirectional), {0, 5, 0}, glm::normalize(glm::vec3(-0.3f, -1, -1)));
  const Scene scene = builder.finish();
  constexpr int kSets = 64;
  const auto measured = [&](bool focus, int rows, float want, float& mean) {
    const Made made =
        make(scene, {.sets = kSets, .direct = 0, .indirect = rows, .most_lamps = 0, .focus = focus});
    double squares = 0.0;
    mean = 0.0f;
    for (std::size_t s = 0; s < kSets; ++s) {
      const float got = irradiance(made.of(s), {0, 2, 0}, {0, -1, 0}).r;
      mean += got / float(kSets);
      squares += double(got - want) * double(got - want);
    }
    return std::sqrt(squares / kSets);
  };
  float want, focused_mean, plain_mean;
  measured(false, 16384, 0.0f, want);
  const double plain = measured(false, 64, want, plain_mean),
               focused = measured(true, 64, want, focused_mean);
  EXPECT_GT(want, 0.1f);
  EXPECT_LT(focused, 0.5 * plain);
  EXPECT_NEAR(focused_mean, want, 0.1f * want);
}

}  // namespace
}  // namespace gloam::vpls
