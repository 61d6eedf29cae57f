// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/splatting/splatting.h"

#include <algorithm>
#include <numbers>

#include "frame/test_frame.h"
#include "golden.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {
namespace {

Settings settings(std::initializer_list<std::pair<const char*, const char*>> values) {
  Settings result(info().options);
  for (const auto& [name, text] : values) result.set(name, text);
  return result;
}

struct Picture {
  int width = 0, height = 0;
  std::vector<float> irradiance;
  std::vector<glm::uvec2> ids;
  Counts counts{};
};

Picture draw(const Scene& scene, const Settings& settings, int width, int height,
             const PosedCamera* camera = nullptr) {
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  frame.draw(posed, camera ? *camera : posed.cameras.at(0), {.width = width, .height = height},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  Picture picture{width, height, frame.floats("splatting.irradiance"), frame.ids(), {}};
  if (const gpu::BufferRef counts = frame.graph.findBuffer("splatting.counts"))
    picture.counts = counts.buffer().download<Counts>().at(0);
  return picture;
}

/// Root of the squared difference over that of the squares, where there is a surface.
double relativeError(const Picture& got, const Picture& want) {
  double difference = 0.0, square = 0.0;
  for (std::size_t i = 0; i < want.ids.size(); ++i) {
    if (want.ids[i].x == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double g = got.irradiance[4 * i + c], w = want.irradiance[4 * i + c];
      difference += (g - w) * (g - w);
      square += w * w;
    }
  }
  return std::sqrt(difference / square);
}

TEST(Splatting, NoThresholdIsTheFullSum) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture full = draw(scene, settings({{"mode", "full"}}), 150, 97);
  const Picture fine =
      draw(scene, settings({{"normal_threshold", "0"}, {"depth_threshold", "0"}, {"cluster_threshold", "0"}}),
           150, 97);
  EXPECT_LT(relativeError(fine, full), 1e-3);
}

TEST(Splatting, ManyResolutionsComeNearTheFullSumForFarLess) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture full = draw(scene, settings({{"mode", "full"}}), 384, 384);
  const Picture coarse = draw(scene, settings({{"light_threshold", "0.06"}}), 384, 384);
  EXPECT_LT(relativeError(coarse, full), 0.02);
  EXPECT_LT(coarse.counts.subsplats, 384u * 384u / 2);
  // The paper's own ways, which take fewer: no word of the light's change, edges mixed where they run along texels.
  const Picture paper = draw(scene, settings({{"light_threshold", "0"}, {"upsample", "paper"}}), 384, 384);
  EXPECT_LT(relativeError(paper, full), 0.1);
  EXPECT_LT(paper.counts.subsplats, coarse.counts.subsplats);
  const Picture blocks =
      draw(scene, settings({{"light_threshold", "0.06"}, {"upsample", "blocks"}}), 384, 384);
  EXPECT_GT(relativeError(blocks, full), 1.5 * relativeError(coarse, full));
}

TEST(Splatting, MergedLightsComeNearAllOfThem) {
  const Scene scene = loadScene("builtin:swing?detail=0.5");
  const auto with = [&](const char* threshold) {
    return draw(scene, settings({{"vpls", "1024"}, {"cluster_threshold", threshold}}), 128, 128);
  };
  const Picture all = with("0"), merged = with("0.006"), more = with("0.1");
  EXPECT_EQ(all.counts.listed[0], all.counts.subsplats);
  EXPECT_LT(merged.counts.listed[0], merged.counts.listed[1]);
  EXPECT_LT(merged.counts.listed[1], merged.counts.subsplats);
  EXPECT_LT(more.counts.listed[0], merged.counts.listed[0] / 4);
  EXPECT_LT(relativeError(merged, all), 0.01);
  EXPECT_LT(relativeError(more, all), 0.1);
}

// Inside a diffuse sphere, light from any point of it falls evenly on all: E = rho I / R^2, wherever the lamp stands.
TEST(Splatting, InsideOfASphereIsLitEvenly) {
  SceneBuilder builder("sphere");
  builder.place("sphere", shapes::icosphere(2.0f, 40), builder.diffuse("white", {0.8f, 0.5f, 0.2f}));
  Light lamp;
  lamp.type = Light::Type::kPoint;
  lamp.intensity = glm::vec3(5.0f);
  builder.light(lamp, {0.5f, -0.3f, 0.8f});
  const Scene scene = builder.finish();
  const PosedCamera camera = frame::cameraAt({0.2f, 0.1f, 0.0f}, {-1, 0.2f, -1}, 80);
  for (const char* mode : {"full", "multiresolution"}) {
    for (const char* sampling : {"grid", "importance"}) {
      const Picture picture =
          draw(scene, settings({{"mode", mode}, {"sampling", sampling}, {"bound", "none"}, {"vpls", "1000"}}),
               96, 72, &camera);
      const glm::vec3 want = glm::vec3(0.8f, 0.5f, 0.2f) * 5.0f / 4.0f;
      glm::dvec3 mean(0.0);
      for (std::size_t i = 0; i < picture.ids.size(); ++i) {
        ASSERT_GT(picture.ids[i].x, 0u);
        for (std::size_t c = 0; c < 3; ++c) {
          mean[int(c)] += picture.irradiance[4 * i + c] / double(picture.ids.size());
          ASSERT_NEAR(picture.irradiance[4 * i + c], want[int(c)], 0.1f * want[int(c)]) << mode << ' ' << i;
        }
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], want[c], 0.01 * want[c]) << mode << ' ' << sampling;
    }
  }
}

// At some pixels, the sum over all virtual lights in doubles.
TEST(Splatting, FullSumIsThatOverAllLights) {
  const Scene scene = loadScene("builtin:lamp?detail=0.3");
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  for (const char* bound : {"none", "area", "disc"}) {
    const Settings chosen = settings({{"mode", "full"}, {"bound", bound}, {"vpls", "300"}});
    frame.draw(posed, posed.cameras.at(0), {.width = 60, .height = 40},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 return technique.record(graph, inputs, chosen);
               });
    const std::vector<float> got = frame.floats("splatting.irradiance"),
                             positions = frame.floats("frame.receiver_position_1"),
                             normals = frame.floats("frame.receiver_normal_1");
    const auto rows = frame.graph.findBuffer("vpls.rows").buffer().download<vpls::VplRow>();
    for (std::size_t i = 5; i < 2400; i += 97) {
      if (positions[4 * i + 3] == 0.0f) continue;
      const glm::dvec3 p(positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]),
          n(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]);
      glm::dvec3 sum(0.0);
      for (const vpls::VplRow& row : rows) {
        const glm::dvec3 d = glm::dvec3(row.position) - p;
        const double squared = glm::dot(d, d), b = row.bound;
        if (squared == 0.0) continue;
        const double bounded = bound[0] == 'n'   ? squared
                               : bound[0] == 'a' ? std::max(squared, b)
                                                 : squared + b;
        const glm::dvec3 way = d / std::sqrt(squared);
        sum += glm::dvec3(row.intensity) * (std::max(0.0, glm::dot(n, way)) *
                                            std::max(0.0, -glm::dot(glm::dvec3(row.normal), way)) / bounded);
      }
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(got[4 * i + c], sum[int(c)], 2e-4 * sum[int(c)] + 1e-6) << bound << ' ' << i;
    }
  }
}

// Nothing stands in the way inside a sphere; behind a wall stands the dark.
TEST(Splatting, RaysTakeWhatIsHiddenAndNothingElse) {
  SceneBuilder builder("sphere");
  builder.place("sphere", shapes::icosphere(2.0f, 40), builder.diffuse("white", glm::vec3(0.8f)));
  Light lamp;
  lamp.type = Light::Type::kPoint;
  builder.light(lamp, {0.5f, -0.3f, 0.8f});
  const PosedCamera inside = frame::cameraAt({0.2f, 0.1f, 0.0f}, {-1, 0.2f, -1}, 80);
  const Scene sphere = builder.finish();
  const Picture open = draw(sphere, settings({{"sampling", "importance"}}), 64, 48, &inside);
  const Picture traced =
      draw(sphere, settings({{"sampling", "importance"}, {"visibility", "rays"}}), 64, 48, &inside);
  EXPECT_LT(relativeError(traced, open), 0.01);

  const Scene room = loadScene("builtin:lamp?detail=0.3");
  const Picture all = draw(room, settings({}), 64, 48),
                seen = draw(room, settings({{"visibility", "rays"}}), 64, 48);
  double lost = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < all.irradiance.size(); i += 4) {
    whole += all.irradiance[i];
    lost += all.irradiance[i] - seen.irradiance[i];
  }
  EXPECT_GT(lost, 0.3 * whole);  // light that would come through walls
  EXPECT_LT(lost, 0.7 * whole);
  const Picture full = draw(room, settings({{"visibility", "rays"}, {"mode", "full"}}), 64, 48);
  EXPECT_LT(relativeError(seen, full), 0.03);
  EXPECT_GT(relativeError(all, full), 0.3);
}

TEST(Splatting, DetailDarkensWhatIsTurnedAway) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture plain = draw(scene, settings({}), 64, 64);
  const Picture half = draw(scene, settings({{"detail", "0.5"}}), 64, 64);
  double least = 1.0, greatest = 0.0;
  for (std::size_t i = 0; i < plain.ids.size(); ++i) {
    if (plain.ids[i].x == 0 || plain.irradiance[4 * i] <= 0.0f) continue;
    const double ratio = half.irradiance[4 * i] / plain.irradiance[4 * i];
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  EXPECT_GE(least, 0.5 - 1e-4);
  EXPECT_LT(least, 0.7);  // side walls and floor
  EXPECT_GT(greatest, 0.99);
  EXPECT_LE(greatest, 1.0 + 1e-4);
}

// A radius that holds the scene is the full sum; smaller ones are darker, never brighter.
TEST(Splatting, CutOffLightIsLess) {
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  const Picture full = draw(scene, settings({{"mode", "full"}}), 64, 48);
  EXPECT_LT(relativeError(draw(scene, settings({{"mode", "cutoff"}, {"radius", "100"}}), 64, 48), full),
            1e-3);
  const Picture near = draw(scene, settings({{"mode", "cutoff"}, {"radius", "0.8"}}), 64, 48);
  double sum = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < full.irradiance.size(); i += 4) {
    ASSERT_LE(near.irradiance[i], full.irradiance[i] * 1.001f + 1e-5f);
    sum += near.irradiance[i];
    whole += full.irradiance[i];
  }
  EXPECT_LT(sum, 0.7 * whole);
  EXPECT_GT(sum, 0.1 * whole);
}

TEST(Splatting, LevelsFitAnyPicture) {
  EXPECT_EQ(planLevels(1024, 1024, 16, 0).coarsest, 6);
  EXPECT_EQ(planLevels(1280, 720, 16, 0).coarsest, 5);
  EXPECT_EQ(planLevels(15, 2000, 16, 0).coarsest, 0);
  EXPECT_EQ(planLevels(1024, 1024, 16, 256).finest, 2);
  EXPECT_EQ(planLevels(1024, 1024, 16, 4).finest, 6);
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(33, 200), std::pair(67, 35), std::pair(5, 90)}) {
    const Picture full = draw(scene, settings({{"mode", "full"}}), width, height),
                  many = draw(scene, settings({}), width, height);
    EXPECT_LT(relativeError(many, full), 0.08) << width << ' ' << height;
  }
  // Lights too few for a second set of merged ones.
  const Picture few = draw(scene, settings({{"vpls", "16"}}), 48, 32);
  EXPECT_LT(relativeError(few, draw(scene, settings({{"mode", "full"}, {"vpls", "16"}}), 48, 32)), 0.2);
  // Fewer texels than pixels at the finest level, down to none but the coarsest.
  const Picture full = draw(scene, settings({{"mode", "full"}}), 128, 128);
  for (const char* resolution : {"64", "32", "16", "1"})
    EXPECT_LT(relativeError(draw(scene, settings({{"resolution", resolution}}), 128, 128), full), 0.5)
        << resolution;
}

TEST(Splatting, WhatIsAskedForBadlyHasAnAnswer) {
  Scene scene = loadScene("builtin:cornell?detail=0.3");
  EXPECT_THROW(settings({{"vpls", "-1"}}), Error);
  EXPECT_THROW(settings({{"vpls", "100001"}}), Error);
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const auto terms = [&](const PosedScene& posed, const Settings& chosen) {
    std::size_t count = 99;
    frame.draw(posed, posed.cameras.at(0), {.width = 40, .height = 40},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 const frame::Lighting lighting = technique.record(graph, inputs, chosen);
                 count = lighting.irradiance.size();
                 return lighting;
               });
    return count;
  };
  PosedScene posed = pose(scene, 0.0f);
  const auto told = [&](const char* what) {
    return std::ranges::any_of(frame.warnings,
                               [&](const std::string& line) { return line.find(what) != std::string::npos; });
  };
  EXPECT_EQ(terms(posed, settings({})), 1u);
  EXPECT_FALSE(told("sends no light"));
  EXPECT_EQ(terms(posed, settings({{"vpls", "0"}})), 0u);
  const auto allFinite = [&] {
    for (const float x : frame.floats("splatting.irradiance")) {
      if (!std::isfinite(x) || x < 0.0f) return false;
    }
    return true;
  };
  PosedLight& lamp = posed.lights.at(0);
  for (const auto& position :
       {glm::vec3(0, -0.05f, 0), glm::vec3(1e4f, 0, 0), glm::vec3(-0.36f, 0.3f, -0.32f)}) {
    lamp.position = position;  // in the floor, far away, in a box
    EXPECT_EQ(terms(posed, settings({{"bound", "none"}})), 1u);
    EXPECT_TRUE(allFinite()) << position.x;
  }
  lamp.position = {0, 1, 0};
  for (const float cone : {0.0f, 1e-6f, 3.14159265f}) {
    lamp.light.inner_cone_rad = lamp.light.outer_cone_rad = cone;
    EXPECT_EQ(terms(posed, settings({})), 1u);
    EXPECT_TRUE(allFinite()) << cone;
  }
  EXPECT_EQ(told("its cone has no angle"), lamp.light.type == Light::Type::kSpot);
  lamp.light.type = Light::Type::kSpot;
  lamp.light.inner_cone_rad = lamp.light.outer_cone_rad = 0.0f;
  EXPECT_EQ(terms(posed, settings({})), 1u);
  EXPECT_TRUE(told("its cone has no angle"));
  lamp.light.inner_cone_rad = lamp.light.outer_cone_rad = 0.5f;
  lamp.position = {0, 50, 0};
  lamp.direction = {0, 1, 0};
  EXPECT_EQ(terms(posed, settings({})), 1u);
  EXPECT_TRUE(told("shines away"));
  lamp.direction = {0, -1, 0};
  lamp.light.range = 10.0f;
  EXPECT_EQ(terms(posed, settings({})), 1u);
  EXPECT_TRUE(told("its range ends"));
  lamp.light.range = 0.0f;
  lamp.light.intensity = glm::vec3(0.0f);
  EXPECT_EQ(terms(posed, settings({})), 0u);
  EXPECT_NE(frame.warnings.back().find("no lamp shines"), std::string::npos);
}

TEST(Splatting, GoldenRoom) {
  Scene scene = loadScene("builtin:lamp?detail=0.5");
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  const Settings chosen = settings({{"visibility", "rays"}, {"vpls", "400"}});
  const frame::FrameImages images = frame.draw(posed, posed.cameras.at(0), {.width = 96, .height = 72},
                                               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                                                 return technique.record(graph, inputs, chosen);
                                               });
  const std::vector<float> color = images.color.image().downloadFloats();
  Image picture(96, 72, 4);
  for (int y = 0; y < 72; ++y) {
    for (int x = 0; x < 96; ++x) {
      for (int c = 0; c < 4; ++c) {
        const float value = color[4 * std::size_t(y * 96 + x) + std::size_t(c)];
        picture.at(x, y)[c] = c == 3 ? 1.0f : std::min(value, 1.0f);
      }
    }
  }
  EXPECT_EQ(test::compareWithGolden(picture, "lamp_splatting"), "");
}

// A sphere lit evenly from inside shines as bright wherever its wall is mirrored: a lobe's integral is 1, whatever its exponent. A mirrored
// light of normal maps and gloss alike: radiance of the wall, rho I / (pi R^2).
TEST(Splatting, GlossOfAnEvenlyLitSphereIsItsRadiance) {
  const PosedCamera camera = frame::cameraAt({0.0f, 1.0f, 1.0f}, {0, 1, 0}, 30);
  for (const float roughness : {0.4f, 0.6f, 1.0f}) {
    SceneBuilder builder("sphere");
    builder.place("sphere", shapes::icosphere(2.0f, 30), builder.diffuse("white", glm::vec3(0.8f)));
    builder.place("ball", shapes::icosphere(0.2f, 12), builder.metal("metal", glm::vec3(1.0f), roughness),
                  {0.0f, 1.0f, 0.0f});
    Light lamp;
    lamp.type = Light::Type::kPoint;
    lamp.intensity = glm::vec3(5.0f);
    builder.light(lamp, {0.0f, 0.0f, 0.0f});
    const Scene scene = builder.finish();
    frame::TestFrame frame(scene);
    Splatting technique(gpu::testDevice());
    const PosedScene posed = pose(scene, 0.0f);
    frame.draw(posed, camera, {.width = 40, .height = 40},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 return technique.record(graph, inputs, settings({{"gloss", "true"}, {"vpls", "1000"}}));
               });
    const std::vector<float> gloss = frame.floats("splatting.gloss");
    const float want = 0.8f * 5.0f / (4.0f * std::numbers::pi_v<float>);
    const std::size_t middle = 4 * (20 * 40 + 20);
    EXPECT_EQ(gloss[0], 0.0f);  // the wall has none
    EXPECT_NEAR(gloss[middle], want, 0.15f * want) << roughness;
  }
}

TEST(Splatting, SamePictureAgain) {
  const Scene scene = loadScene("builtin:lamp?detail=0.3");
  const Picture one = draw(scene, settings({}), 90, 60), two = draw(scene, settings({}), 90, 60);
  EXPECT_EQ(one.irradiance, two.irradiance);
}

}  // namespace
}  // namespace gloam::splatting
