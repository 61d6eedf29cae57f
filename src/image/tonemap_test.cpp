// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/tonemap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

// The shader's functions, compiled as C++.
namespace shader {
using namespace glm;
using uint = unsigned;
#include "image/tonemap.glsl"
}  // namespace shader

namespace gloam {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(ToneMap, TheShaderAgrees) {
  for (float stops : {-3.0f, 0.0f, 2.5f})
    for (int i = -2; i < 40; ++i) {
      const float v = i < 0 ? float(i) : 0.0001f * std::pow(1.5f, float(i));
      const glm::vec3 color(v, 0.3f * v, 2.0f - v);
      for (const ToneMap curve : {ToneMap::kNone, ToneMap::kAces}) {
        const glm::vec3 ours = toneMap(color, curve, stops);
        const glm::vec3 theirs = shader::toneMap(color, unsigned(curve), stops);
        const glm::vec3 ours_encoded = srgbEncode(ours), theirs_encoded = shader::srgbEncode(theirs);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(ours[c], theirs[c], 1e-6f);
          EXPECT_NEAR(ours_encoded[c], theirs_encoded[c], 1e-6f);
        }
      }
    }
  EXPECT_EQ(unsigned(ToneMap::kNone), shader::kToneMapNone);
  EXPECT_EQ(unsigned(ToneMap::kAces), shader::kToneMapAces);
  EXPECT_EQ(kLeastLuminance, shader::kLeastLuminance);
  EXPECT_FLOAT_EQ(autoExposureStops(1.5f), shader::autoExposureStops(1.5f));
  EXPECT_FLOAT_EQ(luminance({0.2f, 0.5f, 0.9f}), shader::luminance({0.2f, 0.5f, 0.9f}));
}

TEST(ToneMap, FilmicKeepsMiddleGreyGreyAndRises) {
  const glm::vec3 grey = filmic(glm::vec3(kMiddleGrey));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(grey[c], kMiddleGrey, 1e-4f);
  float before = -1.0f;
  for (float v = 0.0f; v < 64.0f; v = v * 1.1f + 0.001f) {
    const glm::vec3 mapped = toneMap(glm::vec3(v), ToneMap::kAces, 0.0f);
    EXPECT_NEAR(mapped.r, mapped.b, 1e-4f) << "grey stays grey";
    EXPECT_GE(mapped.g, before);
    before = mapped.g;
  }
  EXPECT_GT(before, 0.99f);
}

TEST(ToneMap, FilmicBendsBrightColoursTowardsWhite) {
  const glm::vec3 dim = toneMap({0.1f, 0.01f, 0.01f}, ToneMap::kAces, 0.0f);
  const glm::vec3 bright = toneMap({50.0f, 5.0f, 5.0f}, ToneMap::kAces, 0.0f);
  EXPECT_LT(dim.g / dim.r, 0.3f);
  EXPECT_GT(bright.g / bright.r, 0.8f);
}

TEST(ToneMap, NoneIsExposureAndClamp) {
  EXPECT_EQ(toneMap({0.25f, 0.5f, 3.0f}, ToneMap::kNone, 1.0f), glm::vec3(0.5f, 1.0f, 1.0f));
  EXPECT_EQ(toneMap({-1.0f, std::nanf(""), kInfinity}, ToneMap::kNone, 0.0f), glm::vec3(0, 0, 1));
  const glm::vec3 odd = toneMap({-1.0f, std::nanf(""), kInfinity}, ToneMap::kAces, 0.0f);
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(odd[c] >= 0.0f && odd[c] <= 1.0f);
}

TEST(ToneMap, AutomaticExposureBringsTheLogAverageToMiddleGrey) {
  Image image(4, 1, 3);
  image.pixels = {2, 2, 2, 8, 8, 8, 4, 4, 4, 0, 0, 0};  // geometric mean 4; black does not count
  EXPECT_FLOAT_EQ(meanLog2Luminance(image), 2.0f);
  DisplayOptions options{.tone_map = ToneMap::kNone, .exposure_stops = 0.0f, .auto_exposure = true};
  EXPECT_NEAR(toneMapped(image, options).at(2, 0)[1], kMiddleGrey, 1e-5f);
  options.exposure_stops = 1.0f;
  EXPECT_NEAR(toneMapped(image, options).at(2, 0)[1], 2.0f * kMiddleGrey, 1e-5f);
  // The same picture 100 times brighter looks the same.
  Image brighter = image;
  for (float& value : brighter.pixels) value *= 100.0f;
  EXPECT_NEAR(toneMapped(brighter, options).at(0, 0)[0], toneMapped(image, options).at(0, 0)[0], 1e-5f);
}

TEST(ToneMap, AlphaIsKeptAndWhatItHidesDoesNotCount) {
  Image image(2, 1, 4);
  image.pixels = {1, 1, 1, 0.5f, 100, 100, 100, 0};
  EXPECT_FLOAT_EQ(meanLog2Luminance(image), 0.0f);
  const Image mapped = toneMapped(image, {});
  EXPECT_EQ(mapped.pixels[3], 0.5f);
  EXPECT_EQ(mapped.pixels[7], 0.0f);
  EXPECT_FLOAT_EQ(meanLog2Luminance(Image(2, 2, 3)), std::log2(kMiddleGrey)) << "black asks for no exposure";
}

}  // namespace
}  // namespace gloam
