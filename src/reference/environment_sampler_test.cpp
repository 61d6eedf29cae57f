// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/environment_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "math/simd_test_targets.h"
#include "reference/sampler.h"
#include "scene/environment.h"

namespace gloam::reference {
namespace {

// Uneven, coloured, with a sun of one texel, a black part, turned and dimmed.
Environment oddSky(int width, int height) {
  Environment sky;
  sky.width = width;
  sky.height = height;
  for (int i = 0; i < width * height; ++i) {
    const float x = float(i % width) / float(width);
    sky.radiance.emplace_back(x < 0.3f ? 0.0f : 0.2f + x, x < 0.3f ? 0.0f : 1.0f - x, 0.5f * x);
  }
  sky.radiance[std::size_t((height / 3) * width + width / 2)] = glm::vec3(200.0f, 150.0f, 90.0f);
  sky.rotation_rad = 0.7f;
  sky.intensity = 1.7f;
  return sky;
}

// Sum over a fine grid of equal steps in angle.
template <class Function>
glm::dvec3 integral(const Function& function, int rows = 600) {
  glm::dvec3 sum(0.0);
  const double step = 3.14159265358979 / rows;
  for (int row = 0; row < rows; ++row) {
    const double elevation = 3.14159265358979 / 2 - (row + 0.5) * step;
    for (int column = 0; column < 2 * rows; ++column) {
      const double phi = (column + 0.5) * step;
      const glm::vec3 d(std::cos(elevation) * std::cos(phi), std::sin(elevation),
                        std::cos(elevation) * std::sin(phi));
      sum += glm::dvec3(function(d)) * (std::cos(elevation) * step * step);
    }
  }
  return sum;
}

TEST(EnvironmentSampler, IsTheEnvironment) {
  for (const glm::ivec2 size : {glm::ivec2(32, 16), glm::ivec2(7, 5), glm::ivec2(1, 1), glm::ivec2(2, 1)}) {
    const Environment sky = oddSky(size.x, size.y);
    const EnvironmentSampler sampler(sky, 0);
    for (std::uint32_t i = 0; i < 5000; ++i) {
      const glm::vec3 d = sampling::uniformSphere(sampling::r2(i));
      const glm::vec3 want = radianceFrom(sky, d);
      const EnvironmentSampler::Light got = sampler.from(d);
      EXPECT_LT(glm::length(got.radiance - want), 1e-3f + 1e-3f * glm::length(want));
      if (want != glm::vec3(0.0f)) {
        EXPECT_GT(got.pdf, 0.0f);
      }
    }
  }
}

TEST(EnvironmentSampler, DensityIntegratesToOne) {
  for (const glm::ivec2 size : {glm::ivec2(32, 16), glm::ivec2(6, 3), glm::ivec2(1, 1)}) {
    const EnvironmentSampler sampler(oddSky(size.x, size.y), 0);
    EXPECT_NEAR(integral([&](const glm::vec3& d) { return glm::vec3(sampler.from(d).pdf); }).x, 1.0, 2e-3);
  }
  const EnvironmentSampler projected(oddSky(32, 16), 4);
  EXPECT_NEAR(integral([&](const glm::vec3& d) { return glm::vec3(projected.from(d).pdf); }).x, 1.0, 2e-3);
}

struct SkyLight {
  LaneVectors radiance;
  LaneFloats pdf;
  SkyLight() = default;
  SkyLight(const EnvironmentSampler& sampler, const SkyPlaces& places, const LaneVectors& directions) {
    densitiesOf(places, pdf);
    sampler.radiance(places, directions, 0xffffu, radiance);
  }
};

/// Sixteen samples of a sequence.
struct Drawn {
  LaneVectors directions;
  SkyLight light;
  Drawn(const EnvironmentSampler& sampler, std::uint32_t first) {
    LaneBits places;
    SkyPlaces chosen;
    for (int i = 0; i < kLanes; ++i) places.at[i] = bits::reversedBits(first + std::uint32_t(i));
    sampler.choose(Sampler(9, 1, 0).scramble(0), places, chosen, directions);
    light = SkyLight(sampler, chosen, directions);
  }
};

// Moments of the light itself and of the direction, weighted by light / density, against the sum over the sphere; and each
// sample against what is there when one asks for one direction, or for sixteen.
void expectUnbiased(const EnvironmentSampler& sampler) {
  constexpr int kSamples = 1 << 16;
  glm::dvec3 light(0.0), up(0.0);
  int across_edges = 0;  // of blocks, by rounding
  for (int i = 0; i < kSamples; ++i) {
    const Drawn drawn(sampler, std::uint32_t(i) / kLanes * kLanes);
    const int lane = i % kLanes;
    const glm::vec3 direction = drawn.directions.get(lane), radiance = drawn.light.radiance.get(lane);
    const float pdf = drawn.light.pdf.at[lane];
    ASSERT_GT(pdf, 0.0f);
    ASSERT_NEAR(glm::length(direction), 1.0f, 1e-5f);
    const EnvironmentSampler::Light again = sampler.from(direction);
    across_edges += std::abs(again.pdf - pdf) > 2e-3f * pdf + 1e-4f ? 1 : 0;
    EXPECT_LT(glm::length(again.radiance - radiance), 2e-3f * glm::length(radiance) + 1e-3f);
    const glm::dvec3 weighted = glm::dvec3(radiance) / double(pdf) / double(kSamples);
    light += weighted;
    up += weighted * double(std::max(0.0f, direction.y + 0.3f * direction.x));
  }
  EXPECT_LT(across_edges, 10);
  const glm::dvec3 want_light = integral([&](const glm::vec3& d) { return sampler.from(d).radiance; });
  const glm::dvec3 want_up = integral(
      [&](const glm::vec3& d) { return sampler.from(d).radiance * std::max(0.0f, d.y + 0.3f * d.x); });
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(light[c], want_light[c], 2e-3 * std::abs(want_light[c]) + 1e-4);
    EXPECT_NEAR(up[c], want_up[c], 2e-3 * std::abs(want_up[c]) + 1e-4);
  }
}

// Out of sixteen directions at once: the same as out of each.
void compareLanesWithOne() {
  for (const int order : {0, 3}) {
    for (const glm::ivec2 size : {glm::ivec2(32, 16), glm::ivec2(3, 2), glm::ivec2(1, 1)}) {
      const EnvironmentSampler sampler(oddSky(size.x, size.y), order);
      for (std::uint32_t k = 0; k < 200; ++k) {
        LaneVectors directions;
        for (int i = 0; i < kLanes; ++i)
          directions.set(i, sampling::uniformSphere(sampling::r2(16 * k + std::uint32_t(i))));
        directions.set(3, {0.0f, 1.0f, 0.0f});
        directions.set(5, {0.0f, -1.0f, 0.0f});
        SkyPlaces places;
        sampler.find(directions, places);
        const SkyLight light(sampler, places, directions);
        for (int i = 0; i < kLanes; ++i) {
          const EnvironmentSampler::Light want = sampler.from(directions.get(i));
          EXPECT_NEAR(light.pdf.at[i], want.pdf, 1e-3f * want.pdf + 1e-5f);
          EXPECT_LT(glm::length(light.radiance.get(i) - want.radiance),
                    1e-3f * (1.0f + glm::length(want.radiance)));
        }
      }
    }
  }
}

TEST(EnvironmentSampler, LanesAreTheFunctionForOne) {
  onEveryTarget([](const char* target) {
    SCOPED_TRACE(target);
    compareLanesWithOne();
  });
}

TEST(EnvironmentSampler, TexelsKeepTheirRadiance) {
  for (const glm::vec3& color :
       {glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(0.3f, 0.7f, 1e-3f), glm::vec3(3e5f, 2e5f, 9e4f),
        glm::vec3(0.0f, 1e15f, 1.0f), glm::vec3(0.999999f, 0.5f, 0.25f), glm::vec3(1e-20f)}) {
    const float largest = std::max(color.r, std::max(color.g, color.b));
    EXPECT_LE(glm::length(unpacked(packed(color)) - color), 7e-6f * largest);
  }
  EXPECT_EQ(unpacked(packed({-1.0f, 2.0f, 0.0f})), glm::vec3(0.0f, 2.0f, 0.0f));
}

TEST(EnvironmentSampler, SamplesAreUnbiased) {
  expectUnbiased(EnvironmentSampler(oddSky(32, 16), 0));
  expectUnbiased(EnvironmentSampler(oddSky(5, 3), 0));
  expectUnbiased(EnvironmentSampler(oddSky(1, 1), 0));
}

TEST(EnvironmentSampler, ProjectionIsThatOfTheRenderer) {
  const Environment sky = oddSky(32, 16);
  const EnvironmentSampler sampler(sky, 3);
  const sh::ShRgb light = projectEnvironment(sky, 3);
  float least = 0.0f;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 d = sampling::uniformSphere(sampling::r2(i));
    const EnvironmentSampler::Light got = sampler.from(d);
    EXPECT_LT(glm::length(got.radiance - sh::valueAt(light, d)), 1e-4f);
    EXPECT_GT(got.pdf, 0.0f);
    least = std::min(least, got.radiance.r);
  }
  EXPECT_LT(least, 0.0f);  // rings below zero are kept
  expectUnbiased(sampler);
}

TEST(EnvironmentSampler, BlackAndMissingSkiesGiveNothing) {
  Environment black = oddSky(8, 4);
  for (glm::vec3& texel : black.radiance) texel = glm::vec3(0.0f);
  for (const int order : {0, 3}) {
    for (const Environment& sky : {black, Environment{}}) {
      const EnvironmentSampler sampler(sky, order);
      EXPECT_TRUE(sampler.black());
      EXPECT_EQ(sampler.from({0.0f, 1.0f, 0.0f}).radiance, glm::vec3(0.0f));
    }
  }
}

}  // namespace
}  // namespace gloam::reference
