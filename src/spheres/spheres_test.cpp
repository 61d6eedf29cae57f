// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sphere sets of whole scenes (SS-1): quality where it can be derived, what only receives, odd meshes, files.
#include <gloam/spheres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "spheres/objects.h"
#include "spheres/test_scenes.h"

namespace gloam::spheres {
namespace {

SphereSet fitOne(Mesh mesh, const SphereOptions& options) {
  return bakeSpheres(sceneOf(std::move(mesh)), options).sets.at(0);
}

void expectFinite(const SphereSet& set) {
  for (const Sphere& s : set.spheres) {
    EXPECT_TRUE(std::isfinite(s.center.x + s.center.y + s.center.z + s.radius)) << set.name;
    EXPECT_GT(s.radius, 0.0f);
  }
  EXPECT_TRUE(std::isfinite(set.figures.outside_sum + set.figures.outside_union + set.figures.volume));
}

// ---- Quality -----------------------------------------------------------------------------------------------------------

TEST(Spheres, ABallNeedsOne) {
  const SphereSet set = fitOne(shapes::moved(shapes::icosphere(2.0f, 20), {5, 6, 7}), quick(1));
  ASSERT_EQ(set.spheres.size(), 1u);
  EXPECT_LT(set.figures.relativeSum(), 0.015);  // the ball round the polyhedron
  EXPECT_GT(set.figures.coverage, 0.99999);
  EXPECT_NEAR(glm::distance(set.spheres[0].center, glm::vec3(5, 6, 7)), 0.0f, 0.02f);
  EXPECT_NEAR(set.spheres[0].radius, 2.0f, 0.01f);
}

TEST(Spheres, ABallAskedForThousandsTakesOneAndSaysSo) {
  const Scene scene = sceneOf(shapes::icosphere(1.0f, 20));
  const SceneSpheres spheres = bakeSpheres(scene, quick(4096));
  EXPECT_EQ(spheres.count(), 1);
  ASSERT_EQ(spheres.warnings.size(), 1u);
  EXPECT_NE(spheres.warnings[0].find("1 sphere of 4096 serve"), std::string::npos);
}

TEST(Spheres, OneRoundACubeIsItsCircumscribedBall) {
  const SphereSet set = fitOne(shapes::box({0, 0, 0}, {1, 1, 1}, 0.25f), quick(1));
  EXPECT_NEAR(set.spheres.at(0).radius, std::sqrt(0.75f), 0.01f);
  EXPECT_NEAR(set.figures.relativeSum(), double(ballVolume(std::sqrt(0.75f))) - 1.0, 0.06);
}

TEST(Spheres, MoreSpheresLeaveLessOutside) {
  const auto expectLess = [](const Mesh& mesh, const std::vector<int>& counts) {
    double before = INFINITY;
    for (const int k : counts) {
      const SphereSet set = fitOne(mesh, quick(k));
      EXPECT_LE(int(set.spheres.size()), k);
      EXPECT_EQ(set.figures.coverage, 1.0);
      EXPECT_LT(set.figures.relativeSum(), 0.9 * before) << k;
      EXPECT_LE(set.figures.outside_union, set.figures.outside_sum * 1.0001);
      before = set.figures.relativeSum();
    }
  };
  expectLess(shapes::box({-1, -0.6f, -0.4f}, {1, 0.6f, 0.4f}, 0.1f), {1, 2, 8});
  expectLess(shapes::torus(1.0f, 0.35f, 48, 24), {2, 6, 14});
}

TEST(Spheres, EveryVertexIsInside) {
  const Mesh mesh = shapes::torusKnot(2, 3, 0.2f, 0.085f, 0.052f, 120, 12);
  const SphereSet set = fitOne(mesh, quick(12));
  for (const glm::vec3& p : mesh.positions) {
    EXPECT_TRUE(std::ranges::any_of(
        set.spheres, [&](const Sphere& s) { return glm::distance(p, s.center) <= s.radius * 1.000001f; }));
  }
}

// ---- Same bits, interruption, options ------------------------------------------------------------------------------------

TEST(Spheres, SameBitsForAnyNumberOfThreads) {
  const Scene scene = sceneOf(shapes::torus(1.0f, 0.35f, 24, 12));
  SphereOptions options = quick(5, 0.02f);
  options.threads = 1;
  const SceneSpheres one = bakeSpheres(scene, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const SceneSpheres many = bakeSpheres(scene, options);
    ASSERT_EQ(many.sets[0].spheres.size(), one.sets[0].spheres.size());
    for (std::size_t s = 0; s < one.sets[0].spheres.size(); ++s) {
      EXPECT_EQ(many.sets[0].spheres[s].center, one.sets[0].spheres[s].center);
      EXPECT_EQ(many.sets[0].spheres[s].radius, one.sets[0].spheres[s].radius);
    }
    EXPECT_EQ(many.sets[0].figures.outside_union, one.sets[0].figures.outside_union);
  }
  options.seed = 2;
  EXPECT_NE(bakeSpheres(scene, options).sets[0].spheres[0].center, one.sets[0].spheres[0].center);
}

TEST(Spheres, UnitOfLengthDoesNotMatter) {
  const Mesh torus = shapes::torus(1.0f, 0.35f, 32, 16);
  const double unit = fitOne(torus, quick(6)).figures.relativeSum();
  for (const float scale : {1e-6f, 1e6f}) {
    const SphereSet set = fitOne(shapes::transformed(torus, glm::mat4(glm::mat3(scale))), quick(6));
    EXPECT_NEAR(set.figures.relativeSum(), unit, 0.05 * unit) << scale;
    expectFinite(set);
  }
}

TEST(Spheres, StopsWhenAsked) {
  int asked = 0;
  Progress progress;
  progress.should_stop = [&] { return ++asked > 20; };
  EXPECT_THROW(bakeSpheres(sceneOf(shapes::torus(1.0f, 0.35f, 32, 16)), quick(16, 20.0f), progress),
               Interrupted);
}

TEST(Spheres, ReportsRisingProgress) {
  double last = 0.0;
  Progress progress;
  progress.update = [&](double fraction, const std::string&) {
    EXPECT_GE(fraction, last - 1e-9);
    EXPECT_LE(fraction, 1.0 + 1e-9);
    last = fraction;
  };
  bakeSpheres(sceneOf(shapes::torus(1.0f, 0.35f, 24, 12)), quick(4), progress);
  EXPECT_NEAR(last, 1.0, 1e-9);
}

TEST(Spheres, RefusesOptionsOutOfRangeAndEmptyScenes) {
  const Scene scene = sceneOf(shapes::icosphere(1.0f, 3));
  for (const int count : {-1, 4097}) EXPECT_THROW(bakeSpheres(scene, quick(count)), Error) << count;
  SphereOptions options = quick(4);
  options.effort = NAN;
  EXPECT_THROW(bakeSpheres(scene, options), Error);
  EXPECT_THROW(bakeSpheres(Scene{}, quick(4)), Error);
  EXPECT_NO_THROW(bakeSpheres(scene, quick(1, 0.01f)));
}

// ---- Odd meshes ---------------------------------------------------------------------------------------------------------

TEST(Spheres, OpenAndInsideOutMeshesGetAnAnswer) {
  Mesh open = shapes::icosphere(1.0f, 10);
  open.indices.resize(open.indices.size() * 9 / 10 / 3 * 3);
  const SceneSpheres holed = bakeSpheres(sceneOf(open), quick(4));
  EXPECT_GT(holed.sets[0].figures.coverage, 0.999);
  EXPECT_GT(holed.sets[0].figures.volume, 3.0);
  EXPECT_NE(holed.warnings.at(0).find("not closed"), std::string::npos);

  const SceneSpheres turned = bakeSpheres(sceneOf(turnedInsideOut(shapes::icosphere(1.0f, 10))), quick(1));
  EXPECT_LT(turned.sets[0].figures.relativeSum(), 0.05);
  EXPECT_NE(turned.warnings.at(0).find("faces inward"), std::string::npos);

  const SceneSpheres cross = bakeSpheres(sceneOf(crossedSheets()), quick(12));
  EXPECT_GT(cross.sets[0].figures.coverage, 0.999);
  EXPECT_NE(cross.warnings.at(0).find("sheet"), std::string::npos);
}

TEST(Spheres, DegenerateMeshesOnlyReceive) {
  Mesh triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals.assign(3, {0, 0, 1});
  triangle.indices = {0, 1, 2};
  Mesh line = triangle, point = triangle;
  line.positions[2] = {2, 0, 0};
  point.positions.assign(3, {1, 1, 1});
  for (const Mesh& mesh : {triangle, line, point}) {
    const SceneSpheres spheres = bakeSpheres(sceneOf(mesh), quick(3));
    EXPECT_FALSE(spheres.sets[0].receive_only.empty());
    EXPECT_TRUE(spheres.sets[0].spheres.empty());
    EXPECT_EQ(spheres.warnings.size(), 1u);
  }
}

TEST(Spheres, TinySolidsWork) {
  Mesh tetrahedron;
  tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.normals.assign(4, {0, 1, 0});
  tetrahedron.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const SphereSet set = fitOne(tetrahedron, quick(16));  // more than sense
  expectFinite(set);
  EXPECT_GT(set.figures.coverage, 0.999);
}

TEST(Spheres, TrianglesWithoutAreaDoNoHarm) {
  Mesh mesh = shapes::icosphere(1.0f, 8);
  for (std::uint32_t i = 0; i < 60; i += 3) {
    mesh.indices.insert(mesh.indices.end(), {i, i, i + 1, i, i, i});
  }
  const SphereSet set = fitOne(mesh, quick(1));
  EXPECT_LT(set.figures.relativeSum(), 0.05);
}

// ---- Scenes -------------------------------------------------------------------------------------------------------------

TEST(Spheres, GroundAndWallsOnlyReceive) {
  SceneBuilder builder("stage");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  builder.place("ground", shapes::ground(4, 4, 4, 4), white);
  builder.place("wall", shapes::box({-2, 0, -2.1f}, {2, 2, -2}, 0.5f), white);
  builder.place("ball", shapes::icosphere(0.3f, 8), white, {0, 0.3f, 0});
  builder.place("hoop", shapes::torus(0.5f, 0.055f, 48, 12), white, {-1, 0.3f, 0});
  builder.place("knot", shapes::torusKnot(2, 3, 0.2f, 0.085f, 0.052f, 90, 10), white, {1, 0.3f, 0});
  const SceneSpheres spheres = bakeSpheres(builder.finish(), quick(20, 0.02f));
  ASSERT_EQ(spheres.sets.size(), 5u);
  EXPECT_NE(spheres.sets[0].receive_only.find("flat"), std::string::npos);
  EXPECT_NE(spheres.sets[1].receive_only.find("flat"), std::string::npos);
  EXPECT_EQ(spheres.sets[2].spheres.size(), 1u) << "a ball needs one";
  EXPECT_EQ(spheres.sets[3].receive_only.find("flat"), std::string::npos) << "few spheres make a hoop";
  EXPECT_GE(spheres.sets[4].spheres.size(), 3u) << "the rest goes to what gains by it";
  EXPECT_LE(spheres.count(), 20);
}

TEST(Spheres, RoomsOnlyReceive) {
  for (const bool thick : {false, true}) {
    SceneBuilder builder("room");
    const int white = builder.diffuse("white", glm::vec3(0.5f));
    Mesh room = turnedInsideOut(shapes::box({-2, 0, -2}, {2, 3, 2}, 1.0f));
    if (thick) shapes::append(room, shapes::box({-2.2f, -0.2f, -2.2f}, {2.2f, 3.2f, 2.2f}, 1.0f));
    builder.place("room", std::move(room), white);
    builder.place("ball", shapes::icosphere(0.3f, 8), white, {0, 0.3f, 0});
    const SceneSpheres spheres = bakeSpheres(builder.finish(), quick(2, 0.02f));
    EXPECT_NE(spheres.sets[0].receive_only.find("room"), std::string::npos) << thick;
    EXPECT_TRUE(spheres.sets[1].receive_only.empty());
  }
}

TEST(Spheres, NodesOfOneMeshShareASetUnlessStretchedApart) {
  SceneBuilder builder("copies");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  const int ball = builder.mesh("ball", shapes::icosphere(1.0f, 10), white);
  for (int i = 0; i < 3; ++i) {
    const int node = builder.node("copy", kNone, {3.0f * float(i), 0, 0});
    builder.at(node).meshes = {ball};
    if (i == 2) builder.at(node).scale = {3, 1, 1};
  }
  const Scene scene = builder.finish();
  const SceneSpheres spheres = bakeSpheres(scene, quick(12));
  ASSERT_EQ(spheres.sets.size(), 2u);
  EXPECT_EQ(spheres.sets[0].nodes.size(), 2u);
  EXPECT_EQ(spheres.sets[0].spheres.size(), 1u);
  EXPECT_GT(spheres.sets[1].spheres.size(), 4u) << "a stretched ball is no ball";
  EXPECT_LE(int(poseSpheres(spheres, scene, pose(scene, 0.0f)).size()), 12);
}

TEST(Spheres, WhatAnAnimationStretchesIsTold) {
  for (const bool evenly : {true, false}) {
    SceneBuilder builder("grows");
    const int ball =
        builder.mesh("ball", shapes::icosphere(1.0f, 10), builder.diffuse("white", glm::vec3(0.5f)));
    const int node = builder.node("egg", kNone, {0, 0, 0});
    builder.at(node).meshes = {ball};
    Scene scene = builder.finish();
    AnimationChannel channel;
    channel.node = node;
    channel.path = AnimationChannel::Path::kScale;
    channel.times_s = {0, 1};
    channel.values = {1, 1, 1, 3, evenly ? 3.0f : 1.0f, evenly ? 3.0f : 0.5f};
    scene.animations.push_back({"grow", {channel}});
    const Warnings warnings = bakeSpheres(scene, quick(1)).warnings;
    ASSERT_EQ(warnings.size(), evenly ? 0u : 1u);
    if (evenly) continue;
    EXPECT_EQ(warnings.front().find("egg: an animation stretches it 6 times"), 0u) << warnings.front();
  }
}

TEST(Spheres, SpreadGivesOneToEachAndTheRestByWhatIsGained) {
  std::vector<Object> objects(3);
  for (Object& object : objects) {
    object.solid = makeSolid(soupOf(shapes::box({0, 0, 0}, {2, 1, 1}, 0.5f)));
    object.world_scale3 = 1.0f;
  }
  objects[1].world_scale3 = 1000.0f;
  objects[2].set.receive_only = "test";
  spreadCount(objects, 20);
  EXPECT_EQ(objects[0].count + objects[1].count, 20);
  EXPECT_GT(objects[1].count, 15);
  EXPECT_EQ(objects[2].count, 0);
  spreadCount(objects, 1);
  EXPECT_EQ(objects[0].count, 1);
  EXPECT_EQ(objects[1].count, 1);
}

// A large thin frame would take most spheres and cast nothing all the same.
TEST(Spheres, WhatIsTooThinLeavesItsShareToOthers) {
  SceneBuilder builder("frame");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  builder.place("frame", shapes::torusKnot(2, 3, 4.0f, 1.6f, 0.03f, 120, 8), white);
  builder.place("knot", shapes::torusKnot(2, 3, 0.3f, 0.13f, 0.08f, 90, 12), white);
  builder.place("ball", shapes::icosphere(0.3f, 8), white, {1, 0, 0});
  SphereOptions options = quick(9, 0.02f);
  const SceneSpheres spheres = bakeSpheres(builder.finish(), options);
  EXPECT_NE(spheres.sets[0].receive_only.find("thin"), std::string::npos);
  EXPECT_EQ(spheres.sets[1].spheres.size(), 8u);
  EXPECT_EQ(spheres.sets[2].spheres.size(), 1u);
}

// Rings want a string of small spheres each, a ball one; the number follows.
TEST(Spheres, TheNumberFollowsFromTheShapes) {
  SceneBuilder builder("rings");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  builder.place("large ring", shapes::torus(0.7f, 0.075f, 64, 16), white, {0, 1, 0});
  builder.place("small ring", shapes::torus(0.34f, 0.05f, 48, 12), white, {2, 1, 0});
  builder.place("ball", shapes::icosphere(0.2f, 8), white, {0, 1, 0});
  const SphereOptions options = quick(0, 0.01f);
  const SceneSpheres spheres = bakeSpheres(builder.finish(), options);
  ASSERT_EQ(spheres.sets.size(), 3u);
  for (int ring = 0; ring < 2; ++ring) {
    EXPECT_GT(spheres.sets[std::size_t(ring)].spheres.size(), 8u);
    EXPECT_LT(spheres.sets[std::size_t(ring)].figures.relativeSum(), 4.0);
  }
  EXPECT_EQ(spheres.sets[2].spheres.size(), 1u);
  const SceneSpheres one = bakeSpheres(sceneOf(shapes::box({0, 0, 0}, {1, 1, 1}, 0.25f)), options);
  EXPECT_EQ(one.count(), 26);
}

// ---- Files --------------------------------------------------------------------------------------------------------------

struct SpheresFile : testing::Test {
  std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "gloam_test.spheres.json";
  Scene scene = sceneOf(shapes::torus(1.0f, 0.35f, 24, 12));
  SceneSpheres spheres = bakeSpheres(scene, quick(3, 0.02f));
  ~SpheresFile() override { std::filesystem::remove(path); }
  std::string text() {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void expectRefused(const std::string& from, const std::string& to, const std::string& says) {
    writeSpheres(spheres, path);
    std::string changed = text();
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    std::ofstream(path) << changed;
    try {
      readSpheres(path, scene);
      ADD_FAILURE() << to;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find(path.string()), 0u) << error.what();
    }
  }
};

TEST_F(SpheresFile, ComesBackWithTheSameBits) {
  writeSpheres(spheres, path);
  const SceneSpheres back = readSpheres(path, scene);
  ASSERT_EQ(back.sets.size(), 1u);
  ASSERT_EQ(back.sets[0].spheres.size(), spheres.sets[0].spheres.size());
  for (std::size_t s = 0; s < back.sets[0].spheres.size(); ++s) {
    EXPECT_EQ(back.sets[0].spheres[s].center, spheres.sets[0].spheres[s].center);
    EXPECT_EQ(back.sets[0].spheres[s].radius, spheres.sets[0].spheres[s].radius);
  }
  EXPECT_EQ(back.sets[0].figures.outside_sum, spheres.sets[0].figures.outside_sum);
  EXPECT_EQ(back.sets[0].name, "thing");
}

TEST_F(SpheresFile, OfAnotherModelIsRefused) {
  writeSpheres(spheres, path);
  EXPECT_THROW(readSpheres(path, sceneOf(shapes::torus(1.0f, 0.36f, 24, 12))), Error);
}

TEST_F(SpheresFile, DamagedIsRefusedByField) {
  expectRefused("gloam spheres", "gloom spheres", "expected a file of");
  expectRefused("\"version\": 1", "\"version\": 2", "version");
  expectRefused("\"spheres\"", "\"sphere\"", "spheres");
  expectRefused("\"meshes\": [\n    0", "\"meshes\": [\n    7", "meshes[0]");
  expectRefused("\"coverage\": ", "\"coverage\": \"x\", \"c\": ", "coverage");
  expectRefused("\"sets\": [", "\"sets\": {}, \"s\": [", "sets");
  std::ofstream(path) << "[1, 2";
  EXPECT_THROW(readSpheres(path, scene), Error);
  EXPECT_THROW(readSpheres(path.string() + ".none", scene), Error);
}

}  // namespace
}  // namespace gloam::spheres
