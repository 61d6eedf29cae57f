// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shader functions against the C++ functions of the same name.
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "math/brdf.h"
#include "math/sampling.h"
#include "math/sh_product_glsl.h"
// Last: it brings GLSL's names along.
#include "math/glsl_as_cpp.h"

namespace gloam {
namespace {

sh::Sh randomFunction(int order, sampling::Rng& random) {
  sh::Sh f(order);
  for (int i = 0; i < f.size(); ++i) f[i] = random.next() - 0.5f;
  return f;
}

sh::ShRgb randomLight(int order, sampling::Rng& random) {
  sh::ShRgb f(order);
  for (int i = 0; i < f.size(); ++i) f[i] = random.next3() - 0.5f;
  return f;
}

void expectNear(const float* got, const sh::Sh& want, float tolerance) {
  for (int i = 0; i < want.size(); ++i)
    EXPECT_NEAR(got[i], want[i], tolerance) << "order " << want.order << ", " << i;
}

void expectNear(const glm::vec3& got, const glm::vec3& want, float tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance);
}

TEST(Glsl, EvaluatesTheBasis) {
  float y[36];
  for (const glm::vec3& d : sampling::fibonacciSphere(50)) {
    glsl::shEvaluate2(d, y), expectNear(y, sh::evaluate(2, d), 1e-6f);
    glsl::shEvaluate3(d, y), expectNear(y, sh::evaluate(3, d), 1e-6f);
    glsl::shEvaluate4(d, y), expectNear(y, sh::evaluate(4, d), 1e-6f);
    glsl::shEvaluate5(d, y), expectNear(y, sh::evaluate(5, d), 1e-6f);
    glsl::shEvaluate6(d, y), expectNear(y, sh::evaluate(6, d), 1e-6f);
  }
}

TEST(Glsl, TurnsZonalFunctions) {
  sh::Zh zonal{6, {1.0f, -0.5f, 0.7f, 0.2f, -0.9f, 0.4f}};
  float f[36];
  for (const glm::vec3& d : sampling::fibonacciSphere(20)) {
    const sh::Sh want = sh::rotateZonal(zonal, d);
    glsl::shRotateZonal2(zonal.c.data(), d, f), expectNear(f, sh::truncated(want, 2), 1e-6f);
    glsl::shRotateZonal3(zonal.c.data(), d, f), expectNear(f, sh::truncated(want, 3), 1e-6f);
    glsl::shRotateZonal4(zonal.c.data(), d, f), expectNear(f, sh::truncated(want, 4), 1e-6f);
    glsl::shRotateZonal5(zonal.c.data(), d, f), expectNear(f, sh::truncated(want, 5), 1e-6f);
    glsl::shRotateZonal6(zonal.c.data(), d, f), expectNear(f, sh::truncated(want, 6), 1e-6f);
  }
}

TEST(Glsl, ConvolvesWithTheCosine) {
  sampling::Rng random(1);
  using Convolve = void (*)(glm::vec3*);
  const Convolve convolve[] = {glsl::shConvolveCosine3, glsl::shConvolveCosine4, glsl::shConvolveCosine5,
                               glsl::shConvolveCosine6};
  for (int order = 3; order <= 6; ++order) {
    sh::ShRgb light = randomLight(order, random);
    const sh::ShRgb want = sh::convolve(light, sh::clampedCosine(order));
    convolve[order - 3](light.c.data());
    for (int i = 0; i < want.size(); ++i) expectNear(light[i], want[i], 1e-6f);
  }
}

TEST(Glsl, GivesIrradianceAndShadesLobes) {
  sampling::Rng random(2);
  using Irradiance = glm::vec3 (*)(const glm::vec3*, glm::vec3);
  using Phong = glm::vec3 (*)(const glm::vec3*, glm::vec3, float);
  const Irradiance irradiance[] = {glsl::shIrradiance3, glsl::shIrradiance4, glsl::shIrradiance5,
                                   glsl::shIrradiance6};
  const Irradiance lambert[] = {glsl::shadeLambert3, glsl::shadeLambert4, glsl::shadeLambert5,
                                glsl::shadeLambert6};
  const Phong phong[] = {glsl::shadePhong3, glsl::shadePhong4, glsl::shadePhong5, glsl::shadePhong6};
  for (int order = 3; order <= 6; ++order)
    for (const glm::vec3& axis : sampling::fibonacciSphere(10)) {
      sh::ShRgb light = randomLight(order, random);
      expectNear(irradiance[order - 3](light.c.data(), axis), sh::irradiance(light, axis), 1e-5f);
      expectNear(lambert[order - 3](light.c.data(), axis), brdf::shadeLambert(light, axis), 1e-5f);
      for (const float exponent : {1.0f, 7.5f, 300.0f})
        expectNear(phong[order - 3](light.c.data(), axis, exponent), brdf::shadePhong(light, axis, exponent),
                   1e-5f);
    }
}

TEST(Glsl, MultipliesFunctions) {
  sampling::Rng random(3);
  using Product = void (*)(const float*, const float*, float*);
  const Product product[] = {glsl::shProduct2, glsl::shProduct3, glsl::shProduct4, glsl::shProduct5,
                             glsl::shProduct6};
  for (int order = 2; order <= 6; ++order)
    for (int repeat = 0; repeat < 5; ++repeat) {
      sh::Sh f = randomFunction(order, random), g = randomFunction(order, random);
      float h[36];
      product[order - 2](f.c.data(), g.c.data(), h);
      expectNear(h, sh::product(f, g), 2e-6f);
    }
}

TEST(Glsl, ProductFilesAreWhatTheGeneratorWrites) {
  const std::filesystem::path folder = std::filesystem::path(__FILE__).parent_path();
  const auto contents = [&folder](const char* name) {
    std::stringstream text;
    text << std::ifstream(folder / name).rdbuf();
    return text.str();
  };
  EXPECT_TRUE(contents("sh_product.glsl") == sh::productGlsl(2, 4))
      << "out of date: sh_write_glsl " << folder;
  EXPECT_TRUE(contents("sh_product_high.glsl") == sh::productGlsl(5, 6))
      << "out of date: sh_write_glsl " << folder;
}

TEST(Glsl, KnowsTheMaterial) {
  EXPECT_EQ(glsl::kMaxPhongExponent, brdf::kMaxPhongExponent);
  for (const float roughness : {0.0f, 0.01f, 0.2f, 0.5f, 0.9f, 1.0f}) {
    EXPECT_FLOAT_EQ(glsl::phongExponent(roughness), brdf::phongExponent(roughness));
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
      const glm::vec3 base(0.9f, 0.5f, 0.1f);
      const float specular = 1.0f - 0.5f * roughness;
      const glsl::Lobes got = glsl::makeLobes(base, metallic, roughness, specular);
      const brdf::Lobes want = brdf::makeLobes(base, metallic, roughness, specular);
      expectNear(got.diffuse, want.diffuse, 1e-7f);
      expectNear(got.specular, want.specular, 1e-7f);
      const glm::vec3 normal = glm::normalize(glm::vec3(0.1f, 1.0f, 0.3f)),
                      view = glm::normalize(glm::vec3(1, 2, 3));
      expectNear(glsl::mirrorDirection(normal, view), brdf::mirrorDirection(normal, view), 1e-6f);
      for (const glm::vec3& d : sampling::fibonacciSphere(30)) {
        const glm::vec3 value = brdf::evaluateLobes(want, normal, view, d);
        expectNear(glsl::evaluateLobes(got, normal, view, d), value, 1e-5f * (1.0f + value.x));
      }
    }
  }
  for (const float exponent : {1.0f, 2.0f, 10.0f, 1000.0f}) {
    float factors[6];
    glsl::phongBandFactors(exponent, factors);
    for (int l = 0; l < 6; ++l) {
      EXPECT_NEAR(factors[l], brdf::phongBandFactor(l, exponent), 1e-6f);
      EXPECT_NEAR(glsl::kLambertBandFactors[l], brdf::lambertBandFactor(l), 1e-7f);
    }
  }
}

}  // namespace
}  // namespace gloam
