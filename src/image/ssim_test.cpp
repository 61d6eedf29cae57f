// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/ssim.h"

#include <gloam/metrics.h>
#include <gtest/gtest.h>

#include <cmath>

#include "image/test_pictures.h"

namespace gloam {
namespace {

Image mapOf(const Image& a, const Image& b, double peak) {
  const Progress silent;
  return ssimMap(a, b, peak, {silent, 0.0, 1.0, "SSIM"});
}

/// Equation 13 at one pixel, with the two-dimensional window as it is printed.
double twin(const Image& a, const Image& b, double peak, int x, int y) {
  double weights = 0.0, ma = 0.0, mb = 0.0, va = 0.0, vb = 0.0, ab = 0.0;
  const auto each = [&](auto&& use) {
    for (int dy = -5; dy <= 5; ++dy)
      for (int dx = -5; dx <= 5; ++dx) {
        if (x + dx < 0 || x + dx >= a.width || y + dy < 0 || y + dy >= a.height) continue;
        const auto value = [&](const Image& image) {
          const float* p = image.at(x + dx, y + dy);
          return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
        };
        use(std::exp(-(dx * dx + dy * dy) / 4.5), value(a), value(b));
      }
  };
  each([&](double w, double pa, double pb) { weights += w, ma += w * pa, mb += w * pb; });
  ma /= weights, mb /= weights;
  each([&](double w, double pa, double pb) {
    va += w * (pa - ma) * (pa - ma) / weights, vb += w * (pb - mb) * (pb - mb) / weights;
    ab += w * (pa - ma) * (pb - mb) / weights;
  });
  const double c1 = 1e-4 * peak * peak, c2 = 9e-4 * peak * peak;
  return (2.0 * ma * mb + c1) * (2.0 * ab + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
}

TEST(Ssim, IsWhatTheEquationSaysUpToTheBorder) {
  const Image a = test::displayPicture(23, 70, 1), b = test::displayPicture(23, 70, 0);
  const Image map = mapOf(a, b, 0.9);
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 23; ++x) EXPECT_NEAR(map.at(x, y)[0], twin(a, b, 0.9, x, y), 1e-6) << x << ", " << y;
}

TEST(Ssim, OfAConstantShiftIsTheLuminanceTerm) {
  const Image b(20, 20, 1, 0.4f), a(20, 20, 1, 0.6f);
  const double c1 = 1e-4, expected = (2.0 * 0.4 * 0.6 + c1) / (0.4 * 0.4 + 0.6 * 0.6 + c1);
  for (const float value : mapOf(a, b, 1.0).pixels) EXPECT_NEAR(value, expected, 1e-6);
}

TEST(Ssim, OfAContrastIsTheStructureTerm) {
  // Stripes of one pixel: the window's mean is their mean within 1e-4 where it is whole.
  Image b(40, 40, 1), a(40, 40, 1);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const float sign = x % 2 == 0 ? 1.0f : -1.0f;
      b.at(x, y)[0] = 0.5f + 0.2f * sign, a.at(x, y)[0] = 0.5f + 0.1f * sign;
    }
  const double c2 = 9e-4, expected = (2.0 * 0.2 * 0.1 + c2) / (0.2 * 0.2 + 0.1 * 0.1 + c2);
  const Image map = mapOf(a, b, 1.0);
  for (int y = 0; y < 40; ++y)
    for (int x = 5; x < 35; ++x) EXPECT_NEAR(map.at(x, y)[0], expected, 1e-4);
  for (float& value : a.pixels) value = 1.0f - value;
  EXPECT_LT(mapOf(a, b, 1.0).at(20, 20)[0], -0.7f) << "turned over";
}

TEST(Ssim, EqualIsOneAtAnyRange) {
  for (const float factor : {1e-30f, 1.0f, 1e30f}) {
    Image image = test::radiancePicture(31, 17, 0);
    for (float& value : image.pixels) value *= factor;
    EXPECT_NEAR(measure(image, image).ssim, 1.0, 1e-6);
  }
  EXPECT_EQ(measure(Image(3, 3, 3), Image(3, 3, 3)).ssim, 1.0) << "black";
  EXPECT_LT(measure(Image(9, 9, 3, 1.0f), Image(9, 9, 3)).ssim, 1e-3) << "white against black";
}

TEST(Ssim, ScalesWithItsPeak) {
  const Image a = test::radiancePicture(31, 17, 1), b = test::radiancePicture(31, 17, 0);
  Image a4 = a, b4 = b;
  for (float& value : a4.pixels) value *= 4.0f;
  for (float& value : b4.pixels) value *= 4.0f;
  EXPECT_NEAR(measure(a4, b4).ssim, measure(a, b).ssim, 1e-9);
}

}  // namespace
}  // namespace gloam
