// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "viewer_choice.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "camera_control.h"
#include "view_state.h"

namespace gloam::view {
namespace {

Scene named(std::initializer_list<const char*> names) {
  Scene scene;
  for (const char* name : names) {
    scene.roots.push_back(int(scene.nodes.size()));
    scene.nodes.emplace_back().name = name;
  }
  return scene;
}

void expectSame(const cli::NodeMoves& a, const cli::NodeMoves& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [node, motion] : a) {
    ASSERT_TRUE(b.contains(node)) << node;
    for (int c = 0; c < 4; ++c) EXPECT_LT(glm::length(motion[c] - b.at(node)[c]), 2e-6f) << node;
  }
}

/// Names that are clear, that stand twice, that are none, that hold signs of the syntax.
TEST(Preset, HoldsSceneMovesAndLights) {
  const std::string file =
      (std::filesystem::temp_directory_path() / "gloam_viewer_choice_test.json").string();
  ViewState state;
  state.scene = makeLoadedScene({.name = "builtin:cornell",
                                 .ground = true,
                                 .spheres = "/its.spheres.json",
                                 .scene = named({"lamp", "box", "box", "", "#0", "a=1,2,3"})});
  state.left = pickOf(techniques().front());
  state.width = 640;
  state.height = 420;
  state.supersample = 2;
  for (int node = 0; node < 6; ++node) {
    state.moves[node] = glm::translate(glm::mat4(1.0f), {0.1f * float(node), -2.5f, 1e-3f});
    if (node % 2 == 1)
      state.moves[node] = glm::rotate(state.moves[node], 0.7f * float(node), {0.0f, 0.6f, 0.8f});
  }
  CameraControl camera;
  camera.setTarget({1.0f, 2.0f, 3.0f}, {0.0f, 0.5f, 0.0f});
  const std::vector<std::string> lights = {"disc?elevation=30", "constant?radiance=0.5"};
  writePreset(file, state, camera, "sky:noon", lights);
  const ViewerChoice read = readPreset(file);
  std::filesystem::remove(file);
  EXPECT_TRUE(read.scene_given);
  EXPECT_EQ(read.scene.name, "builtin:cornell");
  EXPECT_TRUE(read.scene.ground);
  EXPECT_EQ(read.spheres, "/its.spheres.json");
  EXPECT_EQ(read.light.light_texts, lights);
  EXPECT_EQ(read.light.environment, "sky:noon");
  EXPECT_EQ(read.view.supersample, 2);
  expectSame(cli::movesIn(state.scene->scene, read.moves), state.moves);
}

TEST(Moves, AreRefusedInOneLine) {
  const Scene scene = named({"lamp", "box", "box"});
  for (const char* text : {"", "lamp", "=1,2,3", "lamp=1,2", "lamp=1,2,x", "lamp=1,2,3,0,0,0,0",
                           "lamp=1,2,3,4", "lamp=nan,0,0", "lamp=,,"})
    EXPECT_THROW(cli::parseMove(text), Error) << text;
  for (const char* text : {"table=1,2,3", "box=1,2,3", "#3=1,2,3", "#-1=1,2,3", "#=1,2,3"})
    EXPECT_THROW(cli::movesIn(scene, {cli::parseMove(text)}), Error) << text;
  const cli::NodeMoves moves = cli::movesIn(
      scene, {cli::parseMove("#2=1,2,3"), cli::parseMove("lamp=1,0,0"), cli::parseMove("lamp=0,1,0")});
  EXPECT_EQ(glm::vec3(moves.at(0)[3]), glm::vec3(1.0f, 1.0f, 0.0f));  // twice: one after the other
  EXPECT_EQ(glm::vec3(moves.at(2)[3]), glm::vec3(1.0f, 2.0f, 3.0f));
}

}  // namespace
}  // namespace gloam::view
