// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/proxies/proxies_operators.h"

#include <gtest/gtest.h>

#include "frame/test_frame.h"
#include "math/sampling.h"
#include "techniques/proxies/proxies.h"
#include "techniques/proxies/proxies_tables.h"
#include "techniques/proxies/proxies_vertices.h"

namespace gloam::proxies {
namespace {

/// ||A - E|| over random lights, the slow twin: the norm is the mean over all lights. What each operator sends is summed up
/// from its definition, direction by direction.
TEST(ProxiesOperators, FrobeniusDistanceIsTheMeanOverLights) {
  const float sine = 0.7f, cosine = std::sqrt(1.0f - sine * sine);
  const std::vector<glm::vec3> ways = sampling::fibonacciSphere(60000);
  double wrong = 0.0, all = 0.0;
  for (int k = 0; k < 9; ++k) {  // an orthonormal set of lights has that mean
    sh::Sh light(3);
    light[k] = 1.0f;
    const sh::Sh leaving = sh::convolve(light, sh::clampedCosine(3));
    const sh::Sh middle = sh::evaluate(3, {0, 0, -1});
    const float at_middle = sh::dot(leaving, middle);
    double exact[9] = {}, disc[9] = {};
    for (const glm::vec3& s : ways) {
      if (s.z < cosine) continue;
      const float distance = s.z - std::sqrt(std::max(0.0f, s.z * s.z - cosine * cosine));
      const float seen = sh::valueAt(leaving, (distance * s - glm::vec3(0, 0, 1)) / sine);
      const sh::Sh y = sh::evaluate(3, s);
      for (int j = 0; j < 9; ++j) exact[j] += double(seen * y[j]), disc[j] += double(at_middle * y[j]);
    }
    for (int j = 0; j < 9; ++j)
      wrong += (disc[j] - exact[j]) * (disc[j] - exact[j]), all += exact[j] * exact[j];
  }
  const std::vector<OperatorDistance> distances = operatorDistances(10);
  ASSERT_EQ(distances.size(), 10u);
  EXPECT_NEAR(distances[6].sine, sine, 1e-6f);
  EXPECT_NEAR(distances[6].point, std::sqrt(wrong / all), 0.01);
  for (const OperatorDistance& d : distances) {
    if (d.sine < 0.95f) {  // who touches the sphere sees one point of it
      EXPECT_LT(d.averaged, d.point);
    }
  }
}

// Under light from everywhere all three send the same.
TEST(ProxiesOperators, AgreeUnderAWhiteSky) {
  const PlaneErrors errors = planeErrors(sh::constantSky(4, glm::vec3(1.0f)), 1.2f, 6.0f, 24);
  EXPECT_LT(errors.averaged, 1e-3);
  EXPECT_LT(errors.point, 1e-3);
}

TEST(ProxiesOperators, AverageIsNearerToTheExactOneThanThePoint) {
  const sh::ShRgb light =
      sh::colored(sh::directionalLight(4, glm::normalize(glm::vec3(1, 2, 0))), glm::vec3(1.0f));
  const PlaneErrors errors = planeErrors(light, 1.2f, 6.0f, 24);
  EXPECT_LT(errors.averaged, 0.25 * errors.point);
}

TEST(ProxiesOperators, PolynomialsAreAsNearAsThePaperSays) {
  EXPECT_LT(fitErrors().linear, 2 * 0.0000016);
  EXPECT_LT(fitErrors().quadratic, 2 * 0.0000064);
}

// The same kernel for vertices and pixels: vertices of a ground without proxies get the light of their normal, those under a
// proxy less.
TEST(ProxiesVertices, LightOfVerticesIsThatOfPixels) {
  SceneBuilder builder("plane");
  builder.place("ground", shapes::ground(8, 8, 40, 40), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.sky("gradient");
  const Scene scene = builder.finish();
  const PosedScene posed = pose(scene, 0.0f);
  const frame::Proxy sphere{{0.0f, 1.0f, 0.0f}, 0.6f, glm::vec3(0.5f)};
  VertexShading shading("", scene, posed, scene.environment, std::span(&sphere, 1));
  EXPECT_EQ(shading.vertexCount(), scene.meshes[0].vertexCount());
  Settings settings(info().options);
  const std::vector<PassTime> times = shading.shade(settings);
  EXPECT_FALSE(times.empty());
  const std::vector<glm::vec3> direct = shading.direct();
  ASSERT_EQ(direct.size(), shading.vertexCount());
  float under = 1e9f, far = 0.0f;
  for (std::size_t v = 0; v < direct.size(); ++v) {
    const glm::vec3 p = scene.meshes[0].positions[v];
    const float away = std::hypot(p.x, p.z);
    if (away < 0.3f) under = std::min(under, direct[v].y);
    if (away > 4.5f) far = std::max(far, direct[v].y);
    EXPECT_GT(direct[v].y, 0.0f);
  }
  EXPECT_LT(under, 0.75f * far);
}

}  // namespace
}  // namespace gloam::proxies
