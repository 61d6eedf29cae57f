// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/brdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/quadrature.h"
#include "math/sampling.h"

namespace gloam::brdf {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// 2 pi times the integral over 0 < t < 1 of g(t).
template <class Function>
double overHemisphere(const Function& g, int points = 64) {
  const GaussLegendre<double> rule(points);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    sum += 0.5 * rule.weights[i] * g(0.5 + 0.5 * rule.nodes[i]);
  return 2.0 * kPi * sum;
}

double legendre(int l, double t) {
  return std::legendre(static_cast<unsigned>(l), t);
}

TEST(Brdf, MaterialIsThatOfTheDocument) {
  EXPECT_FLOAT_EQ(phongExponent(1.0f), 1.0f);
  EXPECT_FLOAT_EQ(phongExponent(0.5f), 30.0f);
  EXPECT_FLOAT_EQ(phongExponent(0.0f), kMaxPhongExponent);
  EXPECT_FLOAT_EQ(phongExponent(0.001f), kMaxPhongExponent);
  const Lobes plastic = makeLobes({0.5f, 0.6f, 0.7f}, 0.0f, 0.5f),
              metal = makeLobes({0.5f, 0.6f, 0.7f}, 1.0f, 0.5f);
  EXPECT_EQ(plastic.diffuse, glm::vec3(0.5f, 0.6f, 0.7f));
  EXPECT_EQ(plastic.specular, glm::vec3(0.04f));
  EXPECT_EQ(makeLobes(glm::vec3(0.5f), 0.0f, 0.5f, 0.0f).specular, glm::vec3(0.0f));  // no gloss at all
  EXPECT_EQ(metal.diffuse, glm::vec3(0.0f));
  EXPECT_EQ(metal.specular, glm::vec3(0.5f, 0.6f, 0.7f));
}

TEST(Brdf, BandFactorsEqualQuadratureOfTheLobes) {
  for (int l = 0; l <= 5; ++l) {
    EXPECT_NEAR(lambertBandFactor(l), overHemisphere([l](double t) { return t / kPi * legendre(l, t); }),
                1e-7)
        << l;
    for (const float n : {1.0f, 2.0f, 3.0f, 3.5f, 4.0f, 10.0f, 47.3f, 100.0f})
      EXPECT_NEAR(phongBandFactor(l, n), overHemisphere([l, n](double t) {
                    return (double(n) + 1.0) / (2.0 * kPi) * std::pow(t, double(n)) * legendre(l, t);
                  }),
                  2e-6)
          << l << ' ' << n;
  }
  // RF-5 as it is printed there.
  for (const float n : {1.0f, 5.0f, 20.0f}) {
    EXPECT_FLOAT_EQ(phongBandFactor(0, n), 1.0f);
    EXPECT_FLOAT_EQ(phongBandFactor(1, n), (n + 1.0f) / (n + 2.0f));
    EXPECT_FLOAT_EQ(phongBandFactor(2, n), n / (n + 3.0f));
  }
  EXPECT_NEAR(lambertZonal(6)[0], std::sqrt(kPi) / 2.0 / kPi, 1e-7);
  EXPECT_NEAR(lambertZonal(6)[1], std::sqrt(kPi / 3.0) / kPi, 1e-7);
  EXPECT_NEAR(lambertZonal(6)[4], -2.0 * std::sqrt(9.0 / (4.0 * kPi)) * 24.0 / (6.0 * 3.0 * 16.0 * 4.0),
              1e-7);
  EXPECT_NEAR(phongZonal(6, 9.0f)[3], std::sqrt(7.0 / (4.0 * kPi)) * 10.0 * 8.0 / (13.0 * 11.0), 1e-6);
}

TEST(Brdf, NarrowLobesKeepTheirFactors) {
  for (int l = 0; l <= 5; ++l) {
    EXPECT_NEAR(phongBandFactor(l, kMaxPhongExponent), 1.0f, 2e-5f);
    EXPECT_LE(phongBandFactor(l, kMaxPhongExponent), 1.0f);
  }
}

TEST(Brdf, LobesIntegrateToOneAndAgreeWithTheirBands) {
  const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));
  for (const float n : {1.0f, 6.0f, 30.0f}) {
    const sh::Sh lobe = sh::project(
        6, [&](const glm::vec3& d) { return phongLobe(n, axis, d); }, 200);
    const sh::Sh zonal = sh::rotateZonal(phongZonal(6, n), axis);
    for (int i = 0; i < 36; ++i) EXPECT_NEAR(lobe[i], zonal[i], 2e-4f) << n << ' ' << i;
  }
  const sh::Sh lobe = sh::project(
      6, [&](const glm::vec3& d) { return lambertLobe(axis, d); }, 200);
  const sh::Sh zonal = sh::rotateZonal(lambertZonal(6), axis);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(lobe[i], zonal[i], 2e-4f) << i;
}

TEST(Brdf, WhiteFurnace) {
  const sh::ShRgb white = sh::constantSky(6, glm::vec3(1.0f));
  const glm::vec3 normal(0, 1, 0), view = glm::normalize(glm::vec3(1, 1, 0));
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    const Lobes lobes = makeLobes({0.8f, 0.5f, 0.2f}, 0.25f, roughness);
    const glm::vec3 out = shade(lobes, white, normal, view), want = lobes.diffuse + lobes.specular;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(out[i], want[i], 2e-6f);
  }
}

TEST(Brdf, OrderThreeKeepsTheKnownPartOfAPeak) {
  // The value of a lobe's order-3 projection on its axis, relative to the lobe's own.
  const float exponents[] = {5.0f, 10.0f, 20.0f, 50.0f}, kept[] = {0.56f, 0.34f, 0.20f, 0.085f};
  for (int i = 0; i < 4; ++i) {
    const sh::Sh lobe = sh::rotateZonal(phongZonal(3, exponents[i]), {0, 0, 1});
    const float peak = (exponents[i] + 1.0f) / (2.0f * static_cast<float>(kPi));
    EXPECT_NEAR(sh::valueAt(lobe, {0, 0, 1}) / peak, kept[i], 0.006f);
  }
}

TEST(Brdf, MirrorsAndDropsNothingItself) {
  const glm::vec3 normal(0, 0, 1), view = glm::normalize(glm::vec3(1, 0, 1));
  EXPECT_NEAR(glm::distance(mirrorDirection(normal, view), glm::normalize(glm::vec3(-1, 0, 1))), 0.0f, 1e-6f);
  EXPECT_GT(phongLobe(1.0f, mirrorDirection(normal, view), glm::normalize(glm::vec3(-1, 0, -0.1f))), 0.0f);
  EXPECT_EQ(phongLobe(1.0f, {0, 0, 1}, {0, 0, -1}), 0.0f);
  EXPECT_EQ(lambertLobe({0, 0, 1}, {0, 0, -1}), 0.0f);
}

TEST(Brdf, SamplingEstimatesIntegralsWithoutBias) {
  // Of the lobes times a function that favours one side, against quadrature.
  const glm::vec3 normal = glm::normalize(glm::vec3(0.2f, 1.0f, 0.4f)),
                  view = glm::normalize(glm::vec3(1, 1.5f, 0));
  const glm::vec3 side = glm::normalize(glm::vec3(-1, 0.2f, 0.7f));
  const auto tilted = [&side](const glm::vec3& d) {
    const float value = 1.0f + glm::dot(d, side);
    return value * value;
  };
  for (const float metallic : {0.0f, 0.5f, 1.0f})
    for (const float roughness : {0.3f, 0.6f, 1.0f}) {
      const Lobes lobes = makeLobes({0.9f, 0.5f, 0.1f}, metallic, roughness);
      const sh::ShRgb integral = sh::projectRgb(
          1, [&](const glm::vec3& d) { return evaluateLobes(lobes, normal, view, d) * tilted(d); }, 300);
      const int count = 40000;
      double sum = 0.0, squares = 0.0;
      for (int i = 0; i < count; ++i) {
        sampling::Rng random(5, static_cast<std::uint32_t>(i));
        const LobeSample sample = sampleLobes(lobes, normal, view, random.next3());
        ASSERT_GT(sample.pdf, 0.0f);
        ASSERT_NEAR(glm::length(sample.direction), 1.0f, 1e-5f);
        const double weight = double(sample.value.x) * double(tilted(sample.direction)) / double(sample.pdf);
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / count, want = double(integral[0].x) * std::sqrt(4.0 * kPi);
      const double deviation = std::sqrt((squares / count - mean * mean) / count);
      EXPECT_LT(deviation, 0.01 * mean);
      EXPECT_NEAR(mean, want, 4.0 * deviation + 1e-4 * want) << metallic << ' ' << roughness;
    }
}

TEST(Brdf, DensityIntegratesToOne) {
  const glm::vec3 normal(0, 1, 0), view = glm::normalize(glm::vec3(1, 1, 0.5f));
  const Lobes lobes = makeLobes({0.5f, 0.5f, 0.5f}, 0.4f, 0.5f);
  const sh::Sh integral = sh::project(
      1, [&](const glm::vec3& d) { return lobesPdf(lobes, normal, view, d); }, 300);
  EXPECT_NEAR(integral[0] * std::sqrt(4.0 * kPi), 1.0, 1e-3);
}

TEST(Brdf, BlackMaterialEndsThePath) {
  Lobes black;
  EXPECT_EQ(sampleLobes(black, {0, 0, 1}, {0, 0, 1}, {0.5f, 0.5f, 0.5f}).pdf, 0.0f);
  EXPECT_EQ(specularProbability(black), 0.0f);
}

}  // namespace
}  // namespace gloam::brdf
