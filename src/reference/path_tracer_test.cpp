// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How a reference picture is gathered: threads, splits, interruptions, checkpoints, noise, layers. What light it holds is
// tested with the integrator.
#include <gloam/reference.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include "scene/builtin_scenes.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

/// A box with lamps and emission, under a sky.
struct Stage {
  Scene scene = makeBuiltinScene("cornell?detail=0.25");
  PosedScene posed = pose(scene, 0.0f);
  Environment environment = loadEnvironment("sky:mild");
  PosedCamera camera = posed.cameras.empty() ? framingCamera(posed, 1.5f) : posed.cameras.front();
  ReferenceOptions options{.width = 21, .height = 14, .supersample = 2, .bounces = 2, .seed = 7};

  PathTracer tracer() const { return {scene, posed, camera, environment, options}; }
  LayeredImage render(const ReferenceGoal& goal, const Progress& progress = {},
                      ReferenceReport* report = nullptr) const {
    return renderReference(scene, posed, camera, environment, options, goal, true, progress, report);
  }
};

bool sameBits(const LayeredImage& a, const LayeredImage& b) {
  if (a.layers.size() != b.layers.size() || a.attributes != b.attributes) return false;
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    const Layer &p = a.layers[i], &q = b.layers[i];
    if (p.name != q.name || p.ids != q.ids || p.pixels.size() != q.pixels.size()) return false;
    if (std::memcmp(p.pixels.data(), q.pixels.data(), p.pixels.size() * sizeof(float)) != 0) return false;
  }
  return true;
}

struct TemporaryFile {
  fs::path path = fs::path(testing::TempDir()) /
                  (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".ckp");
  TemporaryFile() { fs::remove(path); }
  ~TemporaryFile() { fs::remove(path); }
};

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Stops at the question after so many others; those that are asked before the first sample do not count.
Progress stopAfter(int questions) {
  Progress progress;
  auto left = std::make_shared<int>(questions);
  auto sampling = std::make_shared<bool>(false);
  progress.update = [sampling](double, const std::string& what) {
    *sampling = *sampling || what.find(" samples") != std::string::npos;
  };
  progress.should_stop = [=] { return *sampling && --*left < 0; };
  return progress;
}

// ---- Same bits ---------------------------------------------------------------------------------------------------------

TEST(PathTracer, SameBitsForAnyNumberOfThreadsAndAnySplit) {
  Stage stage;
  stage.options.threads = 1;
  PathTracer whole = stage.tracer();
  whole.refine(11);
  const LayeredImage expected = whole.imageWithParts();
  for (const int threads : {2, 5}) {
    stage.options.threads = threads;
    PathTracer split = stage.tracer();
    for (const int count : {1, 0, 3, 2, 5}) split.refine(count);
    EXPECT_EQ(split.samples(), 11);
    EXPECT_TRUE(sameBits(split.imageWithParts(), expected)) << threads;
  }
  stage.options.seed = 8;
  PathTracer other = stage.tracer();
  other.refine(11);
  EXPECT_FALSE(sameBits(other.imageWithParts(), expected));
}

TEST(PathTracer, StoppedWorkGoesOnWithTheSameBits) {
  Stage stage;
  stage.options.width = 160;
  stage.options.height = 120;
  PathTracer whole = stage.tracer(), stopped = stage.tracer();
  whole.refine(4);
  int stops = 0;
  while (stopped.samples() < 4) {
    try {
      stopped.refine(4 - stopped.samples(), stopAfter(0));
    } catch (const Interrupted&) {
      ++stops;
    }
  }
  EXPECT_GT(stops, 10);
  EXPECT_TRUE(sameBits(whole.imageWithParts(), stopped.imageWithParts()));
}

TEST(PathTracer, ProgressRunsFromNoneToAll) {
  const Stage stage;
  PathTracer tracer = stage.tracer();
  double last = 0.0;
  Progress progress;
  progress.update = [&](double fraction, const std::string& what) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    EXPECT_NE(what.find("of 300 samples"), std::string::npos) << what;
    last = fraction;
  };
  tracer.refine(300, progress);
  EXPECT_GT(last, 0.0);
  EXPECT_EQ(tracer.report().samples, 300);
  EXPECT_GT(tracer.report().rays, std::size_t(300 * 21 * 14));
  EXPECT_GT(tracer.report().seconds, 0.0);
}

// ---- Checkpoints -------------------------------------------------------------------------------------------------------

TEST(PathTracer, InterruptedAndResumedGivesTheSameBits) {
  Stage stage;
  stage.options.width = 80;
  stage.options.height = 60;
  const LayeredImage whole = stage.render({.samples = 24});
  const TemporaryFile file;
  int interruptions = 0;
  for (;; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    ReferenceReport report;
    try {
      const LayeredImage resumed = stage.render({.samples = 24, .checkpoint = file.path},
                                                stopAfter(interruptions < 10 ? 0 : 1), &report);
      EXPECT_TRUE(report.resumed);
      EXPECT_GE(interruptions, 10);
      EXPECT_TRUE(sameBits(whole, resumed));
      break;
    } catch (const Interrupted& stop) {
      EXPECT_NE(std::string(stop.what()).find(file.path.string()), std::string::npos);
      EXPECT_TRUE(fs::exists(file.path));
    }
  }
  EXPECT_FALSE(fs::exists(file.path));
}

/// A checkpoint of 5 samples.
void keepFive(const Stage& stage, const fs::path& path) {
  PathTracer tracer = stage.tracer();
  tracer.refine(5);
  tracer.save(path);
}

TEST(PathTracer, CheckpointsComeBackWhole) {
  const Stage stage;
  const TemporaryFile file;
  keepFive(stage, file.path);
  PathTracer tracer = stage.tracer();
  tracer.refine(2);
  tracer.load(file.path);
  EXPECT_EQ(tracer.samples(), 5);
  EXPECT_TRUE(tracer.report().resumed);
  tracer.refine(4);
  PathTracer whole = stage.tracer();
  whole.refine(9);
  EXPECT_TRUE(sameBits(tracer.imageWithParts(), whole.imageWithParts()));
}

TEST(PathTracer, ForeignCheckpointsAreRefusedAndKept) {
  const Stage stage;
  const TemporaryFile file;
  keepFive(stage, file.path);
  const auto size = fs::file_size(file.path);
  const auto refused = [&](const char* what, const std::function<void(Stage&)>& change) {
    Stage other = stage;
    change(other);
    const std::string error = errorOf([&] { other.render({.samples = 8, .checkpoint = file.path}); });
    EXPECT_NE(error.find(file.path.string() + ": is the checkpoint of"), std::string::npos) << what << error;
    EXPECT_EQ(fs::file_size(file.path), size) << what;
  };
  refused("scene", [](Stage& s) { s.scene.materials[0].roughness *= 0.5f; });
  refused("pose", [](Stage& s) { s.posed.instances[0].world_from_object[3].x += 0.01f; });
  refused("camera", [](Stage& s) { s.camera.world_from_view[3].y += 0.01f; });
  refused("environment", [](Stage& s) { s.environment.intensity = 2.0f; });
  refused("size", [](Stage& s) { std::swap(s.options.width, s.options.height); });
  refused("light", [](Stage& s) { s.options.light.emitter_indirect = false; });
  refused("bounces", [](Stage& s) { s.options.bounces = 3; });
  refused("order", [](Stage& s) { s.options.environment_order = 3; });
  refused("background", [](Stage& s) { s.options.background = false; });
  refused("seed", [](Stage& s) { s.options.seed = 1u << 20; });
  EXPECT_NE(errorOf([&] { stage.render({.samples = 4, .checkpoint = file.path}); }).find("more than the 4"),
            std::string::npos);

  std::ofstream(file.path) << "a letter to someone";
  EXPECT_NE(
      errorOf([&] { stage.render({.samples = 8, .checkpoint = file.path}); }).find("is not a checkpoint"),
      std::string::npos);
  EXPECT_EQ(fs::file_size(file.path), 19u);
}

TEST(PathTracer, DamagedCheckpointsAreRefusedAndChangeNothing) {
  const Stage stage;
  const TemporaryFile file;
  keepFive(stage, file.path);
  const auto size = std::streamoff(fs::file_size(file.path));
  PathTracer tracer = stage.tracer();
  tracer.refine(3);
  const LayeredImage before = tracer.imageWithParts();
  for (const std::streamoff at : {std::streamoff(45), size / 2, size - 3}) {
    keepFive(stage, file.path);
    std::fstream damaged(file.path, std::ios::binary | std::ios::in | std::ios::out);
    damaged.seekg(at);
    const char old = char(damaged.get());
    damaged.seekp(at);
    damaged.put(char(old ^ 0x40));
    damaged.close();
    EXPECT_NE(errorOf([&] { tracer.load(file.path); }).find("damaged"), std::string::npos) << at;
  }
  keepFive(stage, file.path);
  fs::resize_file(file.path, std::uintmax_t(size) / 3);
  EXPECT_NE(errorOf([&] { tracer.load(file.path); }).find("ends too early"), std::string::npos);
  EXPECT_TRUE(sameBits(tracer.imageWithParts(), before));
  EXPECT_NE(errorOf([&] { tracer.load("/nonexistent/x.ckp"); }), "");
  EXPECT_NE(errorOf([&] { tracer.save("/nonexistent/x.ckp"); }), "");
}

// ---- Noise -------------------------------------------------------------------------------------------------------------

// The spread of many pictures of other seeds is what the pictures say of themselves. 60 pictures of 32 samples: the
// standard error of a variance from 60 values of a bell curve is 18 %; summed over hundreds of pixels that vary
// independently it is far below, but some pixels' light is rare and bright, so a tenth is left.
TEST(PathTracer, VarianceIsThatOfTheMean) {
  for (const int supersample : {1, 2}) {
    Stage stage;
    stage.options.supersample = supersample;
    std::vector<double> sum(21 * 14 * 3), squares(sum.size());
    double claimed = 0.0, claimed_noise = 0.0, mean = 0.0;
    constexpr int kPictures = 60;
    for (int i = 0; i < kPictures; ++i) {
      stage.options.seed = std::uint64_t(i);
      PathTracer tracer = stage.tracer();
      tracer.refine(32);
      const LayeredImage image = tracer.imageWithParts();
      const Image light = image.image("", {"R", "G", "B"}, ""),
                  seen = image.image("seen", {"R", "G", "B"}, ""),
                  variance = image.image("variance", {"R", "G", "B"}, "");
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] += double(light.pixels[k]);
        squares[k] += double(light.pixels[k]) * double(light.pixels[k]);
        claimed += double(variance.pixels[k]) / kPictures;
        mean += double(light.pixels[k] - seen.pixels[k]) / kPictures;
      }
      claimed_noise += tracer.noise() / kPictures;
    }
    double measured = 0.0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      measured += (squares[k] - sum[k] * sum[k] / kPictures) / (kPictures - 1);
    }
    ASSERT_GT(measured, 0.0);
    const double values = double(sum.size());
    EXPECT_NEAR(claimed_noise, std::sqrt(claimed / values) / (mean / values), 0.1 * claimed_noise);
    // Two halves are each less even than the whole: what they tell of its error is a little large.
    EXPECT_LT(measured, 1.15 * claimed) << supersample;
    EXPECT_GT(measured, 0.5 * claimed) << supersample;
  }
}

TEST(PathTracer, NoiseIsThatOfWhatIsReflected) {
  Stage stage;
  stage.options.background = false;
  const auto noise = [&] {
    PathTracer tracer = stage.tracer();
    tracer.refine(16);
    return tracer.noise();
  };
  stage.options.light.emitter_direct = stage.options.light.emitter_indirect = false;
  const double dark = noise();
  for (Material& material : stage.scene.materials) material.emission = glm::vec3(100.0f);
  EXPECT_NEAR(noise(), dark, 1e-6 * dark);  // seen, and without chance
}

TEST(PathTracer, NoiseBelowTwoRoundsIsInfiniteAndOfABlackPictureNone) {
  Stage stage;
  PathTracer tracer = stage.tracer();
  EXPECT_TRUE(std::isinf(tracer.noise()));
  tracer.refine(7);  // one round of four, and a part
  EXPECT_TRUE(std::isinf(tracer.noise()));
  tracer.refine(1);
  EXPECT_FALSE(std::isinf(tracer.noise()));
  const double early = tracer.noise();
  tracer.refine(120);
  EXPECT_LT(tracer.noise(), 0.6 * early);

  stage.options.light = {};
  stage.options.background = false;
  for (Material& material : stage.scene.materials) material.emission = glm::vec3(0.0f);
  PathTracer black = stage.tracer();
  black.refine(8);
  EXPECT_EQ(black.noise(), 0.0);
}

TEST(PathTracer, StopsAtTheNoiseAskedFor) {
  const Stage stage;
  ReferenceReport report;
  stage.render({.samples = 5000, .noise = 0.1f}, {}, &report);
  EXPECT_LE(report.noise, 0.1);
  EXPECT_LT(report.samples, 5000);
  EXPECT_EQ(report.samples % 4, 0);
  const int enough = report.samples;
  stage.render({.samples = 20, .noise = 1e-6f}, {}, &report);
  EXPECT_EQ(report.samples, 20);

  // The same number after an interruption.
  const TemporaryFile file;
  report = {};
  for (int i = 0; report.samples == 0; ++i) {
    ASSERT_LT(i, 1000);
    try {
      stage.render({.samples = 5000, .noise = 0.1f, .checkpoint = file.path}, stopAfter(i < 10 ? 0 : 1),
                   &report);
      EXPECT_GE(i, 10);
    } catch (const Interrupted&) {
    }
  }
  EXPECT_EQ(report.samples, enough);
}

// ---- The picture -------------------------------------------------------------------------------------------------------

TEST(PathTracer, LayersAreThoseOfARender) {
  Stage stage;
  PathTracer tracer = stage.tracer();
  tracer.refine(4);
  const LayeredImage image = tracer.image();
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) names.push_back(layer.name);
  EXPECT_EQ(names, (std::vector<std::string>{"", "direct", "indirect", "normal", "depth", "albedo", "object",
                                             "variance", "seen"}));
  const Image sum = image.image("", {"R", "G", "B", "A"}, ""),
              direct = image.image("direct", {"R", "G", "B"}, ""),
              indirect = image.image("indirect", {"R", "G", "B"}, "");
  for (std::size_t i = 0; i < sum.pixelCount(); ++i) {
    EXPECT_EQ(sum.pixels[4 * i + 3], 1.0f);
    for (std::size_t c = 0; c < 3; ++c) {
      const float expected = direct.pixels[3 * i + c] + indirect.pixels[3 * i + c];
      EXPECT_NEAR(sum.pixels[4 * i + c], expected, 1e-5f * expected);
    }
  }
  EXPECT_EQ(image.attributes.at("gloam.kind"), "reference");
  EXPECT_EQ(image.attributes.at("gloam.samples"), "4");
  EXPECT_EQ(image.attributes.at("gloam.bounces"), "2");
  EXPECT_EQ(image.attributes.at("gloam.seed"), "7");
}

TEST(PathTracer, AlphaIsWhatIsCoveredAndGeometryThatOfTheMiddle) {
  Stage stage;
  stage.scene = makeBuiltinScene("furnace?detail=0.25");
  stage.posed = pose(stage.scene, 0.0f);
  stage.camera = framingCamera(stage.posed, 1.5f);
  stage.options.background = false;
  stage.options.supersample = 3;
  PathTracer tracer = stage.tracer();
  tracer.refine(9);
  const LayeredImage image = tracer.image();
  const Image sum = image.image("", {"R", "G", "B", "A"}, ""), depth = image.image("depth", {"Z"}, ""),
              normal = image.image("normal", {"X", "Y", "Z"}, "");
  const std::vector<std::uint32_t>& ids = image.find("object")->ids;
  int covered = 0, edges = 0;
  for (std::size_t i = 0; i < sum.pixelCount(); ++i) {
    const float alpha = sum.pixels[4 * i + 3];
    EXPECT_NEAR(alpha * 9.0f, std::round(alpha * 9.0f), 1e-5f);
    EXPECT_EQ(ids[i] != 0, depth.pixels[i] > 0.0f);
    const glm::vec3 n(normal.pixels[3 * i], normal.pixels[3 * i + 1], normal.pixels[3 * i + 2]);
    EXPECT_NEAR(glm::length(n), alpha > 0.0f ? 1.0f : 0.0f, 1e-5f);
    if (alpha == 0.0f) {
      EXPECT_EQ(sum.pixels[4 * i], 0.0f);
    }
    covered += alpha == 1.0f;
    edges += alpha > 0.0f && alpha < 1.0f;
  }
  EXPECT_GT(covered, 10);
  EXPECT_GT(edges, 5);
  EXPECT_LT(covered + edges, 21 * 14);
}

// ---- Bad input ---------------------------------------------------------------------------------------------------------

TEST(PathTracer, OptionsOutOfRangeAreNamed) {
  const Stage stage;
  const auto refused = [&](const char* name, const std::function<void(ReferenceOptions&)>& change) {
    Stage other = stage;
    change(other.options);
    EXPECT_NE(errorOf([&] { other.tracer(); }).find(name), std::string::npos) << name;
  };
  refused("width", [](ReferenceOptions& o) { o.width = 0; });
  refused("width", [](ReferenceOptions& o) { o.width = 16385; });
  refused("height", [](ReferenceOptions& o) { o.height = -1; });
  refused("supersample", [](ReferenceOptions& o) { o.supersample = 5; });
  refused("bounces", [](ReferenceOptions& o) { o.bounces = -1; });
  refused("environment_order", [](ReferenceOptions& o) { o.environment_order = 7; });
  refused("threads", [](ReferenceOptions& o) { o.threads = -2; });
  EXPECT_NE(errorOf([&] { stage.render({.samples = 0}); }).find("samples is 0"), std::string::npos);
  EXPECT_NE(errorOf([&] { stage.render({.noise = -1.0f}); }).find("noise"), std::string::npos);
  EXPECT_NE(errorOf([&] { stage.render({.noise = NAN}); }).find("noise"), std::string::npos);
  PathTracer tracer = stage.tracer();
  EXPECT_NE(errorOf([&] { tracer.refine(-1); }), "");
  EXPECT_NE(errorOf([&] { tracer.refine((1 << 24) + 1); }), "");
  Stage direct;
  direct.options.light = {.environment_direct = true};
  EXPECT_NE(errorOf([&] { direct.tracer().image(kAllLight); }).find("follows environment_direct"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam
