// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/lights.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene/environment.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

AnimatedLights parse(const std::vector<std::string>& texts) {
  return AnimatedLights::parse(texts);
}

std::string errorOf(const std::string& text) {
  try {
    parse({text});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

double worst(const sh::ShRgb& a, const sh::ShRgb& b) {
  double most = 0.0;
  for (int i = 0; i < sh::kMaxCoefficients; ++i) most = std::max(most, double(glm::length(a[i] - b[i])));
  return most;
}

// Each light's spherical harmonics against those of its own radiance, looked up direction by direction.
TEST(DistantLights, ProjectionIsThatOfTheRadiance) {
  for (const char* text : {"constant?radiance=0.7&red=0.5", "gradient?nadir_red=2&radiance=1.5",
                           "sky:mild?azimuth=10&rotation=70", "sky:overcast?ground=0.5&intensity=2"}) {
    const std::vector<DistantLight> lights = parse({text}).at(0.0f);
    const auto radiance = [&](const glm::vec3& d) {
      glm::vec3 sum(0.0f);
      for (const DistantLight& light : lights) sum += radianceFrom(light, d);
      return sum;
    };
    EXPECT_LT(worst(projectLights(lights, 6), sh::projectRgb(6, radiance, 200)), 2e-3) << text;
  }
}

TEST(DistantLights, DiscGivesItsIrradianceAtAnySize) {
  for (const float radius : {0.05f, 0.27f, 3.0f, 60.0f, 90.0f}) {
    const DistantLight disc =
        parse({"disc?elevation=90&irradiance=2&green=0.5&radius=" + std::to_string(radius)}).at(0.0f).at(0);
    // Radiance times projected solid angle, pi sin^2.
    const float sine = std::sin(radius * kPi / 180.0f);
    EXPECT_NEAR(disc.radiance.r * kPi * sine * sine, 2.0f, 1e-4f);
    EXPECT_NEAR(disc.radiance.g * kPi * sine * sine, 1.0f, 1e-4f);
    const sh::ShRgb light = projectLight(disc, 6);
    EXPECT_LT(worst(light, sh::colored(sh::disc(6, {0, 1, 0}, disc.radius_rad), disc.radiance)), 1e-6);
    EXPECT_EQ(radianceFrom(disc, {0, 1, 0}), disc.radiance);
    const float beyond = 1.01f * disc.radius_rad;
    EXPECT_EQ(radianceFrom(disc, {std::sin(beyond), std::cos(beyond), 0}), glm::vec3(0.0f));
  }
}

TEST(DistantLights, AnalyticSkyIsThePaintedOne) {
  for (const char* name : {"sky:preetham?elevation=25&azimuth=100", "sky:sunset", "sky:studio", "sky:noon"}) {
    const sh::ShRgb painted = projectEnvironment(loadEnvironment(name), 6);
    const sh::ShRgb analytic = projectLights(parse({name}).at(0.0f), 6);
    // The painted one has texels of 0.7 degrees, and its ground is lit by them.
    EXPECT_LT(worst(painted, analytic), 0.01 * double(glm::length(painted[0]))) << name;
  }
}

TEST(DistantLights, KeysAreLinearBetweenAndHeldOutside) {
  const AnimatedLights lights = parse({"disc?azimuth=1:0,3:90&elevation=0&irradiance=1:1,2:3"});
  EXPECT_TRUE(lights.moves());
  const auto azimuth = [&](float time_s) {
    const glm::vec3 d = lights.at(time_s).at(0).direction;
    return std::atan2(d.x, d.z) * 180.0f / kPi;
  };
  EXPECT_NEAR(azimuth(0.0f), 0.0f, 1e-4f);
  EXPECT_NEAR(azimuth(2.0f), 45.0f, 1e-3f);
  EXPECT_NEAR(azimuth(9.0f), 90.0f, 1e-3f);
  EXPECT_NEAR(lights.at(1.5f).at(0).radiance.r / lights.at(0.0f).at(0).radiance.r, 2.0f, 1e-5f);
  EXPECT_FALSE(parse({"disc?azimuth=3"}).moves());
}

TEST(DistantLights, ProbeTurnsLikeItsPixels) {
  Environment map;
  map.width = 64, map.height = 32;
  for (int i = 0; i < 64 * 32; ++i) map.radiance.emplace_back(float(i % 64) / 64.0f, float(i / 64), 1.0f);
  DistantLight probe{.kind = DistantLight::Kind::kMap, .map = std::make_shared<const Environment>(map)};
  probe.rotation_rad = 1.1f, probe.intensity = 0.5f;
  map.rotation_rad = 1.1f, map.intensity = 0.5f;
  EXPECT_LT(worst(projectLight(probe, 6), projectEnvironment(map, 6)), 1e-3);
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.2f, 0.7f));
  EXPECT_LT(glm::length(radianceFrom(probe, d) - radianceFrom(map, d)), 1e-5f);
}

TEST(PaintLights, PixelsHoldTheLightAndSphericalHarmonicsAreExact) {
  Environment base = loadEnvironment("sky:mild");
  base.rotation_rad = 0.8f;
  base.intensity = 1.5f;
  const std::vector<DistantLight> lights =
      parse({"disc?azimuth=30&elevation=50&radius=1&irradiance=3", "disc?azimuth=-100&elevation=-5&radius=40",
             "constant?radiance=0.1"})
          .at(0.0f);
  const Environment painted = paintLights(base, lights);
  ASSERT_TRUE(painted.lights);
  EXPECT_EQ(painted.rotation_rad, base.rotation_rad);
  sh::ShRgb want = projectEnvironment(base, 6);
  want += projectLights(lights, 6);
  EXPECT_LT(worst(projectEnvironment(painted, 6), want), 1e-5 * double(glm::length(want[0])));
  Environment pixels = painted;
  pixels.lights.reset();
  EXPECT_LT(worst(projectEnvironment(pixels, 6), want), 3e-3 * double(glm::length(want[0])));
  const glm::vec3 middle = radianceFrom(painted, lights[0].direction);
  EXPECT_NEAR(middle.r / (radianceFrom(base, lights[0].direction).r + 0.1f + lights[0].radiance.r), 1.0f,
              0.01f);
  // Turning what was painted turns its spherical harmonics with it.
  Environment turned = painted;
  turned.rotation_rad += 1.0f;
  const float c = std::cos(1.0f), s = std::sin(1.0f);
  EXPECT_LT(worst(projectEnvironment(turned, 6), sh::rotate(glm::mat3(c, 0, -s, 0, 1, 0, s, 0, c), want)),
            1e-4);
}

TEST(DescribeLights, TheSameLightAsPaintedWithoutTexels) {
  Environment base = loadEnvironment("sky:mild");
  base.rotation_rad = 0.8f;
  base.intensity = 1.5f;
  std::vector<DistantLight> lights =
      parse({"disc?azimuth=30&elevation=50&radius=1&irradiance=3", "constant"}).at(0.0f);
  const Environment painted = paintLights(base, lights);
  lights.push_back(mapLight(base));
  Environment described = describeLights(lights);
  EXPECT_TRUE(described.empty());
  EXPECT_LT(worst(projectEnvironment(described, 6), projectEnvironment(painted, 6)), 1e-4);
  Environment turned = painted;
  turned.rotation_rad += 0.5f;
  turned.intensity = described.intensity = 2.0f;
  described.rotation_rad += 0.5f;
  EXPECT_LT(worst(projectEnvironment(described, 6), projectEnvironment(turned, 6)), 2e-4);
  EXPECT_EQ(projectEnvironment(describeLights({}), 6)[0], glm::vec3(0.0f));
}

TEST(PaintLights, SmallDiscsGetFineTexels) {
  const auto widthOf = [](const char* text) { return paintLights({}, parse({text}).at(0.0f)).width; };
  EXPECT_EQ(widthOf("disc?radius=20"), 512);
  EXPECT_EQ(widthOf("disc?radius=0.27"), 2048);
  EXPECT_EQ(widthOf("disc?radius=0.05"), 4096);
}

TEST(DistantLights, ErrorsNameTheTextAndTheKey) {
  const auto says = [](const std::string& text, const char* part) {
    EXPECT_NE(errorOf(text).find(part), std::string::npos) << errorOf(text);
  };
  says("disk", "disk: no such light");
  says("disc?radius=0", "radius: 0 is outside 0.05 to 180");
  says("disc?azimuth=0:0,4:1e9", "azimuth");
  says("disc?azimuth=4:0,1:2", "times must ascend");
  says("disc?azimuth=0:0,4", "'4' is not time:number");
  says("disc?azimuth=x", "'x' is not a number");
  says("disc?azimuth=nan", "azimuth");
  says("disc?colour=3", "unknown key 'colour'");
  says("disc?radiance=1&irradiance=1", "exclude each other");
  says("disc?radius=1&radius=2", "given twice");
  says("sky:nowhere", "no such sky");
  says("sky:preetham?elevation=0:10,5:95", "elevation: 95 is outside");
  says("probe:/nowhere.exr", "/nowhere.exr");
  says("/nowhere.json", "cannot be read");
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "gloam_lights_test.json";
  std::ofstream(path) << "{\"lights\": 3}";
  says(path.string(), "a JSON list of lights was expected");
  std::ofstream(path) << "[\"disc?elevation=30\", \"constant\"]";
  EXPECT_EQ(parse({path.string()}).at(0.0f).size(), 2u);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace gloam
