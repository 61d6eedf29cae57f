// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Scenes of moving things: they move smoothly, end where they began, keep out of each other's way, and what casts is closed.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "scene/builtin_scenes.h"
#include "scene/mesh_laws.h"

namespace gloam {
namespace {

struct Moving {
  const char* name;
  float fastest_m_s;  ///< no point of any object is faster
  bool loops;
};

std::ostream& operator<<(std::ostream& out, const Moving& moving) {
  return out << moving.name;
}

/// Some points of all that is placed, in the order of nodes and meshes.
std::vector<glm::vec3> pointsOf(const Scene& scene, float time_s) {
  std::vector<glm::vec3> points;
  for (const Instance& instance : pose(scene, time_s).instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const std::size_t step = std::max<std::size_t>(1, mesh.vertexCount() / 97);
    for (std::size_t i = 0; i < mesh.vertexCount(); i += step) {
      points.push_back(instance.deformed()
                           ? instance.deformed_positions[i]
                           : glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f)));
    }
  }
  return points;
}

float farthest(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, glm::length(a[i] - b[i]));
  return most;
}

class MovingScenes : public testing::TestWithParam<Moving> {};

TEST_P(MovingScenes, MoveWithoutJumps) {
  const Scene scene = makeBuiltinScene(std::string(GetParam().name) + "?detail=0.25");
  EXPECT_FLOAT_EQ(scene.duration_s(), 4.0f);
  constexpr float kFrame_s = 1.0f / 60.0f;
  std::vector<glm::vec3> before = pointsOf(scene, 0.0f);
  float way = 0.0f;
  for (int frame = 1; frame <= 240; ++frame) {
    const std::vector<glm::vec3> now = pointsOf(scene, kFrame_s * float(frame));
    ASSERT_EQ(now.size(), before.size());
    const float most = farthest(before, now);
    ASSERT_LT(most, GetParam().fastest_m_s * kFrame_s) << "frame " << frame;
    way += most;
    before = now;
  }
  EXPECT_GT(way, 0.3f);  // it does move
}

TEST_P(MovingScenes, StandAboveTheGroundAndCloseTheirBodies) {
  const Scene scene = makeBuiltinScene(std::string(GetParam().name) + "?detail=0.5");
  for (const Node& node : scene.nodes) {
    const bool in_box = node.parent != kNone && scene.nodes[std::size_t(node.parent)].name == "box";
    if (in_box || node.name == "hall" || node.name == "ground" || node.name == "floor" ||
        node.name == "table")
      continue;  // seen from above only
    for (const int mesh : node.meshes) {
      EXPECT_EQ(mesh_laws::openEdges(scene.meshes[std::size_t(mesh)]), 0) << node.name;
      EXPECT_GT(mesh_laws::signedVolume(scene.meshes[std::size_t(mesh)]), 0.0) << node.name;
    }
  }
  for (const float t : {0.0f, 0.55f, 1.2f, 2.1f, 2.9f, 3.6f}) {
    for (const Instance& instance : pose(scene, t).instances) {
      const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
      if (scene.nodes[std::size_t(instance.node)].parent == kNone && !instance.deformed() &&
          mesh.name.find("wall") != std::string::npos)
        continue;
      const std::string& node = scene.nodes[std::size_t(instance.node)].name;
      if (node == "hall" || node == "ground" || node == "floor" || node == "table") continue;
      float lowest = 1.0f;
      for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
        lowest = std::min(lowest, instance.deformed()
                                      ? instance.deformed_positions[i].y
                                      : (instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f)).y);
      }
      EXPECT_GT(lowest, -0.004f) << node << " at " << t;
    }
  }
}

TEST_P(MovingScenes, EndWhereTheyBegin) {
  if (!GetParam().loops) return;  // comes to rest, or another object takes the place
  const Scene scene = makeBuiltinScene(std::string(GetParam().name) + "?detail=0.25");
  const std::vector<glm::vec3> first = pointsOf(scene, 0.0f), last = pointsOf(scene, 4.0f);
  EXPECT_LT(farthest(first, last), 2e-3f);
}

INSTANTIATE_TEST_SUITE_P(All, MovingScenes,
                         testing::Values(Moving{"squirrel", 6.0f, false}, Moving{"robot", 5.0f, true},
                                         Moving{"packages", 8.0f, true}, Moving{"assembly", 5.5f, false},
                                         Moving{"balls", 2.0f, true}, Moving{"pair", 2.0f, true},
                                         Moving{"bend", 6.0f, true}, Moving{"box", 2.0f, true},
                                         Moving{"links", 1.0f, true}, Moving{"bars", 2.0f, false}),
                         [](const testing::TestParamInfo<Moving>& info) { return info.param.name; });

// One skin of all parts moves as they do.
TEST(RobotScene, TheSkinIsTheSumOfTheParts) {
  const Scene parts = makeBuiltinScene("robot?detail=0.25"),
              skin = makeBuiltinScene("robot?detail=0.25&skin=1");
  const auto sumOf = [](const Scene& scene, float time_s) {
    glm::dvec3 sum(0.0);
    std::size_t count = 0;
    for (const Instance& instance : pose(scene, time_s).instances) {
      const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
      count += mesh.vertexCount();
      for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
        sum += glm::dvec3(instance.deformed()
                              ? instance.deformed_positions[i]
                              : glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f)));
    }
    return std::pair(sum / double(count), count);
  };
  for (const float t : {0.0f, 0.7f, 2.4f}) {
    const auto [a, na] = sumOf(parts, t);
    const auto [b, nb] = sumOf(skin, t);
    EXPECT_EQ(na, nb);
    EXPECT_LT(glm::length(a - b), 1e-6) << t;
  }
}

glm::vec3 middleOf(const Scene& scene, float time_s, const std::string& name) {
  for (const Instance& instance : pose(scene, time_s).instances) {
    if (scene.nodes[std::size_t(instance.node)].name == name) return glm::vec3(instance.world_from_object[3]);
  }
  throw std::runtime_error("no node " + name);
}

TEST(SquirrelScene, BallsKeepApartRollAndComeToRest) {
  const Scene scene = makeBuiltinScene("squirrel?detail=0.25");
  std::map<std::string, float> radius;
  for (const Node& node : scene.nodes) {
    if (node.name.find("ball") == std::string::npos) continue;
    for (const glm::vec3& p : scene.meshes[std::size_t(node.meshes.at(0))].positions)
      radius[node.name] = std::max(radius[node.name], glm::length(p));
  }
  ASSERT_EQ(radius.size(), 6u);
  for (int frame = 0; frame <= 80; ++frame) {
    const float t = 0.05f * float(frame);
    for (const auto& [a, ra] : radius) {
      for (const auto& [b, rb] : radius) {
        if (a < b) {
          EXPECT_GT(glm::length(middleOf(scene, t, a) - middleOf(scene, t, b)), ra + rb + 0.01f)
              << a << ", " << b << " at " << t;
        }
      }
      // The squirrel is a column about its middle, wider towards its tail.
      const glm::vec3 off = middleOf(scene, t, a) - middleOf(scene, t, "squirrel");
      EXPECT_TRUE(std::abs(off.z) > ra + 0.29f || off.x > ra + 0.35f || off.x < -ra - 0.4f)
          << a << " at " << t;
    }
  }
  for (const auto& [name, r] : radius)
    EXPECT_LT(glm::length(middleOf(scene, 3.95f, name) - middleOf(scene, 4.0f, name)), 5e-3f) << name;
}

// What a toy is at the end of a round, its neighbour on the line was at its beginning.
TEST(AssemblyScene, EachRoundEndsWhereTheNextBegins) {
  const Scene scene = makeBuiltinScene("assembly?detail=0.25");
  const auto samePlace = [&](const std::string& at_end, const std::string& at_start) {
    EXPECT_LT(glm::length(middleOf(scene, 4.0f, at_end) - middleOf(scene, 0.0f, at_start)), 2e-3f)
        << at_end << ", " << at_start;
  };
  for (int k = 1; k < 4; ++k) samePlace("block " + std::to_string(k), "block " + std::to_string(k + 1));
  for (int k = 1; k < 4; ++k) samePlace("drum " + std::to_string(k), "drum " + std::to_string(k + 1));
  for (int k = 2; k < 4; ++k) samePlace("head " + std::to_string(k), "head " + std::to_string(k + 1));
  samePlace("next drum", "drum 1");
  samePlace("next head", "head 2");
  for (const char* name : {"turret", "upper arm", "forearm", "gripper", "ram", "lamp"}) samePlace(name, name);
}

// The drum hangs in the gripper while the arm carries it.
TEST(AssemblyScene, TheArmHoldsWhatItCarries) {
  const Scene scene = makeBuiltinScene("assembly?detail=0.25");
  for (float t = 0.52f; t < 2.2f; t += 0.1f) {
    const glm::vec3 hand = middleOf(scene, t, "gripper"), drum = middleOf(scene, t, "drum 1");
    EXPECT_NEAR(drum.x, hand.x, 0.02f) << t;
    EXPECT_NEAR(drum.z, hand.z, 0.02f) << t;
    EXPECT_NEAR(hand.y - drum.y, 0.215f, 0.01f) << t;
  }
}

}  // namespace
}  // namespace gloam
