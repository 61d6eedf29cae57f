// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking neighbourhoods (PRT-6): against what can be worked out by hand, and how a bake runs.
#include <gloam/bake.h>
#include <gloam/neighbourhood.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "math/sampling.h"
#include "math/sh_high_order.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_neighbourhood_field.h"
#include "techniques/prt/prt_neighbourhood_fit.h"
#include "techniques/prt/prt_neighbourhood_trace.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

NeighbourhoodOptions small(int points = 6, int order = 3) {
  NeighbourhoodOptions options;
  options.size = {points, 0, 0};
  options.order = order;
  options.directions = 4096;
  options.thrown_directions = 1024;
  options.error_points = 0;
  return options;
}

Scene bakedSphere(const Material& material, TransferKind kind = TransferKind::kShadowed) {
  Scene scene = sceneOf(sphereMesh(32, 64));
  scene.materials[0] = material;
  BakeOptions options = shadowed(3, 1024);
  options.kind = kind;
  options.apart = true;
  return bakeTransfer(scene, options);
}

/// What a sphere of radius 1 about the origin blocks: a cone about -place of half-angle asin(1 / distance).
float blockedShare(float distance) {
  return 0.5f * (1.0f - std::sqrt(1.0f - 1.0f / (distance * distance)));
}

TEST(PrtNeighbourhood, SphereBlocksItsCone) {
  const Scene scene = sceneOf(sphereMesh(48, 96));
  NeighbourhoodReport report;
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(7), {}, &report);
  EXPECT_EQ(grid.size, glm::ivec3(7));
  EXPECT_TRUE(grid.indirect.empty());  // nothing was baked that it could throw
  EXPECT_EQ(report.points, 343u);
  EXPECT_GT(report.inside, 0u);
  const NeighbourhoodObject object = neighbourhoodObject(scene, 0, 0.0f);
  const NeighbourhoodTracer tracer(scene, object, small(7), {});
  std::vector<std::uint16_t> blocked;
  std::vector<float> v(grid.visibilityCount());
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const glm::vec3 place = grid.position(p);
    const float distance = glm::length(place);
    if (distance < 1.01f) continue;
    const float share = blockedShare(distance);
    for (const bool rough : {false, true}) {
      EXPECT_NEAR(
          rough ? tracer.roughVisibility(place, v.data()) : tracer.visibility(place, blocked, v.data()),
          share, 0.01f);
      EXPECT_NEAR(v[0] / std::sqrt(4.0f * kPi), 1.0f - share, 0.01f);
      // Band 1 of a cap: sqrt(4 pi / 3) times its zonal coefficient, towards its axis; missing there.
      const glm::vec3 axis = -place / distance;
      const float zonal = std::sqrt(3.0f / (4.0f * kPi)) * kPi / (distance * distance);
      const glm::vec3 band(v[3], v[1], v[2]);
      EXPECT_LT(glm::length(band + zonal * axis), rough ? 0.04f : 0.02f);
    }
  }
}

// Far out, where the field is nearly straight within a cell, what a point holds is nearly what is seen from it.
TEST(PrtNeighbourhood, ThePointsHoldWhatIsSeenFromThem) {
  const Scene scene = sceneOf(sphereMesh(48, 96));
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(16));
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const float distance = glm::length(grid.position(p));
    if (distance < 2.0f) continue;
    EXPECT_NEAR(grid.visibility[p * grid.visibilityCount()] / std::sqrt(4.0f * kPi),
                1.0f - blockedShare(distance), 0.01f);
  }
}

// Where V is a straight line along each axis the fit finds it, and continues it into the object, whatever it began with.
TEST(PrtNeighbourhood, TheFitFindsWhatInterpolationCanSay) {
  NeighbourhoodState state;
  state.grid.light_order = state.grid.field_order = 1;
  state.grid.size = {6, 5, 4};
  state.grid.visibility.assign(state.grid.points(), 0.3f);
  state.begin();
  const auto truth = [](const glm::vec3& at) { return 1.0f + 0.2f * at.x - 0.1f * at.y * at.z; };
  for (std::size_t p = 0; p < state.grid.points(); ++p) {
    for (std::size_t k = 0; k < kCellSamples; ++k) {
      const glm::vec3 at = glm::vec3(state.grid.pointAt(p)) + cellSample(k);
      state.sample_inside[p * kCellSamples + k] = at.x < 1.5f && at.y < 2.0f;
      state.samples[p * kCellSamples + k] = state.sample_inside[p * kCellSamples + k] ? 7.0f : truth(at);
    }
    state.grid.visibility[p] = truth(glm::vec3(state.grid.pointAt(p))) + 0.1f * std::sin(float(p));
  }
  fitVisibility(state);
  for (std::size_t p = 0; p < state.grid.points(); ++p) {
    const glm::vec3 at(state.grid.pointAt(p));
    if (at.x >= 1.5f || at.y >= 2.0f)
      EXPECT_NEAR(state.grid.visibility[p], truth(at), 0.01f) << p;
    else
      EXPECT_NEAR(state.grid.visibility[p], truth(at), 0.15f) << p;
  }
}

// A parabola: interpolation between its own values errs by h^2 / 8 at the middle of every cell, always upwards. The fit errs
// by less than half of that, RMS, and not at all in the mean.
TEST(PrtNeighbourhood, TheFitLiesOnBothSidesOfACurve) {
  NeighbourhoodState state;
  state.grid.light_order = state.grid.field_order = 1;
  state.grid.size = {9, 3, 3};
  state.grid.visibility.resize(state.grid.points());
  state.begin();
  const auto truth = [](const glm::vec3& at) { return at.x * at.x; };
  for (std::size_t p = 0; p < state.grid.points(); ++p) {
    state.grid.visibility[p] = truth(glm::vec3(state.grid.pointAt(p)));
    for (std::size_t k = 0; k < kCellSamples; ++k)
      state.samples[p * kCellSamples + k] = truth(glm::vec3(state.grid.pointAt(p)) + cellSample(k));
  }
  const auto errors = [&] {
    glm::dvec2 sum(0.0);
    for (int i = 0; i < 400; ++i) {
      const glm::vec3 at(2.0f + 4.0f * (float(i) + 0.5f) / 400.0f, 0.7f, 1.3f);
      float value = 0.0f;
      const GridCorners corners = cornersAt(state.grid, state.grid.position(at));
      for (int c = 0; c < 8; ++c) value += corners.weight[c] * state.grid.visibility[corners.point[c]];
      const double error = double(value - truth(at));
      sum += glm::dvec2(error, error * error);
    }
    return glm::dvec2(sum.x / 400.0, std::sqrt(sum.y / 400.0));
  };
  const glm::dvec2 before = errors();
  fitVisibility(state);
  const glm::dvec2 after = errors();
  EXPECT_NEAR(before.x, 1.0 / 6.0, 1e-3);
  EXPECT_LT(std::abs(after.x), 0.01);
  EXPECT_LT(after.y, 0.5 * before.y);
}

TEST(PrtNeighbourhood, PointsInsideHoldWhatIsOutside) {
  const Scene scene = sceneOf(sphereMesh(24, 48));
  NeighbourhoodReport report;
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(10), {}, &report);
  ASSERT_GE(report.inside, 8u);
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const float open = grid.visibility[p * grid.visibilityCount()] / std::sqrt(4.0f * kPi);
    EXPECT_GT(open, 0.2f);  // at the surface half of the sphere is open; further in it goes on as outside
    EXPECT_LT(open, 1.0f);
  }
}

// A white sphere under light of 1 from everywhere is 1 all over: what it blocks it gives back.
TEST(PrtNeighbourhood, WhiteObjectInTheWhiteFurnaceThrowsWhatItBlocks) {
  const Scene scene = bakedSphere({.metallic = 0.0f, .specular = 0.0f});
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(10));
  ASSERT_FALSE(grid.indirect.empty());
  EXPECT_EQ(grid.bounces, 1);
  sh::ShRgb white(3);
  white.c[0] = glm::vec3(std::sqrt(4.0f * kPi));
  for (const glm::vec3 place : {glm::vec3(1.7f, 0.4f, 0.3f), glm::vec3(-0.3f, 2.2f, -1.0f)}) {
    const NeighbourhoodField field = fieldAt(grid, place, white);
    for (int i = 0; i < 9; ++i) {
      const glm::vec3 sum = field.direct.c[std::size_t(i)] + field.thrown.c[std::size_t(i)];
      EXPECT_NEAR(sum.g, i == 0 ? std::sqrt(4.0f * kPi) : 0.0f, 0.04f) << i;
    }
  }
}

// A perfect mirror does so, too; and under light from above it throws a highlight on what stands beside it, where a diffuse
// body of the same albedo throws less of it.
TEST(PrtNeighbourhood, MirrorsThrowTheLightThatTheyReflect) {
  const Scene scene = bakedSphere({.metallic = 1.0f, .roughness = 0.05f});
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(10));
  sh::ShRgb white(3), above(3);
  white.c[0] = glm::vec3(std::sqrt(4.0f * kPi));
  const glm::vec3 place(1.8f, 0.2f, 0.1f);
  NeighbourhoodField field = fieldAt(grid, place, white);
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 sum = field.direct.c[std::size_t(i)] + field.thrown.c[std::size_t(i)];
    EXPECT_NEAR(sum.g, i == 0 ? std::sqrt(4.0f * kPi) : 0.0f, 0.04f) << i;
  }
  // The middle of the sphere shows what comes from +X there: light from +X is thrown back to +X.
  const sh::Sh from_x = sh::evaluate(3, {1, 0, 0});
  for (int i = 0; i < 9; ++i) above.c[std::size_t(i)] = glm::vec3(from_x[i]);
  field = fieldAt(grid, place, above);
  EXPECT_GT(sh::irradiance(field.thrown, {-1, 0, 0}).g, 0.0f);
}

TEST(PrtNeighbourhood, TurnsAndScalesWithItsNode) {
  Scene scene = sceneOf(boxMesh({0.5f, 0.2f, 0.3f}, false));
  const NeighbourhoodTransfer before = bakeNeighbourhood(scene, 0, small(5));
  scene.nodes[0].matrix = glm::translate(glm::mat4(1.0f), {3, -1, 2}) *
                          glm::rotate(glm::mat4(1.0f), 0.9f, glm::normalize(glm::vec3(1, 2, -1))) *
                          glm::scale(glm::mat4(1.0f), glm::vec3(2.5f));
  const NeighbourhoodTransfer after = bakeNeighbourhood(scene, 0, small(5));
  ASSERT_EQ(before.size, after.size);
  EXPECT_LT(glm::length(before.spacing - after.spacing), 1e-4f);
  double difference = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < before.visibility.size(); ++i) {
    difference += std::pow(double(before.visibility[i] - after.visibility[i]), 2.0);
    whole += std::pow(double(before.visibility[i]), 2.0);
  }
  EXPECT_LT(std::sqrt(difference / whole), 0.01);  // directions within the object are the same up to rounding
}

TEST(PrtNeighbourhood, FinerGridsErrLess) {
  const Scene scene = sceneOf(sphereMesh(24, 48));
  double last = 1.0;
  for (const int points : {6, 12, 20}) {
    NeighbourhoodOptions options = small(points);
    options.directions = 1024;
    options.error_points = 200;
    NeighbourhoodReport report;
    bakeNeighbourhood(scene, 0, options, {}, &report);
    EXPECT_LT(report.near_error, 0.8 * last) << points;
    EXPECT_LT(report.error, report.near_error);
    EXPECT_LT(report.near_error, report.worst_error);
    last = report.near_error;
  }
  EXPECT_LT(last, 0.02);
}

bool sameBits(const NeighbourhoodTransfer& a, const NeighbourhoodTransfer& b) {
  return a.visibility == b.visibility && a.indirect == b.indirect && a.spacing == b.spacing;
}

TEST(PrtNeighbourhood, SameBitsForAnyNumberOfThreadsAndAfterInterruptions) {
  const Scene scene = bakedSphere({.metallic = 0.5f, .roughness = 0.3f});
  NeighbourhoodOptions options = small();
  options.directions = 512;
  options.threads = 1;
  const NeighbourhoodTransfer one = bakeNeighbourhood(scene, 0, options);
  options.threads = 3;
  EXPECT_TRUE(sameBits(one, bakeNeighbourhood(scene, 0, options)));
  options.checkpoint = std::filesystem::path(testing::TempDir()) / "neighbourhood.ckp";
  std::filesystem::remove(options.checkpoint);
  for (int interruptions = 0;; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    Progress progress;  // stops soon after the first points are under way
    std::atomic<int> asked{0};
    std::atomic<bool> begun{false};
    progress.update = [&](double, const std::string& what) {
      if (what.find("neighbourhood") != std::string::npos) begun = true;
    };
    progress.should_stop = [&] { return begun && ++asked > 3; };
    NeighbourhoodReport report;
    try {
      EXPECT_TRUE(sameBits(one, bakeNeighbourhood(scene, 0, options, progress, &report)));
      EXPECT_TRUE(report.resumed);
      EXPECT_GT(interruptions, 2);
      break;
    } catch (const Interrupted&) {
      ASSERT_TRUE(std::filesystem::exists(options.checkpoint));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(options.checkpoint));
  std::ofstream(options.checkpoint) << "a letter to someone";
  EXPECT_THROW(bakeNeighbourhood(scene, 0, options), Error);
  EXPECT_TRUE(std::filesystem::exists(options.checkpoint));
  std::filesystem::remove(options.checkpoint);
}

std::string errorOf(const Scene& scene, const NeighbourhoodOptions& options) {
  try {
    bakeNeighbourhood(scene, 0, options);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(PrtNeighbourhood, SaysWhatItCannotDo) {
  Scene scene = sceneOf(sphereMesh(8, 16));
  NeighbourhoodOptions options = small();
  options.reach = -1.0f;
  EXPECT_NE(errorOf(scene, options).find("reach is -1"), std::string::npos);
  options = small(129);
  EXPECT_NE(errorOf(scene, options).find("129"), std::string::npos);
  options = small(64, 6);
  options.memory_bytes = std::size_t(1) << 30;
  EXPECT_NE(errorOf(scene, options).find("64 x 64 x 64 points takes"), std::string::npos);
  EXPECT_GT(estimateNeighbourhood(scene, 0, options).memory_bytes, options.memory_bytes);
  for (glm::vec3& p : scene.meshes[0].positions) p = {1, 2, 3};
  EXPECT_NE(errorOf(scene, small()).find("lie in one point"), std::string::npos);
  scene.nodes[0].meshes.clear();
  scene.nodes[0].name = "empty";
  EXPECT_NE(errorOf(scene, small()).find("node 'empty'"), std::string::npos);
}

// A vane that turns over a ground and past a ball; a stone far away.
TEST(PrtNeighbourhood, MeetingNodesAreThoseThatMoveAndTheirNeighbours) {
  Scene scene = sceneOf(boxMesh({3, 0.1f, 3}, false));
  const auto add = [&](const glm::vec3& at) {
    scene.nodes.push_back({.translation = at, .meshes = {0}});
    scene.roots.push_back(int(scene.nodes.size()) - 1);
  };
  add({0, 4, 0});
  add({100, 0, 0});
  EXPECT_TRUE(neighbourhoodNodesThatMeet(scene, 1.0f).empty());
  AnimationChannel channel;
  channel.node = 1;
  channel.path = AnimationChannel::Path::kTranslation;
  channel.times_s = {0.0f, 1.0f};
  channel.values = {0, 40, 0, 0, 4, 0};
  scene.animations.push_back({.channels = {channel}});
  EXPECT_EQ(neighbourhoodNodesThatMeet(scene, 1.0f), (std::vector<int>{1, 0}));
  EXPECT_EQ(neighbourhoodNodesThatMeet(scene, 0.1f), (std::vector<int>{1}));
  EXPECT_EQ(neighbourhoodNodesThatMeet(scene, 16.0f), (std::vector<int>{1, 0, 2}));
}

}  // namespace
}  // namespace gloam::prt
