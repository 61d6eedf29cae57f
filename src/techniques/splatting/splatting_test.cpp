// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/splatting/splatting.h"

#include "frame/test_frame.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {
namespace {

Settings settings(std::initializer_list<std::pair<const char*, const char*>> values) {
  Settings result(info().options);
  for (const auto& [name, text] : values) result.set(name, text);
  return result;
}

struct Picture {
  int width = 0, height = 0;
  std::vector<float> irradiance;
  std::vector<glm::uvec2> ids;
  Counts counts{};
};

Picture draw(const Scene& scene, const Settings& settings, int width, int height, const PosedCamera* camera = nullptr) {
  frame::TestFrame frame(scene);
  Splatting technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  frame.draw(posed, camera ? *camera : posed.cameras.at(0), {.width = width, .height = height},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  Picture picture{width, height, frame.floats("splatting.irradiance"), frame.ids(), {}};
  if (const gpu::BufferRef counts = frame.graph.findBuffer("splatting.counts"))
    picture.counts = counts.buffer().download<Counts>().at(0);
  return picture;
}

/// Root of the squared difference over that of the squares, where there is a surface.
double relativeError(const Picture& got, const Picture& want) {
  double difference = 0.0, square = 0.0;
  for (std::size_t i = 0; i < want.ids.size(); ++i) {
    if (want.ids[i].x == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double g = got.irradiance[4 * i + c], w = want.irradiance[4 * i + c];
      difference += (g - w) * (g - w);
      square += w * w;
    }
  }
  return std::sqrt(difference / square);
}

TEST(Splatting, NoThresholdIsTheFullSum) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture full = draw(scene, settings({{"mode", "full"}}), 150, 97);
  const Picture fine = draw(scene, settings({{"normal_threshold", "0"}, {"depth_threshold", "0"}}), 150, 97);
  EXPECT_LT(relativeError(fine, full), 1e-3);
}

TEST(Splatting, ManyResolutionsComeNearTheFullSumForFarLess) {
  const Scene scene = loadScene("builtin:cornell?detail=0.5");
  const Picture full = draw(scene, settings({{"mode", "full"}}), 384, 384);
  const Picture coarse = draw(scene, settings({}), 384, 384);
  const double error = relativeError(coarse, full);
  printf("error %g, subsplats %u of %u\n", error, coarse.counts.subsplats, 384u * 384u);
  EXPECT_LT(error, 0.02);
  EXPECT_LT(coarse.counts.subsplats, 384u * 384u / 8);
}

}  // namespace
}  // namespace gloam::splatting
