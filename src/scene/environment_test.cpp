// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/environment.h"

#include <gloam/image.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

// Irradiance by adding up all texels, in double: the slow twin of projection.
glm::dvec3 irradianceByTexels(const Environment& sky, const glm::vec3& normal) {
  glm::dvec3 sum(0.0);
  for (int row = 0; row < sky.height; ++row) {
    const double top = std::sin(kPi * (0.5 - double(row) / sky.height));
    const double bottom = std::sin(kPi * (0.5 - double(row + 1) / sky.height));
    const double solid_angle = 2.0 * kPi / sky.width * (top - bottom);
    for (int column = 0; column < sky.width; ++column) {
      const double cosine = std::max(0.0f, glm::dot(normal, texelDirection(sky, column, row)));
      sum += glm::dvec3(sky.radiance[std::size_t(row * sky.width + column)]) * (cosine * solid_angle);
    }
  }
  return sum;
}

std::filesystem::path temporary(const char* name) {
  return std::filesystem::temp_directory_path() / (std::string("gloam_environment_test_") + name);
}

TEST(Environment, TexelsAndDirectionsAgreeWithTheConvention) {
  Environment map;
  map.width = 4;
  map.height = 2;
  map.radiance.assign(8, glm::vec3(0.0f));
  map.radiance[3] = glm::vec3(1.0f);  // top row, u = 7/8: atan2(z, x) = 3/4 pi
  expectNear(texelDirection(map, 3, 0), glm::vec3(-0.5f, std::sqrt(0.5f), 0.5f), 1e-5f);
  expectNear(radianceFrom(map, texelDirection(map, 3, 0)), glm::vec3(1.0f), 1e-5f);
  expectNear(radianceFrom(map, texelDirection(map, 2, 0)), glm::vec3(0.0f), 1e-5f);
  // Halfway to the neighbour across the seam at u = 1: half the value.
  EXPECT_NEAR(radianceFrom(map, glm::vec3(-std::sqrt(0.5f), std::sqrt(0.5f), 0.0f)).x, 0.5f, 1e-4f);
}

TEST(Environment, RotationTurnsCounterClockwiseSeenFromAbove) {
  Environment sky = makeSky("sunset?azimuth=0");  // towards +Z
  sky.rotation_rad = 0.5f * kPi;                  // now towards +X
  EXPECT_GT(radianceFrom(sky, {1.0f, 0.12f, 0.0f}).x, 5.0f * radianceFrom(sky, {0.0f, 0.12f, 1.0f}).x);
}

TEST(Environment, ProjectionFollowsRotationAndIntensity) {
  Environment sky = makeSky("mild");
  const sh::ShRgb still = projectEnvironment(sky, 5);
  sky.rotation_rad = 0.7f;
  sky.intensity = 2.0f;
  const sh::ShRgb turned = projectEnvironment(sky, 5);
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  for (const glm::vec3 d : {glm::vec3(1, 0, 0), glm::vec3(0.6f, 0.48f, 0.64f), glm::vec3(0, -0.6f, 0.8f)}) {
    const glm::vec3 before(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
    expectNear(sh::valueAt(turned, d), 2.0f * sh::valueAt(still, before), 1e-4f);
  }
  EXPECT_EQ(projectEnvironment(Environment{}, 4).order, 4);
}

TEST(Environment, ProjectedIrradianceIsThatOfAllTexels) {
  for (const char* name : {"uniform", "mild", "gradient", "overcast", "sunset", "studio", "noon?sun=0"}) {
    const Environment sky = makeSky(name);
    const sh::ShRgb light = projectEnvironment(sky, 6);
    for (const glm::vec3 n : {glm::vec3(0, 1, 0), glm::vec3(0.6f, 0, 0.8f), glm::vec3(0, -1, 0)}) {
      const glm::vec3 exact(irradianceByTexels(sky, n));
      expectNear(sh::irradiance(light, n), exact,
                 0.02f * glm::length(glm::vec3(irradianceByTexels(sky, {0, 1, 0}))));
    }
  }
}

TEST(Sky, UniformIsOneEverywhere) {
  const Environment sky = loadEnvironment("sky:uniform");
  expectNear(radianceFrom(sky, {0.3f, -0.9f, 0.2f}), glm::vec3(1.0f), 1e-6f);
  const sh::ShRgb light = projectEnvironment(sky, 4);
  EXPECT_NEAR(light[0].x, std::sqrt(4.0f * kPi), 1e-4f);
  for (int i = 1; i < 16; ++i) EXPECT_NEAR(light[i].x, 0.0f, 1e-4f);
}

TEST(Sky, OvercastFollowsItsFormula) {
  const Environment sky = makeSky("overcast?ground=0");
  // Horizontal irradiance of the CIE overcast sky: 7 pi / 9 of the zenith's radiance.
  const glm::vec3 zenith = radianceFrom(sky, {0, 1, 0});
  EXPECT_NEAR(irradianceByTexels(sky, {0, 1, 0}).y / zenith.y, 7.0 * kPi / 9.0, 0.01);
  expectNear(radianceFrom(sky, {0, -1, 0}), glm::vec3(0.0f), 1e-6f);
}

TEST(Sky, TheSunKeepsItsEnergyWhateverItsSize) {
  const glm::vec3 toward_sun(0.0f, std::sin(0.5235988f), std::cos(0.5235988f));
  const std::string base = "preetham?azimuth=0&elevation=30&ground=0";
  const glm::dvec3 sky_alone = irradianceByTexels(makeSky(base + "&sun=0"), toward_sun);
  const glm::dvec3 small = irradianceByTexels(makeSky(base), toward_sun) - sky_alone;
  const glm::dvec3 large = irradianceByTexels(makeSky(base + "&sun_size=20"), toward_sun) - sky_alone;
  EXPECT_GT(small.y, sky_alone.y);  // the sun is stronger than its sky
  EXPECT_NEAR(large.y / small.y, 1.0, 0.01);
  // A sun tens of thousands of times brighter than its sky loses nothing in projection: band 0 is the mean of all texels.
  const Environment sky = makeSky(base);
  glm::dvec3 mean(0.0);
  float brightest = 0.0f;
  for (int row = 0; row < sky.height; ++row) {
    const double weight = std::sin(kPi * (0.5 - double(row) / sky.height)) -
                          std::sin(kPi * (0.5 - double(row + 1) / sky.height));
    for (int column = 0; column < sky.width; ++column) {
      const glm::vec3 texel = sky.radiance[std::size_t(row * sky.width + column)];
      mean += glm::dvec3(texel) * (weight * 2.0 * kPi / sky.width);
      brightest = std::max(brightest, texel.y);
    }
  }
  EXPECT_GT(brightest, 1e4f * radianceFrom(sky, {0, 1, 0}).y);
  const glm::vec3 band0 = projectEnvironment(sky, 3)[0] * std::sqrt(4.0f * kPi);
  EXPECT_NEAR(band0.y / mean.y, 1.0, 1e-5);
}

TEST(Sky, DaylightIsBrightestTowardTheSunAndBlueAwayFromIt) {
  const Environment sky = makeSky("preetham?elevation=40&azimuth=90&sun=0");
  const glm::vec3 near_sun = radianceFrom(sky, {0.7f, 0.71f, 0.1f}),
                  away = radianceFrom(sky, {-0.5f, 0.8f, 0.0f});
  EXPECT_GT(near_sun.y, 1.5f * away.y);
  EXPECT_GT(away.z, 1.3f * away.x);
  for (const glm::vec3& texel : sky.radiance) {
    ASSERT_TRUE(std::isfinite(texel.x) && texel.x >= 0.0f && texel.y >= 0.0f && texel.z >= 0.0f);
  }
  // White paper under a clear noon is near 1.
  const glm::dvec3 noon = irradianceByTexels(makeSky("noon"), {0, 1, 0}) / double(kPi);
  EXPECT_GT(noon.y, 0.7);
  EXPECT_LT(noon.y, 1.4);
}

TEST(Sky, AllNamesWorkAndOthersAreToldWhatThereIs) {
  for (const BuiltinScene& sky : builtinSkies()) {
    const Environment made = loadEnvironment(std::string("sky:") + sky.name);
    EXPECT_FALSE(made.empty());
    EXPECT_EQ(made.name, std::string("sky:") + sky.name);
  }
  EXPECT_NE(messageOf([] { loadEnvironment("sky:nowhere"); }).find("there are uniform, mild"),
            std::string::npos);
  EXPECT_NE(messageOf([] { loadEnvironment("sky:mild?colour=3"); }).find("unknown key 'colour'"),
            std::string::npos);
  EXPECT_NE(messageOf([] { loadEnvironment("sky:noon?elevation=95"); }).find("outside"), std::string::npos);
  EXPECT_NE(messageOf([] { loadEnvironment("sky:noon?elevation=nan"); }).find("not a number"),
            std::string::npos);
  EXPECT_NE(messageOf([] { loadEnvironment("sky:noon?elevation"); }).find("not key=value"),
            std::string::npos);
  EXPECT_NE(messageOf([] { loadEnvironment("sky:noon?sun=1&sun=2"); }).find("twice"), std::string::npos);
}

TEST(Environment, FilesAreReadNegativesClampedAndBrokenPixelsNamed) {
  const std::filesystem::path path = temporary("map.exr");
  Image image(4, 2, 3, 0.5f);
  image.at(1, 1)[2] = -3.0f;
  writeExr(image, path, ChannelType::kFloat);
  const Environment map = loadEnvironment(path.string());
  EXPECT_EQ(map.width, 4);
  EXPECT_EQ(map.radiance[5], glm::vec3(0.5f, 0.5f, 0.0f));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_NE(map.warnings[0].find("1 negative pixels"), std::string::npos);
  image.at(3, 0)[1] = std::nanf("");
  writeExr(image, path, ChannelType::kFloat);
  EXPECT_NE(messageOf([&] { loadEnvironment(path.string()); }).find("pixel (3, 0) is not a number"),
            std::string::npos);
  std::filesystem::remove(path);
  writeHdr(Image(6, 3, 3, 1.0f), temporary("map.hdr"));
  EXPECT_EQ(loadEnvironment(temporary("map.hdr").string()).width, 6);
  std::filesystem::remove(temporary("map.hdr"));
  writePng(Image(4, 2, 3, 0.5f), temporary("map.png"));
  EXPECT_NE(
      messageOf([&] { loadEnvironment(temporary("map.png").string()); }).find("expected an .exr or .hdr"),
      std::string::npos);
  std::filesystem::remove(temporary("map.png"));
  EXPECT_NE(messageOf([] { loadEnvironment("/nowhere/x.exr"); }), "no error");
}

}  // namespace
}  // namespace gloam
