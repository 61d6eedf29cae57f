// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/metrics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gloam {
namespace {

Image row(std::vector<float> values, int channels = 1) {
  Image image(int(values.size()) / channels, 1, channels);
  image.pixels = std::move(values);
  return image;
}

TEST(Metrics, AgreeWithNumbersByHand) {
  const Image reference = row({3, 4, 0, 0}), picture = row({3, 4, 1, -3});
  EXPECT_DOUBLE_EQ(maxDifference(picture, reference), 3.0);
  EXPECT_DOUBLE_EQ(rmse(picture, reference), std::sqrt(10.0 / 4.0));
  EXPECT_DOUBLE_EQ(relativeSquaredError(picture, reference), 10.0 / 25.0);
  EXPECT_DOUBLE_EQ(meanSignedError(picture, reference), -2.0 / 4.0);
  EXPECT_DOUBLE_EQ(psnr(picture, reference), 10.0 * std::log10(16.0 / 2.5));
  EXPECT_DOUBLE_EQ(psnr(picture, reference, 1.0), 10.0 * std::log10(1.0 / 2.5));
}

TEST(Metrics, ScaleAsTheyShould) {
  const Image reference = row({0.5f, 1, 2, 8, 1, 3}, 3), picture = row({0.25f, 1, 3, 8, 2, 2.5f}, 3);
  Image reference4 = reference, picture4 = picture;
  for (float& value : reference4.pixels) value *= 4.0f;
  for (float& value : picture4.pixels) value *= 4.0f;
  EXPECT_DOUBLE_EQ(rmse(picture4, reference4), 4.0 * rmse(picture, reference));
  EXPECT_DOUBLE_EQ(relativeSquaredError(picture4, reference4), relativeSquaredError(picture, reference));
  EXPECT_NEAR(psnr(picture4, reference4), psnr(picture, reference), 1e-12);
  EXPECT_DOUBLE_EQ(meanSignedError(picture, reference), -meanSignedError(reference, picture));
}

TEST(Metrics, EqualPicturesDoNotDiffer) {
  const Image picture = row({0.5f, 1e9f, -2});
  EXPECT_EQ(maxDifference(picture, picture), 0.0);
  EXPECT_EQ(rmse(picture, picture), 0.0);
  EXPECT_EQ(relativeSquaredError(picture, picture), 0.0);
  EXPECT_EQ(relativeSquaredError(row({0, 0}), row({0, 0})), 0.0);
  EXPECT_EQ(psnr(picture, picture), std::numeric_limits<double>::infinity());
  EXPECT_EQ(relativeSquaredError(row({1, 0}), row({0, 0})), std::numeric_limits<double>::infinity());
}

TEST(Metrics, AlphaDoesNotCount) {
  EXPECT_EQ(maxDifference(row({1, 2, 3, 0}, 4), row({1, 2, 3, 1}, 4)), 0.0);
  EXPECT_EQ(maxDifference(row({1, 0}, 2), row({1, 1}, 2)), 0.0);
  EXPECT_DOUBLE_EQ(rmse(row({2, 2, 2, 0}, 4), row({1, 1, 1, 9}, 4)), 1.0);
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
  EXPECT_THROW(rmse(row({1, 2}), row({1, 2, 3})), Error);
  EXPECT_THROW(rmse(row({1, 2, 3}, 1), row({1, 2, 3}, 3)), Error);
  EXPECT_THROW(rmse(Image(), Image()), Error);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  try {
    rmse(row({1, 2}), row({1, nan}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "pixel (1, 0) is not finite in the reference");
  }
  EXPECT_THROW(psnr(row({std::numeric_limits<float>::infinity()}), row({1})), Error);
}

}  // namespace
}  // namespace gloam
