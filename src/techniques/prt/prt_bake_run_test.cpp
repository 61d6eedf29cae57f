// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How a bake runs: threads, interruptions, checkpoints, bad input (PRT-3).
#include <gloam/bake.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>

#include "scene/checkpoint_file.h"
#include "techniques/prt/prt_bake_edges.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_bake_turn.h"

namespace gloam::prt {
namespace {

bool sameBits(const Scene& a, const Scene& b) {
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    if (a.meshes[m].transfer->direct != b.meshes[m].transfer->direct) return false;
    if (a.meshes[m].transfer->indirect != b.meshes[m].transfer->indirect) return false;
  }
  return a.meshes.size() == b.meshes.size();
}

// ---- Threads, interruption, checkpoints --------------------------------------------------------------------------------

TEST(PrtBake, SameBitsForAnyNumberOfThreads) {
  const Scene scene = crowdedScene();
  BakeOptions options = interreflected(2, 5);
  options.threads = 1;
  const Scene one = bakeTransfer(scene, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    EXPECT_TRUE(sameBits(one, bakeTransfer(scene, options))) << threads;
  }
}

struct CheckpointFile {
  std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".ckp");
  CheckpointFile() { std::filesystem::remove(path); }
  ~CheckpointFile() { std::filesystem::remove(path); }
};

TEST(PrtBake, InterruptedAndResumedGivesTheSameBits) {
  const Scene scene = crowdedScene();
  const CheckpointFile file;
  BakeOptions options = interreflected(2, 4);
  const Scene whole = bakeTransfer(scene, options);
  options.checkpoint = file.path;
  int interruptions = 0;
  double last_fraction = 0.0;
  for (;; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    Progress progress;
    int asked = 0;
    progress.should_stop = [&] { return ++asked > 12; };
    progress.update = [&](double fraction, const std::string&) {
      EXPECT_GE(fraction, 0.0);
      EXPECT_LE(fraction, 1.0);
      last_fraction = fraction;
    };
    BakeReport report;
    try {
      const Scene resumed = bakeTransfer(scene, options, progress, &report);
      EXPECT_TRUE(report.resumed);
      EXPECT_TRUE(sameBits(whole, resumed));
      break;
    } catch (const Interrupted& e) {
      EXPECT_NE(std::string(e.what()).find(file.path.string()), std::string::npos);
      EXPECT_TRUE(std::filesystem::exists(file.path));
    }
  }
  EXPECT_GT(interruptions, 5);
  EXPECT_GT(last_fraction, 0.5);
  EXPECT_FALSE(std::filesystem::exists(file.path));
}

void interruptSoon(const Scene& scene, const BakeOptions& options) {
  Progress progress;
  int asked = 0;
  progress.should_stop = [&] { return ++asked > 5; };
  EXPECT_THROW(bakeTransfer(scene, options, progress), Interrupted);
}

TEST(PrtBake, ForeignCheckpointsAreRefusedAndKept) {
  const Scene scene = crowdedScene();
  const CheckpointFile file;
  BakeOptions options = shadowed();
  options.checkpoint = file.path;
  std::ofstream(file.path) << "a letter to someone";
  EXPECT_THROW(bakeTransfer(scene, options), Error);
  EXPECT_EQ(std::filesystem::file_size(file.path), 19u);
  std::filesystem::remove(file.path);

  interruptSoon(scene, options);
  const auto size = std::filesystem::file_size(file.path);
  BakeOptions other_order = options, other_count = options;
  other_order.order = 5;
  other_count.directions = 8192;
  EXPECT_THROW(bakeTransfer(scene, other_order), Error);
  EXPECT_THROW(bakeTransfer(scene, other_count), Error);
  Scene moved = scene;
  moved.meshes[0].positions[0].x += 0.001f;
  EXPECT_THROW(bakeTransfer(moved, options), Error);
  EXPECT_EQ(std::filesystem::file_size(file.path), size);

  std::filesystem::resize_file(file.path, size / 2);  // cut off, as by a full disk
  EXPECT_THROW(bakeTransfer(scene, options), Error);
  options.checkpoint = "/nonexistent/folder/x.ckp";
  Progress stop;
  stop.should_stop = [] { return true; };
  EXPECT_THROW(bakeTransfer(scene, options, stop), std::runtime_error);
}

TEST(PrtBake, DamagedCheckpointsAreRefused) {
  const Scene scene = crowdedScene();
  const CheckpointFile file;
  BakeOptions options = shadowed();
  options.checkpoint = file.path;
  interruptSoon(scene, options);
  std::fstream damaged(file.path, std::ios::binary | std::ios::in | std::ios::out);
  damaged.seekp(std::streamoff(std::filesystem::file_size(file.path)) - 100);
  damaged.put('\x55');
  damaged.close();
  EXPECT_THROW(bakeTransfer(scene, options), Error);
}

// Who has more work to do keeps all of it, and has it again at once.
TEST(PrtBake, FinishedWorkIsKeptWhereThatIsAskedFor) {
  Scene scene = crowdedScene();
  const CheckpointFile file;
  for (const bool apart : {false, true}) {
    BakeOptions options = interreflected(2, 4);
    options.apart = apart;
    const Scene whole = bakeTransfer(scene, options);
    options.checkpoint = file.path;
    options.keep_checkpoint = true;
    BakeReport first, second;
    EXPECT_TRUE(sameBits(whole, bakeTransfer(scene, options, {}, &first)));
    EXPECT_FALSE(first.resumed);
    ASSERT_TRUE(std::filesystem::exists(file.path));
    EXPECT_TRUE(sameBits(whole, bakeTransfer(scene, options, {}, &second)));
    EXPECT_TRUE(second.resumed);
    EXPECT_EQ(second.rays + second.bounce_rays, 0u);
    ASSERT_TRUE(std::filesystem::exists(file.path));
    EXPECT_EQ(std::filesystem::exists(file.path.string() + ".1"), apart);
    removeBakeCheckpoint(file.path);
    EXPECT_FALSE(std::filesystem::exists(file.path));
    EXPECT_FALSE(std::filesystem::exists(file.path.string() + ".1"));
  }
}

// Stages count from what was kept last, whoever kept it.
TEST(PrtBake, ThatWorkWasKeptIsKnownToAllOfTheProcess) {
  const auto before = std::chrono::steady_clock::now();
  const CheckpointFile file;
  interruptSoon(crowdedScene(), [&] {
    BakeOptions options = shadowed();
    options.checkpoint = file.path;
    return options;
  }());
  EXPECT_GE(CheckpointWriter::lastCommit(), before);
}

// ---- Turned directions ---------------------------------------------------------------------------------------------

TEST(PrtBake, TurnsAreRotationsAndSpreadOverPlaces) {
  const Turns& turns = Turns::of(5);
  std::set<const Turn*> met;
  glm::mat3 sum(0.0f);
  for (int k = 0; k < 2000; ++k) {
    const glm::vec3 place(0.01f * float(k), 0.0f, 1.0f);
    const Turn& turn = turns.at(place, {0, 1, 0});
    EXPECT_EQ(&turn, &turns.at(place, {-0.0f, 1, 0}));
    met.insert(&turn);
    sum += turn.matrix / 2000.0f;
    const glm::mat3 product = glm::transpose(turn.matrix) * turn.matrix;
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(product[c], glm::mat3(1.0f)[c]), 1e-5f);
    EXPECT_GT(glm::determinant(turn.matrix), 0.0f);
  }
  EXPECT_EQ(met.size(), Turns::kCount);
  for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(sum[c]), 0.35f) << "turned to all sides";
}

// Few directions err from point to point: neighbours of one plain do not err alike, and bounces are lit by the mean of them.
TEST(PrtBake, NeighboursDoNotErrAlike) {
  Scene scene = sceneOf(gridMesh(2.0f, 16));
  addMesh(scene, quadMesh({0, 1, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}));
  const Scene truth = bakeTransfer(scene, shadowed(3, 32768)), few = bakeTransfer(scene, shadowed(3, 256));
  const std::vector<float>&t = truth.meshes[0].transfer->direct, &f = few.meshes[0].transfer->direct;
  double alike = 0.0, size = 0.0;
  for (std::size_t v = 0; v + 1 < scene.meshes[0].vertexCount(); ++v) {
    for (std::size_t i = 0; i < 9; ++i) {
      const double here = double(f[9 * v + i] - t[9 * v + i]),
                   next = double(f[9 * v + 9 + i] - t[9 * v + 9 + i]);
      alike += here * next;
      size += here * here;
    }
  }
  ASSERT_GT(size, 0.0);
  EXPECT_LT(alike / size, 0.25) << "1: all points err alike";
}

// ---- Bad input -------------------------------------------------------------------------------------------------------

TEST(PrtBake, RefusesWhatCannotBeBaked) {
  EXPECT_THROW(bakeTransfer({}, shadowed()), Error);
  Scene no_triangles = sceneOf(Mesh{});
  EXPECT_THROW(bakeTransfer(no_triangles, shadowed()), Error);
  const Scene scene = sceneOf(sphereMesh(4, 8));
  const auto refused = [&](auto change) {
    BakeOptions options = interreflected(1);
    change(options);
    EXPECT_THROW(bakeTransfer(scene, options), Error);
    EXPECT_THROW(estimateBake(scene, options), Error);
  };
  refused([](BakeOptions& o) { o.order = 2; });
  refused([](BakeOptions& o) { o.order = 7; });
  refused([](BakeOptions& o) { o.bounces = 0; });
  refused([](BakeOptions& o) { o.bounces = 65; });
  refused([](BakeOptions& o) { o.directions = 100; });
  refused([](BakeOptions& o) { o.directions = 1 << 30; });
  refused([](BakeOptions& o) { o.bounce_directions = -1; });
  refused([](BakeOptions& o) { o.threads = -1; });
}

TEST(PrtBake, EstimateBoundsWhatTheBakeMakes) {
  const Scene scene = crowdedScene();
  const BakeEstimate estimate = estimateBake(scene, interreflected(1, 5));
  const Scene baked = bakeTransfer(scene, interreflected(1, 5));
  std::size_t bytes = 0, vertices = 0;
  for (const Mesh& mesh : baked.meshes) {
    bytes += (mesh.transfer->direct.size() + mesh.transfer->indirect.size()) * sizeof(float);
    vertices += mesh.vertexCount();
    EXPECT_EQ(mesh.transfer->order, 5);
    EXPECT_EQ(mesh.transfer->bounces, 1);
  }
  EXPECT_EQ(estimate.vertices, vertices);
  EXPECT_GE(estimate.memory_bytes, 2 * bytes);
  EXPECT_GE(estimate.file_bytes, bytes);
  EXPECT_GT(estimateBake(scene, interreflected(1, 6)).memory_bytes, estimate.memory_bytes);
}

// What the file takes follows from how it is written; hits that nothing blocks are not counted on.
TEST(PrtBake, EstimateKnowsHowTheFileIsWrittenAndWhatIsOpen) {
  const Scene scene = crowdedScene();
  const BakeOptions options = interreflected(3, 5, 4096, 4096);
  const auto bytes = [&](const BakeFileForm& form) { return estimateBake(scene, options, form).file_bytes; };
  EXPECT_LT(bytes({.half_float = true}), bytes({}) * 2 / 3);
  EXPECT_LT(bytes({.clusters = 1, .vectors = 8}), bytes({}) / 2);
  EXPECT_LT(bytes({.half_float = true, .clusters = 1, .vectors = 8}), bytes({.clusters = 1, .vectors = 8}));
  const Scene ball = sceneOf(sphereMesh(100, 200));
  const BakeEstimate open = estimateBake(ball, options);
  EXPECT_LT(open.memory_bytes, open.least_memory_bytes * 11 / 10) << "a ball blocks nothing of itself";
  EXPECT_EQ(open.vertices, ball.meshes[0].vertexCount());
}

TEST(PrtBake, EdgesOfMoreThanTwoTrianglesAreCounted) {
  EXPECT_EQ(crowdedEdges(boxMesh({1, 1, 1}, false)), 0u);
  EXPECT_EQ(crowdedEdges(gridMesh(1.0f, 4)), 0u);
  Mesh fins;  // three sheets that meet in the edge from (0, 0, 0) to (0, 1, 0), each with vertices of its own
  for (const glm::vec3 tip : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 1), glm::vec3(0, 0, -1)}) {
    for (const glm::vec3 p : {glm::vec3(0, 0, 0), glm::vec3(0, 1, 0), tip}) {
      fins.indices.push_back(std::uint32_t(fins.positions.size()));
      fins.positions.push_back(p);
      fins.normals.push_back({0, 0, 1});
    }
  }
  fins.name = "fins";
  EXPECT_EQ(crowdedEdges(fins), 1u);
  BakeReport report;
  bakeTransfer(sceneOf(fins), shadowed(3, 256), {}, &report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("mesh 'fins' is no manifold: 1 edge has"), std::string::npos)
      << report.warnings[0];
}

// `gloam bake` refuses what is none.
TEST(PrtBake, BuiltInScenesAreManifold) {
  for (const BuiltinScene& built_in : builtinScenes()) {
    const Scene scene = loadScene(std::string("builtin:") + built_in.name + "?detail=0.25");
    EXPECT_EQ(crowdedEdgesText(scene, pose(scene, 0.0f)), "") << built_in.name;
  }
}

}  // namespace
}  // namespace gloam::prt
