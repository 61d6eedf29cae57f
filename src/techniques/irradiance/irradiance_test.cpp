// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/irradiance/irradiance.h"

#include "frame/test_frame.h"
#include "scene/environment.h"

namespace gloam::irradiance {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

Settings settings(const std::string& order, const std::string& window = "none") {
  Settings result(info().options);
  result.set("order", order);
  result.set("window", window);
  return result;
}

/// Draws the first camera's view; colours and normals a pixel.
struct Picture {
  std::vector<float> color, normal;
  std::vector<glm::uvec2> ids;
};
Picture draw(const Scene& scene, const Settings& settings) {
  frame::TestFrame frame(scene);
  Irradiance technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  const frame::FrameImages images = frame.draw(posed, posed.cameras.at(0), {.width = kSize, .height = kSize},
                                               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                                                 return technique.record(graph, inputs, settings);
                                               });
  return {images.color.image().downloadFloats(), images.normal.image().downloadFloats(), frame.ids()};
}

TEST(Irradiance, ConvexWhiteBodyInTheWhiteFurnaceIsOne) {
  const Scene scene = loadScene("builtin:furnace");
  for (const char* window : {"none", "hann", "lanczos", "auto"}) {
    const Picture picture = draw(scene, settings("3", window));
    int covered = 0;
    for (std::size_t i = 0; i < picture.ids.size(); ++i) {
      if (picture.ids[i].x == 0) continue;
      ++covered;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(picture.color[4 * i + std::size_t(c)], 1.0f, 0.002f) << window;
    }
    EXPECT_GT(covered, 500);
  }
}

// Every pixel against the C++ function of the same name.
TEST(Irradiance, EveryOrderIsTheSumOverItsBands) {
  Scene scene = loadScene("builtin:furnace");
  scene.environment = loadEnvironment("sky:preetham?elevation=25");
  const sh::ShRgb light = projectEnvironment(scene.environment, 6);
  for (int order = 2; order <= 6; ++order) {
    const Picture picture = draw(scene, settings(std::to_string(order)));
    const sh::ShRgb bands = sh::truncated(light, order);
    for (std::size_t i = 0; i < picture.ids.size(); i += 7) {
      if (picture.ids[i].x == 0) continue;
      const glm::vec3 normal(picture.normal[4 * i], picture.normal[4 * i + 1], picture.normal[4 * i + 2]);
      const glm::vec3 want = sh::irradiance(bands, glm::normalize(normal)) / kPi;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(picture.color[4 * i + std::size_t(c)], std::max(want[c], 0.0f),
                    3e-3f * std::abs(want[c]) + 2e-3f);
    }
  }
}

// A sun alone: order 3 undershoots behind the body; with "auto" the irradiance touches 0 and is not cut off
// there.
TEST(Irradiance, AutoWindowKeepsLightNonNegative) {
  const sh::ShRgb sun = sh::colored(sh::directionalLight(6, {0, 0, 1}), glm::vec3(1.0f));
  const sh::ShRgb plain = sh::convolve(sh::truncated(sun, 3), sh::clampedCosine(3));
  const sh::ShRgb damped = frame::windowed(plain, 3, frame::Window::kAuto);
  float least_plain = 0.0f, least_damped = 0.0f;
  for (int i = 0; i <= 180; ++i) {
    const glm::vec3 n(std::sin(float(i) * kPi / 180), 0, std::cos(float(i) * kPi / 180));
    least_plain = std::min(least_plain, sh::valueAt(plain, n).x);
    least_damped = std::min(least_damped, sh::valueAt(damped, n).x);
  }
  EXPECT_LT(least_plain, -0.03f);
  EXPECT_GT(least_damped, -1e-3f);
}

TEST(Irradiance, NormalMapsShow) {
  Scene scene = loadScene("builtin:furnace");
  scene.environment = loadEnvironment("sky:gradient");
  const Picture plain = draw(scene, settings("3"));
  scene.textures.push_back({.name = "tilt", .width = 1, .height = 1, .rgba = {230, 128, 200, 255}});
  for (Material& material : scene.materials) material.normal_map.texture = int(scene.textures.size()) - 1;
  const Picture mapped = draw(scene, settings("3"));
  float difference = 0.0f;
  for (std::size_t i = 0; i < plain.color.size(); ++i)
    difference = std::max(difference, std::abs(plain.color[i] - mapped.color[i]));
  EXPECT_GT(difference, 0.05f);
}

TEST(Irradiance, NoEnvironmentIsDark) {
  Scene scene = loadScene("builtin:furnace");
  scene.environment = {};
  const Picture picture = draw(scene, settings("3"));
  for (std::size_t i = 0; i < picture.ids.size(); ++i) {
    for (int c = 0; c < 3; ++c) ASSERT_EQ(picture.color[4 * i + std::size_t(c)], 0.0f);
  }
}

}  // namespace
}  // namespace gloam::irradiance
