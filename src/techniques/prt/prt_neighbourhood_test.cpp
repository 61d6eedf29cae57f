// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of neighbourhood transfer (PRT-6), pixel by pixel against its twin on the host.
#include "techniques/prt/prt_neighbourhood.h"

#include <gloam/bake.h>

#include "scene/environment.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_neighbourhood_field.h"
#include "techniques/prt/prt_test_frame.h"

namespace gloam::prt {
namespace {

constexpr int kSize = 96;
constexpr float kPi = 3.14159265f, kFloor = -1.3f;

/// A white ball, which carries a grid, over a large floor.
Scene ballOverFloor(bool floor_baked, float metallic = 0.0f) {
  Scene scene;
  scene.materials.push_back({.metallic = metallic, .roughness = 0.2f, .specular = 0.0f});
  scene.materials.push_back({.metallic = 0.0f, .specular = 0.0f});
  addMesh(scene, sphereMesh(24, 48)).name = "ball";
  Mesh floor = gridMesh(6.0f, 40);
  floor.name = "floor";
  floor.material = 1;
  for (glm::vec3& p : floor.positions) p.y += kFloor;
  addMesh(scene, std::move(floor));
  BakeOptions options = shadowed(5, 1024);
  options.apart = true;
  Scene baked = bakeTransfer(scene, options);
  if (!floor_baked) baked.meshes[1].transfer = nullptr;
  NeighbourhoodOptions around;
  around.size = {10, 0, 0};
  around.directions = 1024;
  around.thrown_directions = 256;
  around.error_points = 0;
  baked.nodes[0].neighbourhood = std::make_shared<NeighbourhoodTransfer>(bakeNeighbourhood(baked, 0, around));
  baked.environment = loadEnvironment("sky:mild?elevation=40");
  return baked;
}

Picture draw(const Scene& scene, Values values = {}) {
  return prt::draw(scene, kSize, frame::cameraAt({2.0f, 4.5f, 6.0f}, {0.3f, -1.0f, 0.0f}, 60.0f),
                   settings(values));
}

/// The floor's pixels against fieldAt(). Returns how many of them lie in the grid.
int expectTwin(const Scene& scene, const Picture& picture, double tolerance) {
  const NeighbourhoodTransfer& grid = *scene.nodes[0].neighbourhood;
  const glm::mat4 world_from_node = scene.nodes[0].matrix.value_or(glm::mat4(1.0f));
  const glm::mat3 turn = rotationFactor(world_from_node);
  const sh::ShRgb world_light = projectEnvironment(scene.environment, 5);
  const sh::ShRgb light = sh::rotate(glm::transpose(turn), world_light);
  const glm::vec3 up = glm::transpose(turn) * glm::vec3(0, 1, 0);
  const glm::vec3 open = sh::irradiance(light, up) / kPi;
  int inside = 0, outside = 0;
  double squares = 0.0, whole = 0.0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t i = std::size_t(y * kSize + x);
      if (picture.ids[i].x != 2) continue;
      const frame::FrameView& view = picture.view;
      const glm::vec3 way = view.corner + (float(x) + 0.5f) * view.step_x + (float(y) + 0.5f) * view.step_y;
      const glm::vec3 world = view.eye + way * (kFloor - view.eye.y) / way.y;
      const glm::vec3 place(glm::inverse(world_from_node) * glm::vec4(world, 1.0f));
      const float share = neighbourhoodShare(grid, place);
      glm::vec3 direct = open, indirect(0.0f);
      if (share > 0.0f) {
        ++inside;
        const NeighbourhoodField field = fieldAt(grid, place, light);
        const glm::vec3 left = glm::clamp(sh::irradiance(field.direct, up) / kPi / open, 0.0f, 1.0f);
        direct *= glm::mix(glm::vec3(1.0f), left, share);
        indirect = share * glm::max(sh::irradiance(field.thrown, up) / kPi, glm::vec3(0.0f));
      } else {
        ++outside;
      }
      for (int c = 0; c < 3; ++c) {
        const float* seen[2] = {&picture.direct[4 * i], &picture.indirect[4 * i]};
        squares += std::pow(double(seen[0][c]) - double(direct[c]), 2.0) +
                   std::pow(double(seen[1][c]) - double(indirect[c]), 2.0);
        whole += double(direct[c]) * double(direct[c]);
        if (share == 0.0f) {
          EXPECT_NEAR(seen[0][c], direct[c], 0.01f * direct[c]);
        }
      }
    }
  }
  EXPECT_GT(outside, 100);
  EXPECT_LT(std::sqrt(squares / whole), tolerance);
  return inside;
}

TEST(PrtNeighbourhood, PixelsOfWhatIsNotBakedAgreeWithTheHost) {
  for (const float metallic : {0.0f, 1.0f}) {
    const Scene scene = ballOverFloor(false, metallic);
    EXPECT_GT(expectTwin(scene, draw(scene), 0.003), 1000);
  }
}

TEST(PrtNeighbourhood, TheCarrierTurnsAndMovesWithNothingBakedAgain) {
  Scene scene = ballOverFloor(false, 1.0f);
  scene.nodes[0].matrix = glm::translate(glm::mat4(1.0f), {0.7f, 0.2f, -0.4f}) *
                          glm::rotate(glm::mat4(1.0f), 1.1f, glm::normalize(glm::vec3(0.3f, 1, 0.5f))) *
                          glm::scale(glm::mat4(1.0f), glm::vec3(0.8f));
  EXPECT_GT(expectTwin(scene, draw(scene), 0.003), 500);
}

TEST(PrtNeighbourhood, VerticesOfBakedReceiversAgreeWithTheHost) {
  Scene scene = ballOverFloor(true);
  EXPECT_GT(expectTwin(scene, draw(scene), 0.02), 1000);  // between vertices 0.3 m apart
  scene.nodes[0].matrix = glm::rotate(glm::mat4(1.0f), 0.8f, glm::normalize(glm::vec3(1, 1, 0.5f)));
  EXPECT_GT(expectTwin(scene, draw(scene), 0.02), 1000);
}

TEST(PrtNeighbourhood, AReceiverMayTurnToo) {
  Scene scene = ballOverFloor(true);
  // The floor turned about its own axis is the same floor.
  const Picture still = draw(scene);
  scene.nodes[1].matrix = glm::rotate(glm::mat4(1.0f), 0.5f * kPi, glm::vec3(0, 1, 0));
  const Picture turned = draw(scene);
  double squares = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < still.direct.size(); ++i) {
    squares += std::pow(double(still.direct[i] - turned.direct[i]), 2.0);
    whole += std::pow(double(still.direct[i]), 2.0);
  }
  EXPECT_LT(std::sqrt(squares / whole), 0.01);
}

TEST(PrtNeighbourhood, TheCarrierItselfIsLitAsBefore) {
  const Scene scene = ballOverFloor(false);
  const Picture with = draw(scene), without = draw(scene, {{"neighbourhood", "false"}});
  int ball = 0, darker = 0;
  for (std::size_t i = 0; i < with.ids.size(); ++i) {
    if (with.ids[i].x == 1) {
      ++ball;
      EXPECT_EQ(with.direct[4 * i + 1], without.direct[4 * i + 1]);
    } else if (with.ids[i].x == 2 && with.direct[4 * i + 1] < 0.9f * without.direct[4 * i + 1]) {
      ++darker;
    }
  }
  EXPECT_GT(ball, 100);
  EXPECT_GT(darker, 100);
}

TEST(PrtNeighbourhood, ShadowsOfTwoMultiply) {
  Scene scene = ballOverFloor(false);
  const Picture one = draw(scene);
  // A second carrier in the same place with the same grid.
  scene.nodes.push_back(scene.nodes[0]);
  scene.roots.push_back(int(scene.nodes.size()) - 1);
  const Picture two = draw(scene), none = draw(scene, {{"neighbourhood", "false"}});
  double squares = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < one.ids.size(); ++i) {
    if (one.ids[i].x != 2 || two.ids[i].x != 2) continue;
    const double left = double(one.direct[4 * i + 1]) / double(none.direct[4 * i + 1]);
    squares += std::pow(double(two.direct[4 * i + 1]) - left * double(one.direct[4 * i + 1]), 2.0);
    whole += std::pow(double(two.direct[4 * i + 1]), 2.0);
  }
  EXPECT_LT(std::sqrt(squares / whole), 0.005);
}

TEST(PrtNeighbourhood, AnswersGridsThatDoNotFit) {
  Scene scene = ballOverFloor(false);
  auto broken = std::make_shared<NeighbourhoodTransfer>(*scene.nodes[0].neighbourhood);
  broken->visibility.pop_back();
  scene.nodes[0].name = "vase";
  scene.nodes[0].neighbourhood = broken;
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("node 'vase': neighbourhood transfer from 5 to 5 bands"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam::prt
