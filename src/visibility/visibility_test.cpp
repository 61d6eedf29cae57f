// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/visibility.h"

#include <tbb/global_control.h>

#include <bit>

#include "frame/test_frame.h"
#include "math/sampling.h"
#include "visibility/host_sight.h"
#include "visibility/host_world.h"

namespace gloam::visibility {
namespace {

struct Asked {
  std::vector<SightPoint> points;
  std::vector<SightEnd> lights;
  std::vector<SightSet> sets;
  std::uint32_t words = 2;
};

std::vector<std::uint32_t> ask(frame::TestFrame& frame, Visibility& sight, const PosedScene& posed,
                               const Asked& asked, Means means) {
  gpu::BufferRef visible;
  frame.draw(posed, frame::cameraAt({0, 3, 6}, {0, 0, 0}), {.width = 8, .height = 8},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               const Question question{.points = graph.upload("test.points", asked.points),
                                       .point_count = std::uint32_t(asked.points.size()),
                                       .lights = graph.upload("test.lights", asked.lights),
                                       .light_bytes = sizeof(SightEnd),
                                       .sets = graph.upload("test.sets", asked.sets),
                                       .set_count = std::uint32_t(asked.sets.size()),
                                       .words = asked.words};
               visible = sight.record(graph, "test.visibility", inputs.scene, question, means);
               return frame::Lighting{};
             });
  return visible.buffer().download<std::uint32_t>();
}

/// Points over the floor and on the ball, lights of all kinds around, in three sets.
Asked manyAsked() {
  Asked asked;
  sampling::Rng rng(11);
  for (int i = 0; i < 700; ++i) {
    const glm::vec3 at = 8.0f * rng.next3() - 4.0f;
    asked.points.push_back(
        i % 2 == 0
            ? SightPoint{{at.x, 0, at.z}, 1e-3f, {0, 1, 0}, std::uint32_t(i % 3)}
            : SightPoint{
                  {at.x, 1.5f, at.z}, 0.0f, sampling::uniformSphere(rng.next2()), std::uint32_t(i % 3)});
  }
  for (int i = 0; i < 150; ++i) {
    SightEnd end{};
    end.kind = std::uint32_t(i % 5);
    end.normal = sampling::uniformSphere(rng.next2());
    end.offset = 1e-3f;
    end.position = end.kind == kSightDirectional ? sampling::uniformSphere(rng.next2())
                                                 : glm::vec3(6, 3, 6) * (2.0f * rng.next3() - 1.0f);
    asked.lights.push_back(end);
  }
  asked.sets = {{0, 60, 0, 0}, {60, 33, 0, 0}, {93, 57, 0, 0}};
  return asked;
}

Scene wallAndBall() {
  SceneBuilder builder("wall");
  const int white = builder.diffuse("white", glm::vec3(0.7f));
  builder.place("floor", shapes::ground(10, 10, 2, 2), white);
  builder.place("wall", shapes::roundedBox({1, 1, 0.05f}, 0.01f, 0.5f, 1), white, {0, 1, 0});
  builder.place("ball", shapes::icosphere(0.7f, 12), white, {2, 1, 1});
  return builder.finish();
}

int differing(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::popcount(a[i] ^ b[i]);
  return count;
}
int seen(const std::vector<std::uint32_t>& bits) {
  return differing(bits, std::vector<std::uint32_t>(bits.size(), 0u));
}

/// What the documentation says, one ray after the other.
std::vector<std::uint32_t> slowly(const WorldTracer& tracer, const Asked& asked) {
  std::vector<std::uint32_t> bits(asked.points.size() * asked.words, 0u);
  for (std::size_t p = 0; p < asked.points.size(); ++p) {
    const SightPoint& point = asked.points[p];
    const glm::vec3 origin = point.position + point.offset * point.normal;
    const SightSet& set = asked.sets[point.set];
    for (std::uint32_t k = 0; k < set.count; ++k) {
      const SightEnd& end = asked.lights[set.first + k];
      if (end.kind == kSightNothing) continue;
      glm::vec3 to = end.position;
      float distance = INFINITY;
      if (end.kind != kSightDirectional) {
        to = end.position - origin;
        const float side = glm::dot(to, end.normal) > 0.0f ? -1.0f : 1.0f;
        if (end.kind == kSightSurface && side < 0.0f) continue;
        if (glm::dot(to, point.normal) <= 0.0f) continue;
        const float before = end.kind == kSightLamp ? 0.0f : end.offset;
        to += side * before * end.normal;
        const float length = glm::length(to);
        to /= length;
        distance = std::max(length - before, 0.0f);
      } else if (glm::dot(to, point.normal) <= 0.0f) {
        continue;
      }
      if (!tracer.occluded(trace::Ray{origin, to, 0.0f, distance}))
        bits[k / 32 * asked.points.size() + p] |= 1u << (k % 32);
    }
  }
  return bits;
}

TEST(Visibility, AllMeansAgreeWithOneRayAfterTheOther) {
  const Scene scene = wallAndBall();
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  const Asked asked = manyAsked();
  const auto host = ask(frame, sight, pose(scene, 0.0f), asked, Means::kHost);
  const auto device = ask(frame, sight, pose(scene, 0.0f), asked, Means::kDevice);
  const auto want = slowly(sight.world().tracer(), asked);
  ASSERT_EQ(host.size(), want.size());
  ASSERT_EQ(device.size(), want.size());
  EXPECT_GT(seen(want), 5000);
  EXPECT_LE(differing(host, want), 3);  // edges that rays graze
  EXPECT_LE(differing(device, want), 3);
  const std::uint64_t rays = sight.tracedRays();
  EXPECT_GT(rays, std::uint64_t(seen(want)));
  EXPECT_LT(rays, 700u * 60u / 2u);  // what looks away costs none
}

TEST(Visibility, SameBitsOnAnyNumberOfThreads) {
  const Scene scene = wallAndBall();
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  const auto many = ask(frame, sight, pose(scene, 0.0f), manyAsked(), Means::kHost);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(ask(frame, sight, pose(scene, 0.0f), manyAsked(), Means::kHost), many);
}

// A wall goes up, one point at a time sees more; a figure walks.
TEST(Visibility, WhatMovesIsFollowed) {
  Scene scene = wallAndBall();
  Asked asked;
  asked.words = 1;
  asked.points = {{{0, 0, 2}, 1e-4f, {0, 1, 0}, 0}, {{3, 0, -2}, 1e-4f, {0, 1, 0}, 0}};
  asked.lights = {{{0, 0.5f, -2}, kSightSurface, {0, 0, 1}, 1e-4f},
                  {{0, 0.5f, 4}, kSightSurface, {0, 0, 1}, 1e-4f}};
  asked.sets = {{0, 2, 0, 0}};
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  using Words = std::vector<std::uint32_t>;
  for (const Means means : {Means::kHost, Means::kDevice})
    EXPECT_EQ(ask(frame, sight, pose(scene, 0.0f), asked, means), (Words{0b00, 0b00})) << int(means);
  scene.nodes[1].translation.y = 5.0f;
  for (const Means means : {Means::kHost, Means::kDevice})
    EXPECT_EQ(ask(frame, sight, pose(scene, 0.0f), asked, means), (Words{0b01, 0b00})) << int(means);
  const Scene walker = loadScene("builtin:walker");
  frame::TestFrame walking(walker);
  for (const float time_s : {0.0f, 0.4f, 0.9f}) {
    const auto host = ask(walking, sight, pose(walker, time_s), manyAsked(), Means::kHost);
    const auto device = ask(walking, sight, pose(walker, time_s), manyAsked(), Means::kDevice);
    EXPECT_LE(differing(host, device), seen(host) / 1000);
    EXPECT_GT(seen(host), 1000);
  }
}

// Whether in one hierarchy or in two, and whatever moved before.
TEST(Visibility, WhatMovedIsWhereAFreshSceneHasIt) {
  Scene scene = wallAndBall();
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  const Asked asked = manyAsked();
  for (const int node : {2, 1, 0}) {
    scene.nodes[std::size_t(node)].translation += glm::vec3(0.3f, 0.1f, -0.2f);
    const auto now = ask(frame, sight, pose(scene, 0.0f), asked, Means::kHost);
    Visibility fresh(gpu::testDevice());
    EXPECT_LE(differing(now, ask(frame, fresh, pose(scene, 0.0f), asked, Means::kHost)), 3);
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 origin = asked.points[std::size_t(i)].position + glm::vec3(0, 1e-3f, 0);
      const trace::Ray ray{origin, asked.points[std::size_t(i) + 1].normal};
      const trace::Hit hit = sight.world().tracer().closest(ray), want = fresh.world().tracer().closest(ray);
      EXPECT_EQ(hit.instance, want.instance);
      EXPECT_EQ(hit.triangle, want.triangle);
      if (!hit) continue;
      EXPECT_EQ(sight.world().tracer().surfaceOffset(hit), fresh.world().tracer().surfaceOffset(want));
    }
  }
}

TEST(Visibility, HolesAreLookedThroughByTheHost) {
  SceneBuilder builder("fence");
  const int paint = builder.diffuse("fence", glm::vec3(1.0f));
  builder.place("fence", shapes::patch({-1, 1, -1}, {1, 0, 0}, {0, 0, 1}, {0.0f, 2.0f}, {0.0f, 2.0f}), paint);
  Scene scene = builder.finish();
  Texture texture{"fence", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}};  // closed on the left
  scene.textures.push_back(texture);
  Material& material = scene.materials[std::size_t(paint)];
  material.alpha_mask = true;
  material.base_color_map.texture = 0;
  material.base_color_map.nearest = true;
  Mesh& mesh = scene.meshes[0];
  mesh.uv_sets.assign(1, {});
  for (const glm::vec3& p : mesh.positions) mesh.uv_sets[0].emplace_back(0.5f * (p.x + 1.0f), 0.5f);
  Asked asked;
  asked.words = 1;
  asked.points = {{{-0.5f, 0, 0}, 0.0f, {0, 1, 0}, 0}, {{0.5f, 0, 0}, 0.0f, {0, 1, 0}, 0}};
  asked.lights = {{{0, 1, 0}, kSightDirectional, {0, -1, 0}, 0.0f}};
  asked.sets = {{0, 1, 0, 0}};
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  EXPECT_EQ(ask(frame, sight, pose(scene, 0.0f), asked, Means::kHost), (std::vector<std::uint32_t>{0, 1}));
}

TEST(Visibility, OddQuestionsHaveAnswers) {
  const Scene scene = wallAndBall();
  frame::TestFrame frame(scene);
  Visibility sight(gpu::testDevice());
  Asked asked = manyAsked();
  asked.points[0].normal = glm::vec3(0.0f);  // background
  asked.points[1].set = 99;
  asked.words = 1;  // the rest of a set is not looked at
  for (const Means means : {Means::kHost, Means::kDevice}) {
    const auto bits = ask(frame, sight, pose(scene, 0.0f), asked, means);
    ASSERT_EQ(bits.size(), asked.points.size());
    EXPECT_EQ(bits[0], 0u);
    EXPECT_EQ(bits[1], 0u);
    EXPECT_GT(seen(bits), 1000);
  }
  asked.words = 0;
  EXPECT_TRUE(ask(frame, sight, pose(scene, 0.0f), asked, Means::kAuto).empty());
  EXPECT_EQ(meansNamed("host"), Means::kHost);
  EXPECT_EQ(meansNamed("none"), Means::kAuto);
  EXPECT_EQ(sight.choose(Means::kAuto), Means::kHost);  // tests run on the software driver
}

}  // namespace
}  // namespace gloam::visibility
