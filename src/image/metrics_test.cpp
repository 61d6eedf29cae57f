// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/metrics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/measure_table.h"
#include "image/test_files.h"
#include "image/test_pictures.h"

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

TEST(Measure, AgreesWithTheSingleMeasures) {
  const Image a = test::radiancePicture(40, 24, 1), b = test::radiancePicture(40, 24, 0);
  const Metrics m = measure(a, b);
  EXPECT_EQ(m.pixels, 40u * 24u);
  EXPECT_DOUBLE_EQ(m.max_difference, maxDifference(a, b));
  EXPECT_DOUBLE_EQ(m.rmse, rmse(a, b));
  EXPECT_DOUBLE_EQ(m.relative_squared_error, relativeSquaredError(a, b));
  EXPECT_DOUBLE_EQ(m.relative_rmse, std::sqrt(m.relative_squared_error));
  EXPECT_DOUBLE_EQ(m.psnr, psnr(a, b));
  EXPECT_DOUBLE_EQ(m.mean_signed_error, meanSignedError(a, b));
  double flip = 0.0;
  for (const float value : flipMap(a, b).pixels) flip += double(value) / (40.0 * 24.0);
  EXPECT_NEAR(m.flip, flip, 1e-9);
}

TEST(Measure, SignedErrorTellsEnergyThatIsGained) {
  const Image b(4, 4, 3, 2.0f), a(4, 4, 3, 2.5f);
  EXPECT_DOUBLE_EQ(measure(a, b).mean_signed_error, 0.5);
  EXPECT_DOUBLE_EQ(measure(a, b).relative_signed_error, 0.25);
  EXPECT_DOUBLE_EQ(measure(b, a).relative_signed_error, -0.2);
  EXPECT_EQ(measure(b, Image(4, 4, 3)).relative_signed_error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(measure(Image(4, 4, 3), Image(4, 4, 3)).relative_signed_error, 0.0);
}

TEST(Measure, LdrFlipShowsBothAtTheExposureOfTheReference) {
  const Image a = test::radiancePicture(40, 24, 1), b = test::radiancePicture(40, 24, 0);
  Image a8 = a, b8 = b;
  for (float& value : a8.pixels) value *= 8.0f;
  for (float& value : b8.pixels) value *= 8.0f;
  EXPECT_NEAR(measure(a8, b8).ldr_flip, measure(a, b).ldr_flip, 1e-4);
  EXPECT_GT(measure(b8, b).ldr_flip, 0.1) << "three stops are seen";
  MetricOptions plain;
  plain.display = {.tone_map = ToneMap::kNone, .exposure_stops = 0.0f, .auto_exposure = false};
  double flip = 0.0;
  const Image da = test::displayPicture(40, 24, 1), db = test::displayPicture(40, 24, 0);
  for (const float value : ldrFlipMap(da, db).pixels) flip += double(value) / (40.0 * 24.0);
  EXPECT_NEAR(measure(da, db, plain).ldr_flip, flip, 1e-9);
}

TEST(Measure, AMaskSaysWhichPixelsCount) {
  const Image b = test::radiancePicture(40, 24, 0), a = test::radiancePicture(40, 24, 1);
  Image left(40, 24, 1), right(40, 24, 1), all(40, 24, 1, 0.5f);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) (x < 13 ? left : right).at(x, y)[0] = 1.0f;
  const Metrics whole = measure(a, b), same = measure(a, b, {.mask = all});
  const Metrics l = measure(a, b, {.mask = left, .peak = 1.0}),
                r = measure(a, b, {.mask = right, .peak = 1.0});
  const Metrics peak = measure(a, b, {.peak = 1.0});
  EXPECT_EQ(l.pixels, 13u * 24u);
  EXPECT_EQ(l.pixels + r.pixels, whole.pixels);
  const double part = 13.0 / 40.0;
  for (const Measure& measure : measureTable())
    EXPECT_EQ(same.*measure.value, whole.*measure.value) << measure.key;
  // Means over parts make the mean over all.
  EXPECT_NEAR(part * l.rmse * l.rmse + (1 - part) * r.rmse * r.rmse, whole.rmse * whole.rmse, 1e-9);
  for (const auto value : {&Metrics::ssim, &Metrics::flip, &Metrics::ldr_flip, &Metrics::mean_signed_error})
    EXPECT_NEAR(part * l.*value + (1 - part) * r.*value, peak.*value, 1e-9);
  EXPECT_DOUBLE_EQ(std::max(l.max_difference, r.max_difference), whole.max_difference);
}

TEST(Measure, RefusesWhatCannotBeCompared) {
  const Image picture(4, 3, 3, 1.0f);
  const auto refusal = [&](const Image& mask) {
    return test::errorOf([&] { measure(picture, picture, {.mask = mask}); });
  };
  EXPECT_EQ(refusal(Image(3, 3, 1, 1.0f)),
            "mask: 4 x 3 pixels of one channel were expected, not 3 x 3 with 1");
  EXPECT_EQ(refusal(Image(4, 3, 3, 1.0f)),
            "mask: 4 x 3 pixels of one channel were expected, not 4 x 3 with 3");
  EXPECT_EQ(refusal(Image(4, 3, 1)), "mask: no pixel is left to compare");
  Image mask(4, 3, 1, 1.0f);
  mask.at(1, 2)[0] = std::nanf("");
  EXPECT_EQ(refusal(mask), "pixel (1, 2) is not finite in the mask");
  EXPECT_NE(test::errorOf([&] { measure(picture, picture, {.pixels_per_degree = -1.0}); }), "");
}

TEST(Measure, BoundsAreHeldByDirection) {
  Metrics metrics;
  metrics.rmse = 0.1, metrics.psnr = 30.0, metrics.mean_signed_error = -0.2;
  const auto exceeds_bound = [&](const char* key, double bound) {
    for (const Measure& measure : measureTable())
      if (std::string(key) == measure.key) return exceeds(measure, metrics, bound);
    ADD_FAILURE() << key;
    return false;
  };
  EXPECT_TRUE(exceeds_bound("rmse", 0.05));
  EXPECT_FALSE(exceeds_bound("rmse", 0.1));
  EXPECT_TRUE(exceeds_bound("psnr", 31.0));
  EXPECT_FALSE(exceeds_bound("psnr", 30.0));
  EXPECT_TRUE(exceeds_bound("mean_signed_error", 0.1));
  EXPECT_FALSE(exceeds_bound("mean_signed_error", 0.3));
  metrics.psnr = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(exceeds_bound("psnr", 1e9)) << "equal pictures";
}

}  // namespace
}  // namespace gloam
