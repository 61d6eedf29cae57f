// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/spherical_lights/spherical_lights.h"

#include <glm/gtc/matrix_transform.hpp>

#include "frame/test_frame.h"
#include "scene/environment.h"
#include "techniques/spherical_lights/spherical_lights_twin.h"

namespace gloam::spherical_lights {
namespace {

constexpr int kSize = 24;
using Values = std::vector<std::pair<std::string, std::string>>;

/// Balls that are their spheres, of one colour each; those of one number are one object.
struct Balls {
  struct Ball {
    glm::vec3 center;
    float radius;
    glm::vec3 albedo;
    int object;
    glm::vec3 glow{0.0f};
  };
  explicit Balls(const std::vector<Ball>& balls, const glm::mat3& turn = glm::mat3(1.0f)) {
    for (const Ball& ball : balls) {
      proxies.push_back({ball.center, ball.radius, ball.albedo});
      albedos.push_back(sh::constantSky(4, ball.albedo));
      glows.push_back(sh::constantSky(4, ball.glow));
    }
    for (const Ball& ball : balls) emission.glows = emission.glows || ball.glow != glm::vec3(0.0f);
    emission.points_each = kEmissionDirections, emission.words = 1;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      std::size_t first = i, end = i;
      while (first > 0 && balls[first - 1].object == balls[i].object) --first;
      while (end < balls.size() && balls[end].object == balls[i].object) ++end;
      emission.proxies.push_back(
          {balls[i].object, int(first), int(end - first), turn, &albedos[i], &glows[i]});
      std::uint32_t bits = 0;
      for (std::size_t j = first; j < end; ++j) {
        if (glm::distance(balls[i].center, balls[j].center) < balls[i].radius + balls[j].radius || i == j)
          bits |= 1u << (j - first);
      }
      emission.meets.push_back(bits);
      for (const glm::vec3& way : emissionDirections()) {
        const glm::vec3 n = turn * way, p = balls[i].center + balls[i].radius * n;
        bool within = false;
        for (std::size_t j = first; j < end; ++j)
          within = within || (j != i && glm::distance(p, balls[j].center) < balls[j].radius);
        emission.points.push_back({p, within ? 0.0f : 1.0f, n, 0.0f});
      }
    }
  }
  Balls(const Balls&) = delete;
  std::vector<frame::Proxy> proxies;
  std::vector<sh::ShRgb> albedos, glows;
  frame::Emission emission;
};

/// Images of one frame at full size, four floats a pixel.
struct Picture {
  std::vector<float> position, normal, direct, indirect, unblocked;
  std::vector<SentRow> sent;
  Warnings warnings;
  std::size_t pixels() const { return position.size() / 4; }
  static glm::vec3 at(const std::vector<float>& image, std::size_t i) {
    return {image[4 * i], image[4 * i + 1], image[4 * i + 2]};
  }
};

Picture draw(const Scene& scene, const PosedCamera& camera, const Balls& balls, const Values& values = {}) {
  frame::TestFrame frame(scene);
  SphericalLights technique(gpu::testDevice());
  Settings settings(info().options);
  settings.set("divisor", "1");
  settings.set("window", "none");
  for (const auto& [name, value] : values) settings.set(name, value);
  frame.draw(pose(scene, 0.0f), camera,
             {.width = kSize, .height = kSize, .proxies = balls.proxies, .emission = &balls.emission},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  return {frame.floats("frame.receiver_position_1"),
          frame.floats("frame.receiver_normal_1"),
          frame.floats("spherical_lights.direct"),
          frame.floats("spherical_lights.indirect"),
          frame.floats("spherical_lights.unblocked"),
          balls.proxies.empty()
              ? std::vector<SentRow>{}
              : frame.graph.findBuffer("spherical_lights.sent").buffer().download<SentRow>(),
          frame.warnings};
}

/// Three objects: a chain of three, a single ball, a pair that does not meet.
std::vector<Balls::Ball> company() {
  return {{{-1.5f, 0.8f, 0.2f}, 0.5f, {0.8f, 0.2f, 0.1f}, 0},
          {{-0.9f, 1.1f, 0.2f}, 0.45f, {0.7f, 0.6f, 0.1f}, 0},
          {{-0.3f, 1.6f, 0.1f}, 0.4f, {0.2f, 0.8f, 0.3f}, 0},
          {{0.6f, 0.6f, -0.4f}, 0.55f, {0.9f, 0.9f, 0.9f}, 1},
          {{1.2f, 2.0f, 0.6f}, 0.5f, {0.1f, 0.3f, 0.9f}, 2},
          {{1.6f, 0.7f, 1.1f}, 0.45f, {0.6f, 0.1f, 0.7f}, 2, {0.3f, 0.9f, 0.5f}}};
}

TEST(SphericalLights, KernelsAgreeWithTheirTwins) {
  const Scene scene = frame::planeScene("preetham?elevation=35");
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.9f, glm::normalize(glm::vec3(1, 2, -1))));
  Balls balls(company(), turn);
  balls.emission.blocking_patches = {{{0, 0, 0}, {10, 0, 0}, {0, 0, -10}, {0, 1, 0}, glm::vec3(0.5f)},
                                     {{-3, 1, 0}, {0, 0, -2}, {0, 1, 0}, {1, 0, 0}, {0.8f, 0.3f, 0.2f}}};
  for (const float x : {-6.0f, -2.0f, 2.0f, 6.0f})
    balls.emission.sending_patches.push_back(
        {{x, 0, 0.5f}, {2, 0, 0}, {0, 0, -9}, {0, 1, 0}, glm::vec3(0.5f)});
  balls.emission.sending_patches.push_back(balls.emission.blocking_patches.back());
  const sh::ShRgb light = projectEnvironment(scene.environment, 6);
  struct Way {
    const char *average, *blocking, *reuse, *visibility;
    int mode, kind;
  };
  for (const Way& way : {Way{"solid_angle", "per_object", "true", "mean", kPerObject, kMean},
                         Way{"area", "per_sphere", "true", "product", kPerSphereReused, kProduct},
                         Way{"solid_angle", "per_sphere", "false", "difference", kPerSphere, kDifference}}) {
    Rows rows = rowsOf(balls.proxies, balls.emission);
    addPatchPoints(rows);
    Twin twin(rows, light, way.average == std::string("area") ? Average::kArea : Average::kSolidAngle,
              way.mode, way.kind);
    for (std::size_t s = 0; s < balls.proxies.size(); ++s) twin.turn(s, turn);
    const Picture picture = draw(scene, frame::kAbove, balls,
                                 {{"average", way.average},
                                  {"blocking", way.blocking},
                                  {"reuse", way.reuse},
                                  {"visibility", way.visibility}});
    float brightest = 0.0f, direct_off = 0.0f, indirect_off = 0.0f, sent_off = 0.0f, most = 0.0f;
    for (std::size_t s = 0; s < balls.proxies.size(); ++s) {
      for (int i = 0; i < 16; ++i) {
        const glm::vec3 d = glm::abs(picture.sent[s].at[i] - twin.sent()[s][i]);
        sent_off = std::max({sent_off, d.x, d.y, d.z});
        most = std::max(most, picture.sent[s].at[i].x);
      }
    }
    EXPECT_LT(sent_off, 1e-4f * most);
    for (std::size_t i = 0; i < picture.pixels(); i += 61) {
      const TwinLight want =
          twin.at(Picture::at(picture.position, i), Picture::at(picture.normal, i), way.mode, way.kind);
      const glm::vec3 a = glm::abs(Picture::at(picture.direct, i) - want.direct);
      const glm::vec3 b = glm::abs(Picture::at(picture.indirect, i) - want.indirect);
      direct_off = std::max({direct_off, a.x, a.y, a.z});
      indirect_off = std::max({indirect_off, b.x, b.y, b.z});
      brightest = std::max(brightest, want.direct.x);
    }
    EXPECT_LT(direct_off, 1e-3f * brightest) << "half floats, cut toward zero";
    EXPECT_LT(indirect_off, 1e-4f * brightest) << way.average << ' ' << way.blocking << ' ' << way.visibility;
  }
}

// Under a white sky a white ball sends to each receiver what it takes.
TEST(SphericalLights, OneWhiteBallInTheWhiteFurnaceIsNotSeen) {
  const Scene scene = frame::planeScene("uniform");
  const Picture empty = draw(scene, frame::kAbove, Balls({}));
  const Balls balls({{{0.0f, 1.5f, 0.0f}, 0.8f, glm::vec3(1.0f), 0}});
  for (const auto& [average, visibility] : {std::pair("solid_angle", "mean"), std::pair("area", "product"),
                                            std::pair("solid_angle", "difference")}) {
    const Picture picture =
        draw(scene, frame::kAbove, balls, {{"average", average}, {"visibility", visibility}});
    float least = 1.0f;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      const float sum = picture.direct[4 * i] + picture.indirect[4 * i];
      ASSERT_NEAR(sum / empty.direct[4 * i], 1.0f, 0.02f) << average << ' ' << visibility;
      least = std::min(least, picture.direct[4 * i] / empty.direct[4 * i]);
    }
    EXPECT_LT(least, 0.8f) << "it takes light, too";
  }
}

TEST(SphericalLights, WhatStandsBehindIsNotSeen) {
  // A white ball straight above a black one: below both, its light is gone.
  const Scene scene = frame::planeScene("uniform");
  const Balls alone({{{0.0f, 3.0f, 0.0f}, 0.4f, glm::vec3(1.0f), 0}});
  const Balls hidden(
      {{{0.0f, 3.0f, 0.0f}, 0.4f, glm::vec3(1.0f), 0}, {{0.0f, 1.0f, 0.0f}, 0.7f, glm::vec3(0.0f), 1}});
  const std::size_t middle = (kSize / 2) * kSize + kSize / 2, corner = 0;
  for (const char* blocking : {"per_object", "per_sphere"}) {
    const Picture open = draw(scene, frame::kAbove, alone, {{"blocking", blocking}});
    const Picture behind = draw(scene, frame::kAbove, hidden, {{"blocking", blocking}});
    EXPECT_NEAR(open.indirect[4 * middle], 3.14159f * 0.4f * 0.4f / 9.0f, 0.004f);
    EXPECT_LT(behind.indirect[4 * middle], 0.25f * open.indirect[4 * middle]);
    EXPECT_GT(behind.indirect[4 * corner], 0.8f * open.indirect[4 * corner]);
    EXPECT_NEAR(behind.unblocked[4 * middle], open.unblocked[4 * middle], 0.3f * open.unblocked[4 * middle]);
  }
}

TEST(SphericalLights, WhatGlowsLightsDirectly) {
  const Scene scene = frame::planeScene("uniform");
  const Picture dark = draw(scene, frame::kAbove, Balls({{{0.0f, 3.0f, 0.0f}, 0.4f, glm::vec3(0.0f), 0}}));
  const Picture lit =
      draw(scene, frame::kAbove, Balls({{{0.0f, 3.0f, 0.0f}, 0.4f, glm::vec3(0.0f), 0, glm::vec3(5.0f)}}));
  const std::size_t middle = (kSize / 2) * kSize + kSize / 2;
  EXPECT_NEAR(lit.direct[4 * middle] - dark.direct[4 * middle], 5.0f * 3.14159f * 0.4f * 0.4f / 9.0f, 0.02f);
  EXPECT_EQ(lit.indirect[4 * middle], 0.0f);
}

// The lower of two balls lies in the upper one's shadow, and sends less of a sun's light.
TEST(SphericalLights, LightThatArrivesIsShadowed) {
  const Scene scene = frame::planeScene("preetham?elevation=89");
  const Balls low({{{0.0f, 1.0f, 0.0f}, 0.5f, glm::vec3(0.8f), 0}});
  const Balls both(
      {{{0.0f, 1.0f, 0.0f}, 0.5f, glm::vec3(0.8f), 0}, {{0.0f, 2.6f, 0.0f}, 0.9f, glm::vec3(0.8f), 1}});
  const Picture open = draw(scene, frame::kAbove, low), shaded = draw(scene, frame::kAbove, both);
  EXPECT_LT(shaded.sent[0].at[0].x, 0.75f * open.sent[0].at[0].x);
}

TEST(SphericalLights, ObjectsThatMeetAreTold) {
  const Scene scene = frame::planeScene("uniform");
  EXPECT_TRUE(draw(scene, frame::kAbove, Balls(company())).warnings.empty());
  const Picture picture =
      draw(scene, frame::kAbove,
           Balls({{{0, 1, 0}, 0.5f, glm::vec3(0.8f), 0}, {{0.4f, 1, 0}, 0.5f, glm::vec3(0.8f), 1}}));
  ASSERT_EQ(picture.warnings.size(), 1u);
  EXPECT_NE(picture.warnings[0].find("meet"), std::string::npos);
}

TEST(SphericalLights, NothingThereIsThePlainSky) {
  const Scene scene = frame::planeScene("gradient");
  const Picture picture = draw(scene, frame::kAbove, Balls({}));
  const glm::vec3 want = sh::irradiance(projectEnvironment(scene.environment, 4), {0, 1, 0});
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    ASSERT_NEAR(picture.direct[4 * i + 1], want.y, 2e-3f * want.y);
    ASSERT_EQ(picture.indirect[4 * i + 1], 0.0f);
  }
}

// Between ground and a white roof over it, what the ground sends reaches the roof: under a white sky, ground of albedo a that
// sees nothing but the sky sends a.
TEST(SphericalLights, GroundSendsItsLight) {
  SceneBuilder builder("roof");
  builder.place("roof", shapes::moved(shapes::icosphere(0.5f, 16), {0, 3, 0}),
                builder.diffuse("white", glm::vec3(1.0f)));
  builder.sky("uniform");
  const Scene scene = builder.finish();
  Balls balls({});
  balls.emission.sending_patches = {{{0, 0, 0}, {50, 0, 0}, {0, 0, -50}, {0, 1, 0}, glm::vec3(0.4f)}};
  balls.emission.blocking_patches = balls.emission.sending_patches;
  const PosedCamera from_below = frame::cameraAt({0.01f, 1.0f, 0}, {0, 3, 0}, 20);
  const Picture picture = draw(scene, from_below, balls);
  const std::size_t middle = (kSize / 2) * kSize + kSize / 2;
  EXPECT_NEAR(picture.indirect[4 * middle], 0.4f * 3.14159f, 0.02f);
  EXPECT_LT(picture.direct[4 * middle], 0.1f);  // the sky below is behind the ground
}

// Six walls around, which no light from far away meets: four bands of them leave some sky, and that goes.
TEST(SphericalLights, ClosedRoomsHaveNoSky) {
  SceneBuilder builder("ball");
  builder.place("ball", shapes::icosphere(0.5f, 16), builder.diffuse("white", glm::vec3(1.0f)));
  builder.sky("uniform");
  const Scene scene = builder.finish();
  const PosedCamera camera = frame::cameraAt({0.2f, 0.7f, 1.5f}, {0, 0, 0}, 20);
  const std::size_t middle = (kSize / 2) * kSize + kSize / 2;
  float open = 0.0f;
  for (const bool enclosed : {false, true}) {
    Balls balls({});
    for (const glm::vec3& way :
         {glm::vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}) {
      const glm::vec3 u(way.y, way.z, way.x), v(way.z, way.x, way.y);
      balls.emission.sending_patches.push_back({2.0f * way, 2.0f * u, 2.0f * v, -way, glm::vec3(0.5f)});
      balls.emission.sending_patches.back().enclosed = enclosed;
    }
    balls.emission.blocking_patches = balls.emission.sending_patches;
    for (const char* indirect : {"true", "false"}) {
      const Picture picture = draw(scene, camera, balls, {{"indirect", indirect}});
      const float direct = picture.direct[4 * middle];
      if (enclosed)
        EXPECT_LT(direct, 0.01f * open) << indirect;
      else
        open = direct;
    }
  }
  EXPECT_GT(open, 0.05f);
}

// More objects than the kernel once kept: the quick kernel, per object and per sphere, against sums written out.
TEST(SphericalLights, ManyObjectsAgreeWithTheirTwins) {
  const Scene scene = frame::planeScene("preetham?elevation=35");
  std::vector<Balls::Ball> crowd;
  for (int i = 0; i < 36; ++i) {
    const auto x = float(i % 6), z = float(i / 6);
    crowd.push_back({{1.1f * x - 2.7f, 0.6f + 0.3f * float((i * 7) % 5), 1.1f * z - 2.7f},
                     0.3f + 0.02f * float(i % 4),
                     {0.2f + 0.1f * x, 0.5f, 0.9f - 0.1f * z},
                     i});
  }
  // The last five are one chain.
  for (std::size_t i = 31; i < crowd.size(); ++i) crowd[i].object = 31, crowd[i].radius = 0.6f;
  const Balls balls(crowd);
  Rows rows = rowsOf(balls.proxies, balls.emission);
  addPatchPoints(rows);
  const Twin twin(rows, projectEnvironment(scene.environment, 6), Average::kSolidAngle, kPerObject, kMean);
  for (const char* blocking : {"per_object", "per_sphere"}) {
    const Picture picture = draw(scene, frame::kAbove, balls, {{"blocking", blocking}});
    const int mode = blocking == std::string("per_object") ? kPerObject : kPerSphereReused;
    for (std::size_t i = 30; i < picture.pixels(); i += 97) {
      const TwinLight want =
          twin.at(Picture::at(picture.position, i), Picture::at(picture.normal, i), mode, kMean);
      const glm::vec3 got = Picture::at(picture.indirect, i);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(got[c], want.indirect[c], 2e-3f * want.direct[c] + 1e-4f) << blocking;
    }
  }
}

/// A picture at full size, two ways of asking for it.
std::vector<float> fullDirect(const Scene& scene, const PosedCamera& camera, const Balls& balls,
                              const char* divisor, const char* repair) {
  frame::TestFrame frame(scene);
  SphericalLights technique(gpu::testDevice());
  Settings settings(info().options);
  settings.set("divisor", divisor);
  settings.set("repair", repair);
  frame.draw(pose(scene, 0.0f), camera,
             {.width = 96, .height = 96, .proxies = balls.proxies, .emission = &balls.emission},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  return frame.floats(divisor == std::string("1")     ? "spherical_lights.direct"
                      : repair == std::string("true") ? "spherical_lights.direct_full"
                                                      : "frame.irradiance_direct_0");
}

// A wall whose foot is darker than its receivers can tell, balls with silhouettes before it.
TEST(SphericalLights, CreasesAreLitFromScratch) {
  SceneBuilder builder("corner");
  const int grey = builder.diffuse("grey", glm::vec3(0.5f));
  builder.place("ground", shapes::ground(12, 12, 1, 1), grey);
  builder.place("wall", shapes::box({-6, 0, -2.3f}, {6, 3, -1.7f}, 1.0f), grey);
  builder.place("ball", shapes::moved(shapes::icosphere(0.7f, 16), {0.4f, 0.7f, 0}), grey);
  builder.sky("preetham?elevation=35");
  const Scene scene = builder.finish();
  Balls balls({{{0.4f, 0.7f, 0}, 0.7f, glm::vec3(0.5f), 0}});
  balls.emission.blocking_patches = {{{0, 0, 0}, {6, 0, 0}, {0, 0, -6}, {0, 1, 0}, glm::vec3(0.5f)},
                                     {{0, 1.5f, -1.7f}, {6, 0, 0}, {0, 1.5f, 0}, {0, 0, 1}, glm::vec3(0.5f)}};
  const PosedCamera camera = frame::cameraAt({2.5f, 3, 7}, {0, 0.6f, -1}, 36);
  const std::vector<float> truth = fullDirect(scene, camera, balls, "1", "true");
  const auto errorOf = [&](const char* repair) {
    const std::vector<float> got = fullDirect(scene, camera, balls, "4", repair);
    double wrong = 0.0, all = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (i % 4 == 3) continue;
      wrong += double(got[i] - truth[i]) * double(got[i] - truth[i]),
          all += double(truth[i]) * double(truth[i]);
    }
    return wrong / all;
  };
  EXPECT_LT(errorOf("true"), 0.5 * errorOf("false"));
  EXPECT_LT(errorOf("true"), 1e-3);
}

/// A thing of two balls, and one of one, that stand far from the ground's middle.
struct Pair : Balls {
  Pair()
      : Balls({{{6.0f, 0.9f, 0.2f}, 0.4f, {0.8f, 0.3f, 0.2f}, 0},
               {{6.5f, 1.5f, 0.3f}, 0.35f, {0.2f, 0.7f, 0.3f}, 0},
               {{-0.6f, 0.7f, 0.0f}, 0.4f, {0.5f, 0.5f, 0.9f}, 1}}) {
    emission.proxies[0].levels = emission.proxies[1].levels = &levels;
  }
  frame::ProxyLevels levels{{{0, 1}}};
};

// SL-8: what is far is as bright and dark as its parts, by its ratio; what is near is itself.
TEST(SphericalLights, HierarchyKeepsTheLight) {
  const Scene scene = frame::planeScene("preetham?elevation=35");
  const Pair pair;
  const Picture each = draw(scene, frame::kAbove, pair);
  const Picture never = draw(scene, frame::kAbove, pair, {{"hierarchy", "0.0001"}});
  const Picture some = draw(scene, frame::kAbove, pair, {{"hierarchy", "0.3"}});
  EXPECT_EQ(never.indirect, each.indirect);
  EXPECT_EQ(never.direct, each.direct);
  EXPECT_NE(some.indirect, each.indirect) << "nothing is taken together";
  float off = 0.0f, most = 0.0f, direct_off = 0.0f;
  for (std::size_t i = 0; i < each.pixels(); ++i) {
    const glm::vec3 d = glm::abs(Picture::at(some.indirect, i) - Picture::at(each.indirect, i));
    off = std::max({off, d.x, d.y, d.z});
    most = std::max(most, Picture::at(each.indirect, i).x);
    direct_off = std::max(direct_off, std::abs(some.direct[4 * i] / each.direct[4 * i] - 1.0f));
  }
  EXPECT_LT(off, 0.02f * most);
  EXPECT_LT(direct_off, 0.01f);
}

// SL-10: on a plane that is dense enough, light found at vertices is light found at pixels.
TEST(SphericalLights, VerticesReceive) {
  SceneBuilder builder("ground");
  builder.place("ground", shapes::moved(shapes::ground(8, 8, 64, 64), {0.5f, 0, 0}),
                builder.diffuse("grey", glm::vec3(0.5f)));
  builder.sky("preetham?elevation=35");
  const Scene scene = builder.finish();
  const Balls balls({{{0.0f, 0.8f, 0.0f}, 0.5f, {0.8f, 0.3f, 0.2f}, 0}});
  const auto drawAt = [&](const char* receivers, const char* image) {
    frame::TestFrame frame(scene);
    SphericalLights technique(gpu::testDevice());
    Settings settings(info().options);
    settings.set("divisor", "1");
    settings.set("receivers", receivers);
    frame.draw(pose(scene, 0.0f), frame::kAbove,
               {.width = kSize, .height = kSize, .proxies = balls.proxies, .emission = &balls.emission},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 return technique.record(graph, inputs, settings);
               });
    return frame.floats(image);
  };
  for (const std::string part : {"direct", "indirect"}) {
    const std::vector<float> want = drawAt("pixels", ("spherical_lights." + part).c_str());
    const std::vector<float> got = drawAt("vertices", ("spherical_lights." + part + "_full").c_str());
    ASSERT_EQ(got.size(), want.size());
    const float most = *std::ranges::max_element(want);
    for (std::size_t i = 0; i < want.size(); ++i) ASSERT_NEAR(got[i], want[i], 0.01f * most) << part;
  }
}

/// The plane with one point lamp of 10 W/sr above it.
Scene lampScene(const glm::vec3& place) {
  SceneBuilder builder("lamp");
  builder.place("ground", shapes::ground(20, 20, 1, 1), builder.diffuse("grey", glm::vec3(0.5f)));
  Light lamp;
  lamp.intensity = glm::vec3(10.0f);
  builder.light(lamp, place);
  return builder.finish();
}

// SL-9: I cos / d^2 below it; a ball between takes it away; within a ball it is told.
TEST(SphericalLights, LampsOfARadiusAreBalls) {
  const Scene scene = lampScene({0, 2.5f, 0});
  const Values balls_of_light = {{"lamp_radius", "0.2"}};
  const std::size_t middle = (kSize / 2) * kSize + kSize / 2;
  const Picture open = draw(scene, frame::kAbove, Balls({}), balls_of_light);
  EXPECT_NEAR(open.direct[4 * middle], 10.0f / (2.5f * 2.5f), 0.03f);
  EXPECT_TRUE(open.warnings.empty());
  const Balls between({{{0, 1.2f, 0}, 0.5f, glm::vec3(0.2f), 0}});
  const Picture shaded = draw(scene, frame::kAbove, between, balls_of_light);
  EXPECT_LT(shaded.direct[4 * middle], 0.5f * open.direct[4 * middle]);
  EXPECT_NEAR(shaded.direct[0], open.direct[0], 0.1f * open.direct[0]) << "the corner sees it";
  const Balls round({{{0, 2.4f, 0}, 0.5f, glm::vec3(0.2f), 0}});
  const Picture hidden = draw(scene, frame::kAbove, round, balls_of_light);
  ASSERT_EQ(hidden.warnings.size(), 1u);
  EXPECT_NE(hidden.warnings[0].find("within"), std::string::npos);
  EXPECT_EQ(hidden.direct[4 * middle], 0.0f);
  // Of radius 0 it stays a point with a shadow map, which frame/ shades: nothing of it here.
  EXPECT_EQ(draw(scene, frame::kAbove, Balls({}), {{"lamp_radius", "0"}}).direct[4 * middle], 0.0f);
}

// SL-9: a pane sends L A cos f(cos) / d^2, to the side that it faces; f is the clamped cosine by three bands, of the last about 0.6.
TEST(SphericalLights, PanesShineAsDiscsDo) {
  const Scene scene = frame::planeScene("uniform");
  const Picture dark = draw(scene, frame::kAbove, Balls({}));
  Balls lit({}), away({});
  frame::Patch pane{
      .center = {0, 2.5f, 0}, .half_u = {0.15f, 0, 0}, .half_v = {0, 0, 0.1f}, .normal = {0, -1, 0}};
  pane.glow = {40.0f, 20.0f, 10.0f};
  lit.emission.glowing_patches = {pane};
  pane.normal = {0, 1, 0};
  away.emission.glowing_patches = {pane};
  const Picture got = draw(scene, frame::kAbove, lit), none = draw(scene, frame::kAbove, away);
  float brightest = 0.0f;
  for (std::size_t i = 0; i < got.pixels(); i += 5) {
    const glm::vec3 to = pane.center - Picture::at(got.position, i);
    const float d2 = glm::dot(to, to), cosine = to.y / std::sqrt(d2);
    for (int c = 0; c < 3; ++c) {
      const glm::vec4 mean = averageWeights(Average::kSolidAngle, std::sqrt(0.06f / (3.14159265f * d2)));
      const float sent =
          0.25f + 0.75f * mean.y * cosine + 2.4f * mean.z * 5.0f / 32.0f * (3.0f * cosine * cosine - 1.0f);
      const float want = pane.glow[c] * 0.06f * cosine * sent / d2;
      EXPECT_NEAR(got.direct[4 * i + std::size_t(c)] - dark.direct[4 * i + std::size_t(c)], want,
                  0.025f * want + 0.006f);
      EXPECT_NEAR(none.direct[4 * i + std::size_t(c)], dark.direct[4 * i + std::size_t(c)], 0.006f);
      brightest = std::max(brightest, want);
    }
  }
  EXPECT_GT(brightest, 0.3f);
}

TEST(SphericalLights, ValuesOutOfRangeAreRefused) {
  Settings settings(info().options);
  EXPECT_THROW(settings.set("spheres", "5000"), Error);
  EXPECT_THROW(settings.set("lamp_radius", "-1"), Error);
  EXPECT_THROW(settings.set("blocking", "per_atom"), Error);
}

TEST(SphericalLights, WithoutEmissionIsAnError) {
  const Scene scene = frame::planeScene("uniform");
  frame::TestFrame frame(scene);
  SphericalLights technique(gpu::testDevice());
  EXPECT_THROW(frame.draw(pose(scene, 0.0f), frame::kAbove, {.width = 8, .height = 8},
                          [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                            return technique.record(graph, inputs, Settings(info().options));
                          }),
               Error);
}

}  // namespace
}  // namespace gloam::spherical_lights
