// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/metrics.h>
#include <gtest/gtest.h>

#include <cmath>

#include "image/color_maps.h"
#include "image/test_files.h"
#include "image/test_pictures.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

const DisplayOptions kPlain{.tone_map = ToneMap::kNone};

TEST(DifferencePicture, IsGreyWhereEqualAndTwiceTheDifferenceElsewhere) {
  Image a(2, 1, 3), b(2, 1, 3);
  a.pixels = {0.2f, 0.4f, 0.6f, 0.5f, 0.3f, 0.0f};
  b.pixels = {0.2f, 0.4f, 0.6f, 0.4f, 0.35f, 1.0f};
  const Image picture = differencePicture(a, b, 2.0, kPlain);
  ASSERT_EQ(picture.channels, 3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(srgbEncode(picture.at(0, 0)[c]), 0.5f, 1e-6f);
  for (int c = 0; c < 2; ++c) {
    const float difference = srgbEncode(a.at(1, 0)[c]) - srgbEncode(b.at(1, 0)[c]);
    EXPECT_NEAR(srgbEncode(picture.at(1, 0)[c]), 0.5f + difference, 1e-5f);
  }
  EXPECT_EQ(picture.at(1, 0)[2], 0.0f) << "clamped";
  const Image four = differencePicture(a, b, 4.0, kPlain);
  EXPECT_NEAR(srgbEncode(four.at(1, 0)[0]) - 0.5f, 2.0f * (srgbEncode(picture.at(1, 0)[0]) - 0.5f), 1e-5f);
}

TEST(DifferencePicture, AbsoluteIsTwiceTheSizeOnBlack) {
  Image a(2, 1, 1), b(2, 1, 1);
  a.pixels = {0.5f, 0.2f}, b.pixels = {0.5f, 0.25f};
  const Image more = absoluteDifferencePicture(a, b, 2.0, kPlain),
              less = absoluteDifferencePicture(b, a, 2.0, kPlain);
  EXPECT_EQ(more.at(0, 0)[1], 0.0f);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(srgbEncode(more.at(1, 0)[c]), 2.0f * (srgbEncode(0.25f) - srgbEncode(0.2f)), 1e-5f);
  EXPECT_EQ(more.pixels, less.pixels);
}

TEST(DifferencePicture, ExposesBothAsSuitsTheReference) {
  const Image reference = test::radiancePicture(16, 16, 0);
  Image brighter = reference;
  for (float& value : brighter.pixels) value *= 1.5f;
  const DisplayOptions automatic{.tone_map = ToneMap::kAces, .exposure_stops = 0.0f, .auto_exposure = true};
  double sum = 0.0;
  for (const float value : differencePicture(brighter, reference, 2.0, automatic).pixels)
    sum += double(srgbEncode(value)) - 0.5;
  EXPECT_GT(sum / (16.0 * 16.0 * 3.0), 0.05) << "each by its own exposure, the two would look the same";
}

TEST(FalseColor, IsRelativeToTheMeanOfTheReference) {
  Image reference(4, 1, 3, 10.0f), a = reference;
  a.at(1, 0)[0] = 25.0f;   // half of the mean sum of 30
  a.at(2, 0)[1] = -50.0f;  // beyond
  const Image picture = falseColor(a, reference, 1.0);
  const auto expect = [&](int x, float value) {
    const glm::vec3 color = errorColor(value);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(x, 0)[c], color[c], 1e-5f);
  };
  expect(0, 0.0f), expect(1, 0.5f), expect(2, 1.0f);
  EXPECT_EQ(falseColor(a, reference, 0.5).at(1, 0)[1], errorColor(1.0f).g);
  EXPECT_NE(test::errorOf([&] { falseColor(a, reference, 0.0); }), "");
  EXPECT_NE(test::errorOf([&] { falseColor(a, reference, INFINITY); }), "");
}

TEST(FalseColor, MapsRiseEvenly) {
  double before = -1.0, step = 0.0;
  for (int i = 0; i <= 50; ++i) {
    const double y = double(luminance(errorColor(float(i) / 50.0f)));
    const double lightness = y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
    if (i > 0) {
      EXPECT_NEAR(lightness - before, 96.0 / 50.0, 0.1) << i;
    }
    before = lightness;
  }
  EXPECT_EQ(errorColor(0.0f), glm::vec3(0.0f));
  for (int i = 1; i <= 255; ++i) {
    const double y = double(luminance(magmaColor(float(i) / 255.0f)));
    EXPECT_GT(y, step) << i;
    step = y;
  }
  EXPECT_NEAR(srgbEncode(magmaColor(1.0f).r), 252.0f / 255.0f, 1e-5f);
  EXPECT_EQ(magmaColor(-3.0f), magmaColor(0.0f));
  EXPECT_EQ(magmaColor(3.0f), magmaColor(1.0f));
}

TEST(Magma, TakesOneChannel) {
  Image map(2, 1, 1);
  map.pixels = {0.0f, 1.0f};
  EXPECT_NEAR(magma(map).at(1, 0)[1], magmaColor(1.0f).g, 1e-6f);
  EXPECT_NE(test::errorOf([] { magma(Image(2, 2, 3)); }), "");
}

}  // namespace
}  // namespace gloam
