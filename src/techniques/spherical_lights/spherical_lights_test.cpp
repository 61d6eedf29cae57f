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
