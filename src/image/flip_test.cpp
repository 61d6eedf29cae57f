// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// FLIP against its equations as they are printed, in double precision, one pixel at a time.
#include "image/flip.h"

#include <gloam/metrics.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "image/cie_lab.h"
#include "image/flip_filters.h"
#include "image/test_files.h"
#include "image/test_pictures.h"

namespace gloam {
namespace {

using glm::dvec3;
using test::constantPicture;
using test::displayPicture;
using test::radiancePicture;
constexpr double kPi = std::numbers::pi;

// ---- The slow twin ----------------------------------------------------------------------------------------------------

dvec3 colorAt(const Image& image, int x, int y) {
  const float* p = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  return glm::clamp(dvec3(p[0], p[1], p[2]), 0.0, 1.0);
}

struct Twin {
  glm::dmat3 xyz = xyzFromRgb(kRec709);
  dvec3 white = xyz * dvec3(1.0);
  double pixels_per_degree;

  dvec3 opponent(const dvec3& rgb) const {
    const dvec3 f = xyz * rgb / white;
    return {116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z)};
  }
  dvec3 rgbOf(const dvec3& opponent) const {
    const double y = (opponent.x + 16.0) / 116.0;
    const dvec3 f(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
    return glm::clamp(glm::inverse(xyz) * (f * white), 0.0, 1.0);
  }
  dvec3 huntLab(const dvec3& rgb) const {
    dvec3 f = xyz * rgb / white;
    for (int i = 0; i < 3; ++i) {
      const double d = 6.0 / 29.0;
      f[i] = f[i] > d * d * d ? std::cbrt(f[i]) : f[i] / (3.0 * d * d) + 4.0 / 29.0;
    }
    const double l = 116.0 * f.y - 16.0;
    return {l, 0.01 * l * 500.0 * (f.x - f.y), 0.01 * l * 200.0 * (f.y - f.z)};
  }
  static double hyab(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
  }

  /// Sums a function of the neighbours' opponent colours with weights that are normalised to 1.
  dvec3 filtered(const Image& image, int x, int y) const {
    const int radius = int(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * pixels_per_degree));
    const auto g = [](double z, double a, double b) {
      return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * z / b);
    };
    dvec3 sum(0.0), weight(0.0);
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const double z = (dx * dx + dy * dy) / (pixels_per_degree * pixels_per_degree);
        const dvec3 w(g(z, 1.0, 0.0047), g(z, 1.0, 0.0053), g(z, 34.1, 0.04) + g(z, 13.5, 0.025));
        sum += w * opponent(colorAt(image, x + dx, y + dy));
        weight += w;
      }
    return huntLab(rgbOf(sum / weight));
  }
  /// The strength of edges (order 1) or points (order 2).
  double feature(const Image& image, int x, int y, int order) const {
    const double sigma = 0.5 * 0.082 * pixels_per_degree;
    const int radius = int(std::ceil(3.0 * sigma));
    double plus[2] = {}, minus[2] = {}, plus_weight = 0.0, minus_weight = 0.0;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const double g = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
        const double along = order == 1 ? -dx * g : (dx * dx / (sigma * sigma) - 1.0) * g;
        const double values[] = {(opponent(colorAt(image, x + dx, y + dy)).x + 16.0) / 116.0,
                                 (opponent(colorAt(image, x + dy, y + dx)).x + 16.0) / 116.0};
        for (int axis = 0; axis < 2; ++axis) (along > 0.0 ? plus : minus)[axis] += along * values[axis];
        (along > 0.0 ? plus_weight : minus_weight) += std::abs(along);
      }
    return std::hypot(plus[0] / plus_weight + minus[0] / minus_weight,
                      plus[1] / plus_weight + minus[1] / minus_weight);
  }
  double difference(const Image& a, const Image& b, int x, int y) const {
    const double greatest = std::pow(hyab(huntLab({0.0, 1.0, 0.0}), huntLab({0.0, 0.0, 1.0})), 0.7);
    const double power = std::pow(hyab(filtered(a, x, y), filtered(b, x, y)), 0.7), knee = 0.4 * greatest;
    const double color =
        power < knee ? 0.95 / knee * power : 0.95 + (power - knee) / (greatest - knee) * 0.05;
    const double edge = std::abs(feature(a, x, y, 1) - feature(b, x, y, 1));
    const double point = std::abs(feature(a, x, y, 2) - feature(b, x, y, 2));
    return std::pow(color, 1.0 - std::sqrt(std::max(edge, point) / std::sqrt(2.0)));
  }
};

TEST(Flip, IsWhatTheEquationsSay) {
  const Image a = displayPicture(37, 21, 1), b = displayPicture(37, 21, 0);
  for (const double pixels_per_degree : {67.0206, 25.0}) {
    const Image map = ldrFlipMap(a, b, pixels_per_degree);
    const Twin twin{.pixels_per_degree = pixels_per_degree};
    for (int y = 0; y < map.height; y += 2)
      for (int x = y % 3; x < map.width; x += 3)
        EXPECT_NEAR(map.at(x, y)[0], twin.difference(a, b, x, y), 2e-4) << x << ", " << y;
  }
}

// Mean and one pixel of pairs that the authors' own program was given once (FLIP.h of github.com/NVlabs/flip, commit
// 1eb247ca, on the CPU, its defaults). Its white differs in the fifth digit, and its median of an even number of pixels
// is the upper one: hence the tolerances.
TEST(Flip, AgreesWithTheAuthorsProgram) {
  const auto expect = [](const Image& map, double mean, double at_10_10, double tolerance) {
    double sum = 0.0;
    for (const float value : map.pixels) sum += double(value);
    EXPECT_NEAR(sum / double(map.pixelCount()), mean, 0.5 * tolerance);
    EXPECT_NEAR(map.at(10, 10)[0], at_10_10, tolerance);
  };
  expect(ldrFlipMap(displayPicture(96, 80, 1), displayPicture(96, 80, 0)), 0.5067168, 0.241690, 5e-5);
  expect(ldrFlipMap(displayPicture(37, 21, 1), displayPicture(37, 21, 0)), 0.2184042, 0.250482, 5e-5);
  expect(flipMap(radiancePicture(96, 80, 1), radiancePicture(96, 80, 0)), 0.4616508, 0.219084, 5e-4);
  expect(flipMap(radiancePicture(35, 21, 1), radiancePicture(35, 21, 0)), 0.2134637, 0.115121, 5e-5);
  const auto grey = [](float v) { return constantPicture(16, 16, v, v, v); };
  expect(ldrFlipMap(grey(0.0f), grey(1.0f)), 0.9673883, 0.967388, 1e-5);
  expect(ldrFlipMap(grey(0.5f), grey(0.4f)), 0.2156506, 0.215651, 1e-4);
  expect(ldrFlipMap(constantPicture(16, 16, 1, 0, 0), constantPicture(16, 16, 0, 1, 1)), 0.9799106, 0.979911,
         1e-5);
}

TEST(Flip, HdrIsTheGreatestOverExposures) {
  const Image a = radiancePicture(40, 24, 1), b = radiancePicture(40, 24, 0);
  const FlipExposures exposures = flipExposures(b);
  ASSERT_GT(exposures.count, 3);
  Image expected(40, 24, 1);
  for (int i = 0; i < exposures.count; ++i) {
    const auto shown = [&](Image image) {
      for (float& value : image.pixels) value = flipToneCurve(value * float(std::exp2(exposures.at(i))));
      return image;
    };
    const Image map = ldrFlipMap(shown(a), shown(b));
    for (std::size_t p = 0; p < map.pixels.size(); ++p)
      expected.pixels[p] = std::max(expected.pixels[p], map.pixels[p]);
  }
  const Image map = flipMap(a, b);
  for (std::size_t p = 0; p < map.pixels.size(); ++p) EXPECT_NEAR(map.pixels[p], expected.pixels[p], 1e-5);
}

TEST(Flip, ExposuresFollowBrightestAndMedianPixel) {
  // 2.51 y^2 + 0.03 y = 0.85 (2.43 y^2 + 0.59 y + 0.14), y = 0.6 x.
  const double exposed = 2.1189;
  EXPECT_NEAR(flipToneCurve(float(exposed)), 0.85f, 1e-5f);
  Image image(4, 1, 1);
  image.pixels = {1, 64, 3, 2};
  const FlipExposures exposures = flipExposures(image);
  EXPECT_NEAR(exposures.start, std::log2(exposed / 64.0), 1e-4);
  EXPECT_NEAR(exposures.stop, std::log2(exposed / 2.5), 1e-4);
  EXPECT_EQ(exposures.count, 5);  // ceil(log2(64 / 2.5) = 4.68)
  EXPECT_DOUBLE_EQ(exposures.at(4), exposures.stop);

  image.pixels = {0, 64, 0, 0};  // more than half is black
  EXPECT_NEAR(flipExposures(image).stop, std::log2(exposed / 64.0), 1e-4);
  EXPECT_EQ(flipExposures(image).count, 2);
  image.pixels = {0, 0, 0, 0};
  EXPECT_EQ(flipExposures(image).count, 1);
  EXPECT_EQ(flipExposures(image).start, 0.0);
  image.pixels = {1e-30f, 1e30f, 1e-30f, 1e-30f};
  EXPECT_EQ(flipExposures(image).count, 64);
}

TEST(Flip, EqualPicturesDoNotDifferAndOthersAreBelowOne) {
  const Image picture = radiancePicture(33, 19, 0);
  for (const float value : flipMap(picture, picture).pixels) EXPECT_EQ(value, 0.0f);
  for (const float value : flipMap(radiancePicture(33, 19, 1), picture).pixels)
    EXPECT_TRUE(value >= 0.0f && value <= 1.0f);
  // The greatest difference that there is, and order does not matter.
  const Image green = constantPicture(9, 7, 0, 1, 0), blue = constantPicture(9, 7, 0, 0, 1);
  for (const float value : ldrFlipMap(green, blue).pixels) EXPECT_NEAR(value, 1.0f, 1e-4f);
  const Image a = displayPicture(30, 20, 0), b = displayPicture(30, 20, 1);
  EXPECT_EQ(ldrFlipMap(a, b).pixels, ldrFlipMap(b, a).pixels);
}

TEST(Flip, FromFartherAwayLessIsSeen) {
  const Image a = displayPicture(64, 48, 1), b = displayPicture(64, 48, 0);
  double before = 1.0;
  for (const double pixels_per_degree : {20.0, 40.0, 67.0, 120.0}) {
    double sum = 0.0;
    for (const float value : ldrFlipMap(a, b, pixels_per_degree).pixels) sum += double(value) / (64.0 * 48.0);
    EXPECT_LT(sum, before);
    before = sum;
  }
}

TEST(Flip, GreyIsColourWithEqualChannels) {
  const Image color_a = displayPicture(20, 12, 1), color_b = displayPicture(20, 12, 0);
  Image a(20, 12, 2), b(20, 12, 2), a3(20, 12, 3), b3(20, 12, 3);
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    a.pixels[2 * i] = color_a.pixels[3 * i], b.pixels[2 * i] = color_b.pixels[3 * i];
    b.pixels[2 * i + 1] = 0.5f;  // alpha does not count
    for (std::size_t c = 0; c < 3; ++c)
      a3.pixels[3 * i + c] = color_a.pixels[3 * i], b3.pixels[3 * i + c] = color_b.pixels[3 * i];
  }
  const Image grey = flipMap(a, b), color = flipMap(a3, b3);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) EXPECT_NEAR(grey.pixels[i], color.pixels[i], 1e-4);
}

TEST(Flip, ExtremesStayFinite) {
  Image a(3, 2, 3), b(3, 2, 3);
  a.pixels = {0, 0, 0, 3e38f, 3e38f, 3e38f, -3e38f, 0, 0, 1, 1, 1, 1e-40f, 0, 0, 5, 5, 5};
  b.pixels = {3e38f, 0, 0, 0, 0, 0, 1e-40f, 1, 1, 1, 1, 1, 2, 2, 2, -5, 5, 5};
  for (const Image& map : {flipMap(a, b), flipMap(b, a), flipMap(a, Image(3, 2, 3)), ldrFlipMap(a, b),
                           flipMap(a, b, 1.0), flipMap(a, b, 1000.0)})
    for (const float value : map.pixels) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << value;
}

TEST(Flip, FiltersHaveUnitSums) {
  const auto sum = [](const Kernel<float>& kernel) {
    double total = double(kernel.half[0]);
    for (std::size_t k = 1; k < kernel.half.size(); ++k) total += 2.0 * double(kernel.half[k]);
    return total;
  };
  for (const double pixels_per_degree : {1.0, 10.0, 67.0206, 500.0}) {
    const FlipFilters f = flipFilters(pixels_per_degree);
    EXPECT_NEAR(sum(f.achromatic), 1.0, 1e-6);
    EXPECT_NEAR(sum(f.red_green), 1.0, 1e-6);
    EXPECT_NEAR(std::pow(sum(f.blue_yellow_sharp), 2.0) + std::pow(sum(f.blue_yellow_soft), 2.0), 1.0, 1e-5);
    EXPECT_NEAR(sum(f.gaussian), 1.0, 1e-6);
    EXPECT_NEAR(sum(f.curvature), 0.0, 1e-5);
    EXPECT_NEAR((sum(f.slope) - double(f.slope.half[0])) / 2.0, 1.0, 1e-5);
  }
}

TEST(Flip, CubeRootIsOne) {
  for (float x = 1e-3f; x < 2.0f; x *= 1.001f) EXPECT_NEAR(cubeRoot(x) / std::cbrt(x), 1.0f, 4e-7f) << x;
  const glm::vec3 rgb = rec709FromLab({100.0f, 0.0f, 0.0f});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], 1.0f, 1e-4f);
}

TEST(Flip, RefusesAndStops) {
  const Image picture(4, 4, 3, 1.0f);
  EXPECT_NE(test::errorOf([&] { flipMap(picture, Image(4, 5, 3)); }), "");
  EXPECT_NE(test::errorOf([&] { flipMap(picture, picture, 0.0); }), "");
  EXPECT_NE(test::errorOf([&] { ldrFlipMap(picture, picture, std::nan("")); }), "");
  Image bad = picture;
  bad.at(2, 3)[1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(test::errorOf([&] { flipMap(bad, picture); }), "pixel (2, 3) is not finite in the picture");
  Progress progress;
  double last = 0.0;
  progress.update = [&](double part, const std::string&) { last = part; };
  flipMap(picture, picture, 67.0, progress);
  EXPECT_DOUBLE_EQ(last, 1.0);
  progress.should_stop = [] { return true; };
  EXPECT_THROW(flipMap(picture, picture, 67.0, progress), Interrupted);
}

}  // namespace
}  // namespace gloam
