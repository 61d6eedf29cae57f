// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The host's splatting against the same by compute passes.
#include "techniques/splatting/splatting_host.h"

#include <cmath>

#include "frame/test_frame.h"
#include "techniques/splatting/splatting.h"

namespace gloam::splatting {
namespace {

using Values = std::vector<std::pair<const char*, const char*>>;

struct Made {
  std::vector<float> irradiance;
  Counts counts{};
};

Made make(const Scene& scene, Values values, const char* gather, int width, int height,
          const PosedCamera* camera = nullptr) {
  Settings settings(info().options);
  values.emplace_back("gather", gather);
  for (const auto& [name, text] : values) settings.set(name, text);
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  frame.draw(posed, camera ? *camera : posed.cameras.at(0), {.width = width, .height = height},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  return {frame.floats("splatting.irradiance"),
          frame.graph.findBuffer("splatting.counts").buffer().download<Counts>().at(0)};
}

/// Ten bits a normal there, floats here: some texels beside a threshold are split by one alone.
void expectTwins(const Scene& scene, const Values& values, int width, int height,
                 const PosedCamera* camera = nullptr) {
  const Made host = make(scene, values, "host", width, height, camera),
             device = make(scene, values, "device", width, height, camera);
  ASSERT_EQ(host.irradiance.size(), device.irradiance.size());
  double difference = 0.0, square = 0.0;
  for (std::size_t i = 0; i < host.irradiance.size(); ++i) {
    if (i % 4 == 3) continue;
    ASSERT_TRUE(std::isfinite(host.irradiance[i])) << i;
    const double h = host.irradiance[i], d = device.irradiance[i];
    difference += (h - d) * (h - d);
    square += d * d;
  }
  EXPECT_GT(square, 0.0);
  EXPECT_LT(std::sqrt(difference / square), 2e-3);
  EXPECT_NEAR(double(host.counts.subsplats), double(device.counts.subsplats),
              0.01 * double(device.counts.subsplats));
  for (int s = 0; s < 3; ++s)
    EXPECT_NEAR(double(host.counts.listed[s]), double(device.counts.listed[s]),
                0.01 * double(device.counts.subsplats))
        << s;
}

TEST(SplattingHost, IsTheDevicesTwin) {
  const Scene swing = loadScene("builtin:swing?detail=0.5");
  expectTwins(swing, {}, 256, 192);
  expectTwins(swing, {{"vpls", "1024"}, {"cluster_threshold", "0.02"}}, 256, 192);
  expectTwins(swing, {{"vpls", "30"}, {"bound", "disc"}, {"upsample", "paper"}}, 256, 192);
  expectTwins(swing, {{"light_threshold", "0"}, {"normals", "geometric"}, {"bound", "none"}}, 256, 192);
  expectTwins(loadScene("builtin:teapot?detail=0.5"), {}, 200, 300);
}

TEST(SplattingHost, TakesAnySizeAndCamera) {
  const Scene scene = loadScene("builtin:lamp?detail=0.3");
  for (const auto& [width, height] : {std::pair(33, 32), {151, 97}, {64, 35}, {40, 331}})
    expectTwins(scene, {}, width, height);
  PosedCamera above = frame::cameraAt({0.3f, 1.5f, 2.0f}, {0, 0.5f, 0}, 40);
  above.camera.perspective = false;
  above.camera.half_height = 1.5f;
  expectTwins(scene, {}, 128, 96, &above);
}

}  // namespace
}  // namespace gloam::splatting
