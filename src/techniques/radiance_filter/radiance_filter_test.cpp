// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/radiance_filter/radiance_filter.h"

#include "frame/test_frame.h"
#include "golden.h"
#include "scene/environment.h"

namespace gloam::radiance_filter {
namespace {

constexpr float kPi = 3.14159265f;
using Values = std::vector<std::pair<const char*, const char*>>;

Settings settings(const Values& values) {
  Settings result(info().options);
  for (const auto& [name, text] : values) result.set(name, text);
  return result;
}

struct Picture {
  std::vector<float> direct, indirect, gloss, color;  ///< irradiance and gloss, four floats a pixel
  std::vector<glm::uvec2> ids;
  std::vector<std::string> warnings;
  std::size_t terms = 0;
};

Picture draw(const Scene& scene, const Values& values, int width, int height,
             const PosedCamera* camera = nullptr) {
  frame::TestFrame frame(scene);
  RadianceFilter technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  Picture picture;
  const frame::FrameImages images =
      frame.draw(posed, camera ? *camera : posed.cameras.at(0), {.width = width, .height = height},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   frame::Lighting lighting = technique.record(graph, inputs, settings(values));
                   picture.terms = lighting.irradiance.size();
                   return lighting;
                 });
  const auto floats = [&](const char* name) {
    return frame.graph.find(name) ? frame.floats(name) : std::vector<float>();
  };
  picture.direct = floats("radiance_filter.irradiance_direct");
  picture.indirect = floats("radiance_filter.irradiance_indirect");
  picture.gloss = floats("radiance_filter.gloss_direct");
  picture.color = images.color.image().downloadFloats();
  picture.ids = frame.ids();
  picture.warnings = frame.warnings;
  return picture;
}

/// Root of the squared difference over that of the squares, where there is a surface.
double relativeError(const std::vector<float>& got, const std::vector<float>& want, const Picture& where) {
  double difference = 0.0, square = 0.0;
  for (std::size_t i = 0; i < where.ids.size(); ++i) {
    if (where.ids[i].x == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double g = got.at(4 * i + c), w = want.at(4 * i + c);
      difference += (g - w) * (g - w);
      square += w * w;
    }
  }
  return std::sqrt(difference / square);
}

TEST(RadianceFilter, ConvexWhiteBodyInTheWhiteFurnaceIsOne) {
  const Scene scene = loadScene("builtin:furnace");
  for (const char* mode : {"radiance", "irradiance", "brute_exact"}) {
    const Picture picture = draw(scene, {{"mode", mode}, {"direct", "64"}, {"indirect", "0"}}, 64, 48);
    EXPECT_EQ(picture.terms, 1u);
    double sum = 0.0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < picture.ids.size(); ++i) {
      if (picture.ids[i].x == 0) continue;
      ++covered;
      sum += picture.direct[4 * i] / kPi;
      EXPECT_NEAR(picture.direct[4 * i] / kPi, 1.0f, 0.06f) << mode << ' ' << i;
    }
    EXPECT_GT(covered, 400u);
    EXPECT_NEAR(sum / double(covered), 1.0, 0.005) << mode;
  }
}

// Light from afar on a plane is the same at each pixel of a set: the filter must find exactly what all sets together give.
TEST(RadianceFilter, OnAPlaneTheFilterIsBruteForce) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const Values given = {{"sets", "4"}, {"sets_down", "3"}, {"indirect", "0"}, {"direct", "9"}};
  const auto with = [&](const char* option, const char* value) {
    Values values = given;
    values.emplace_back(option, value);
    return draw(scene, values, 45, 38, &frame::kAbove);
  };
  const Picture brute = with("mode", "brute");
  for (const char* filter : {"two_pass", "one_pass"}) {
    const Picture filtered = with("filter", filter);
    EXPECT_LT(relativeError(filtered.direct, brute.direct, brute), 1e-3) << filter;
    EXPECT_LT(relativeError(filtered.gloss, brute.gloss, brute), 2e-3) << filter;
  }
  EXPECT_GT(relativeError(with("filter", "none").direct, brute.direct, brute), 0.02);
  EXPECT_LT(relativeError(with("window", "2").direct, brute.direct, brute), 1e-3);
}

TEST(RadianceFilter, InterleavedComesNearBruteForceForAFractionOfTheRays) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture brute = draw(scene, {{"mode", "brute"}}, 96, 96), filtered = draw(scene, {}, 96, 96),
                raw = draw(scene, {{"filter", "none"}}, 96, 96);
  EXPECT_LT(relativeError(filtered.direct, brute.direct, brute), 0.13);
  EXPECT_LT(relativeError(filtered.direct, brute.direct, brute),
            0.6 * relativeError(raw.direct, brute.direct, brute));
  EXPECT_LT(relativeError(filtered.indirect, brute.indirect, brute),
            0.6 * relativeError(raw.indirect, brute.indirect, brute));
}

// RF-6: across fine normals the classical filter smears what it shaded; radiance is shaded after the filter.
TEST(RadianceFilter, NormalMapsStayCrisp) {
  const Scene scene = loadScene("builtin:bumps?detail=0.5");
  const auto with = [&](const char* mode) {
    return draw(scene, {{"mode", mode}, {"sets", "8"}, {"indirect", "0"}}, 120, 90);
  };
  const Picture field = with("brute"), lobes = with("brute_exact");
  const double ours = relativeError(with("radiance").direct, field.direct, field),
               classical = relativeError(with("irradiance").direct, lobes.direct, lobes);
  EXPECT_LT(ours, 0.08);
  EXPECT_LT(ours, 0.4 * classical);
}

// What three bands lack of small lamps is put back: nearer to the lobes themselves, of soft gloss and of sharp.
TEST(RadianceFilter, HighlightsOfSmallLampsAreAsSharpAsTheyAre) {
  for (const char* scene : {"builtin:bumps?detail=0.5", "builtin:bumps?detail=0.5&roughness=0.5"}) {
    const auto with = [&](const char* mode, const char* beams) {
      return draw(loadScene(scene), {{"mode", mode}, {"beams", beams}, {"indirect", "0"}}, 96, 72);
    };
    const Picture exact = with("brute_exact", "off"), three = with("brute", "off"),
                  ours = with("brute", "on");
    EXPECT_LT(relativeError(ours.gloss, exact.gloss, exact),
              0.35 * relativeError(three.gloss, exact.gloss, exact))
        << scene;
    EXPECT_LT(relativeError(ours.direct, exact.direct, exact),
              0.5 * relativeError(three.direct, exact.direct, exact))
        << scene;
  }
}

TEST(RadianceFilter, LightApartOrTogetherIsTheSame) {
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  const Picture apart = draw(scene, {}, 60, 40), together = draw(scene, {{"apart", "off"}}, 60, 40);
  EXPECT_EQ(apart.terms, 2u);
  EXPECT_EQ(together.terms, 1u);
  // Negative lobes are cut off part by part.
  EXPECT_LT(relativeError(together.color, apart.color, apart), 0.01);
}

TEST(RadianceFilter, LampsInTheFieldAreThoseOfShadowMaps) {
  const Scene scene = loadScene("builtin:lamp?detail=0.3");
  const Picture maps = draw(scene, {{"indirect", "0"}, {"mode", "brute_exact"}}, 72, 54),
                field = draw(scene, {{"indirect", "0"}, {"mode", "brute_exact"}, {"lamps", "field"}}, 72, 54);
  EXPECT_LT(relativeError(field.color, maps.color, maps), 0.2);  // edges of shadow maps
}

TEST(RadianceFilter, WhatIsAskedForBadlyHasAnAnswer) {
  Scene scene = loadScene("builtin:cornell?detail=0.3");
  EXPECT_THROW(settings({{"sets", "0"}}), Error);
  EXPECT_THROW(settings({{"sets", "17"}}), Error);
  const auto allFinite = [](const Picture& picture) {
    return std::all_of(picture.color.begin(), picture.color.end(), [](float x) { return std::isfinite(x); });
  };
  const Picture small = draw(scene, {{"sets", "16"}}, 5, 9);
  EXPECT_NE(small.warnings.back().find("5 x 9 are used"), std::string::npos) << small.warnings.back();
  EXPECT_TRUE(allFinite(small));
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 70), std::pair(33, 17)})
    EXPECT_TRUE(allFinite(draw(scene, {{"sets", "3"}, {"sets_down", "5"}, {"window", "4"}}, width, height)));
  const Picture wide = draw(scene, {{"sets", "12"}, {"window", "4"}}, 60, 40);
  EXPECT_NE(wide.warnings.back().find("24 x 24 pixels are filtered"), std::string::npos)
      << wide.warnings.back();

  const Picture none = draw(scene, {{"direct", "0"}, {"indirect", "0"}}, 40, 40);
  EXPECT_EQ(none.terms, 0u);
  EXPECT_NE(none.warnings.back().find("no virtual lights"), std::string::npos);

  scene.environment = {};
  for (Light& light : scene.lights) light.intensity = glm::vec3(0.0f);
  const Picture dark = draw(scene, {{"lamps", "field"}}, 40, 40);
  for (const float x : dark.direct) ASSERT_TRUE(x == 0.0f || x == 1.0f);  // alpha is 1
}

TEST(RadianceFilter, SharpMaterialsAreToldOnce) {
  SceneBuilder builder("mirror");
  builder.place("ball", shapes::icosphere(1.0f, 8), builder.metal("mirror", glm::vec3(0.9f), 0.1f));
  builder.sky("mild");
  builder.camera({0, 0, 4}, {0, 0, 0}, 40);
  const Scene scene = builder.finish();
  frame::TestFrame frame(scene);
  RadianceFilter technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  for (int i = 0; i < 2; ++i)
    frame.draw(posed, posed.cameras.at(0), {.width = 16, .height = 16},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 return technique.record(graph, inputs, settings({}));
               });
  ASSERT_EQ(frame.warnings.size(), 1u);
  EXPECT_NE(frame.warnings[0].find("three bands carry no sharper"), std::string::npos);
}

TEST(RadianceFilter, GoldenBumps) {
  const Picture drawn = draw(loadScene("builtin:bumps?detail=0.5"), {}, 96, 72);
  Image picture(96, 72, 4);
  for (std::size_t i = 0; i < drawn.color.size(); ++i)
    picture.pixels[i] = i % 4 == 3 ? 1.0f : std::min(drawn.color[i], 1.0f);
  EXPECT_EQ(test::compareWithGolden(picture, "bumps_radiance_filter"), "");
}

TEST(RadianceFilter, ViewsAreKeptForWhoAsksByName) {
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  const PosedScene posed = pose(scene, 0.0f);
  for (const char* shown : {"", "radiance_filter.weights"}) {
    frame::TestFrame frame(scene);
    RadianceFilter technique(gpu::testDevice());
    frame.draw(posed, posed.cameras.at(0), {.width = 24, .height = 16, .show = shown},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 return technique.record(graph, inputs, settings({}));
               });
    EXPECT_EQ(bool(frame.graph.find("radiance_filter.weights")), shown[0] != '\0');
  }
}

// What the host filters is larger here than a binding of the software driver's. Light from afar on a plane is as in a small picture.
TEST(RadianceFilter, LargePicturesAreDrawn) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const Values few = {{"sets", "2"}, {"direct", "8"}, {"indirect", "1"}};
  const auto with = [&](int width, int height) { return draw(scene, few, width, height, &frame::kAbove); };
  const auto mean = [](const Picture& picture) {
    double sum = 0.0, covered = 0.0;
    for (std::size_t i = 0; i < picture.ids.size(); ++i) {
      if (picture.ids[i].x == 0) continue;
      covered += 1.0;
      sum += picture.direct[4 * i];
    }
    return sum / covered;
  };
  const double small = mean(with(160, 90)), large = mean(with(1600, 900));
  EXPECT_GT(small, 0.0);
  EXPECT_NEAR(large / small, 1.0, 0.002);
  try {
    with(16000, 300);
    const gpu::Device& device = gpu::testDevice();
    EXPECT_GE(device.limits().max_storage_bytes, 32u * 16000u * 300u);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("radiance_filter: a picture of 16000 x 300 pixels"),
              std::string::npos)
        << error.what();
  }
}

TEST(RadianceFilter, SamePictureAgain) {
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  EXPECT_EQ(draw(scene, {}, 60, 40).color, draw(scene, {}, 60, 40).color);
}

}  // namespace
}  // namespace gloam::radiance_filter
