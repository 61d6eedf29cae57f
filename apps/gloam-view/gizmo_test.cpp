// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gizmo.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace gloam::view {
namespace {

/// A camera at (0, 0, 5) that looks at the origin; a parent that stands there, and its child.
Handles handles() {
  Handles h;
  h.camera.world_from_view = glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, 5.0f});
  h.size = {640.0f, 420.0f};
  h.origin = {0.3f, 0.2f, 0.0f};
  return h;
}
Scene family() {
  Scene scene;
  scene.nodes.resize(2);
  scene.nodes[0].children = {1};
  scene.nodes[1].parent = 0;
  scene.roots = {0};
  return scene;
}

TEST(Gizmo, TheDotComesBeforeTheArrowsThatBeginAtIt) {
  const Handles h = handles();
  const glm::vec2 centre = h.onScreen(h.origin);
  EXPECT_EQ(handleAt(h, centre).kind, Handle::Kind::kCentre);
  EXPECT_EQ(handleAt(h, centre + glm::vec2(7.0f, 0.0f)).kind, Handle::Kind::kCentre);
  const Handle beyond = handleAt(h, centre + glm::vec2(30.0f, 2.0f));
  EXPECT_EQ(beyond.kind, Handle::Kind::kAxis);
  EXPECT_EQ(beyond.axis, 0);
  EXPECT_FALSE(handleAt(h, centre + glm::vec2(-60.0f, 60.0f)));
}

TEST(Gizmo, TheDotFollowsTheMouseAtItsDepth) {
  Handles h = handles();
  h.camera.world_from_view =
      glm::rotate(glm::mat4(1.0f), 0.7f, {0.0f, 1.0f, 0.0f}) * h.camera.world_from_view;
  const glm::vec2 from = h.onScreen(h.origin), to = from + glm::vec2(90.0f, -40.0f);
  Pull pull(h, handleAt(h, from), 0, {}, from);
  const Scene scene = family();
  const auto moves = pull.to(scene, to);
  ASSERT_TRUE(moves);
  const glm::vec3 moved(cli::motionOf(scene, *moves, 1) * glm::vec4(h.origin, 1.0f));
  EXPECT_NEAR(glm::length(h.onScreen(moved) - to), 0.0f, 0.05f);
  const float before = project(h.camera, h.origin, h.size).z, after = project(h.camera, moved, h.size).z;
  EXPECT_NEAR(before, after, 1e-4f);
  EXPECT_NEAR(glm::length(pull.place() - moved), 0.0f, 1e-5f);
}

TEST(Gizmo, ArrowsKeepToTheirAxisAndBeforeIsKept) {
  const Handles h = handles();
  const glm::vec2 from = h.onScreen(h.origin) + glm::vec2(40.0f, 0.0f);
  cli::NodeMoves before;
  before[0] = glm::translate(glm::mat4(1.0f), {0.0f, 1.0f, 0.0f});
  Pull pull(h, handleAt(h, from), 0, before, from);
  const auto moves = pull.to(family(), from + glm::vec2(50.0f, 33.0f));
  ASSERT_TRUE(moves);
  const glm::vec3 shift((*moves).at(0)[3]);
  EXPECT_GT(shift.x, 0.1f);
  EXPECT_NEAR(shift.y, 1.0f, 1e-5f);
  EXPECT_NEAR(shift.z, 0.0f, 1e-5f);
  EXPECT_EQ(pull.before(), before);
}

TEST(Gizmo, RingsTurnAboutTheirMiddle) {
  Handles h = handles();
  h.turns = true;
  const glm::vec2 from = h.ring(2)[6], to = h.ring(2)[18];  // a quarter turn about z
  Pull pull(h, handleAt(h, from), 1, {}, from);
  EXPECT_EQ(pull.handle().kind, Handle::Kind::kRing);
  EXPECT_EQ(pull.handle().axis, 2);
  const auto moves = pull.to(family(), to);
  ASSERT_TRUE(moves);
  const glm::vec3 stays((*moves).at(1) * glm::vec4(h.origin, 1.0f));
  EXPECT_NEAR(glm::length(stays - h.origin), 0.0f, 1e-5f);
  const glm::vec3 turned((*moves).at(1) * glm::vec4(h.origin + glm::vec3(1.0f, 0.0f, 0.0f), 1.0f));
  EXPECT_NEAR(glm::length(turned - h.origin - glm::vec3(0.0f, 1.0f, 0.0f)), 0.0f, 0.02f);
}

}  // namespace
}  // namespace gloam::view
