// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "gpu/frame_graph.h"
#include "gpu/test_device.h"
#include "shaders/gpu_test_shaders.h"

namespace gloam::gpu {
namespace {

constexpr int kSize = 16;
constexpr ImageDesc kColor{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = kSize, .height = kSize};
constexpr ImageDesc kId{.format = VK_FORMAT_R32_UINT, .width = kSize, .height = kSize};
constexpr ImageDesc kDepth{.format = VK_FORMAT_D32_SFLOAT, .width = kSize, .height = kSize};

class Raster : public testing::Test {
 protected:
  Raster() {
    red.uploadFloats(std::vector<float>{1, 0, 0, 1});
    green.uploadFloats(std::vector<float>{0, 1, 0, 1});
  }
  struct Targets {
    ImageRef color, id, depth;
  };
  Targets begin() {
    graph.begin();
    return {graph.create("test.color", kColor), graph.create("test.id", kId),
            graph.create("test.depth", kDepth)};
  }
  /// A pass that clears all targets and draws with depth test.
  RasterPass& drawing(const Targets& targets) {
    return graph.raster("test.draw", gpu_draw_vert_spv, gpu_draw_frag_spv)
        .color("out_color", targets.color, {0.0f, 0.0f, 0.25f, 0.0f})
        .color("out_id", targets.id, ClearColor::uints(0))
        .depth(targets.depth, 1.0f)
        .read("Positions", positions)
        .push(glm::vec2(0.0f));
  }
  static std::array<float, 3> pixel(const ImageRef& image, int x, int y) {
    const auto values = image.image().downloadFloats();
    const auto at = static_cast<std::size_t>(4 * (y * kSize + x));
    return {values[at], values[at + 1], values[at + 2]};
  }
  static float single(const ImageRef& image, int x, int y) {
    return image.image().downloadFloats()[static_cast<std::size_t>(y * kSize + x)];
  }

  Image red{testDevice(), "red", {.format = VK_FORMAT_R8G8B8A8_UNORM}};
  Image green{testDevice(), "green", {.format = VK_FORMAT_R8G8B8A8_UNORM}};
  // A triangle over the upper left half at depth 0.5 (counter-clockwise in the picture), and a quad at depth 0.25.
  Buffer positions{testDevice(), "positions",
                   std::vector<glm::vec3>{{-1, -1, 0.5f},
                                          {-1, 1, 0.5f},
                                          {1, -1, 0.5f},
                                          {-1, -1, 0.25f},
                                          {-1, 1, 0.25f},
                                          {1, -1, 0.25f},
                                          {1, 1, 0.25f}}};
  Buffer indices{testDevice(), "indices", std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}};
  FrameGraph graph{testDevice()};
  const std::array<float, 3> kRed{1, 0, 0}, kGreen{0, 1, 0}, kBack{0, 0, 0.25f};
};

TEST_F(Raster, ATriangleCoversItsHalf) {
  const auto targets = begin();
  drawing(targets).draw().sample("base_color", red).vertices(3);
  graph.execute();
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      if (x + y == kSize - 1) continue;  // the edge itself may go either way
      const bool inside = x + y < kSize - 1;
      ASSERT_EQ(pixel(targets.color, x, y), inside ? kRed : kBack) << x << " " << y;
      ASSERT_EQ(single(targets.id, x, y), inside ? 1.0f : 0.0f) << x << " " << y;
      ASSERT_EQ(single(targets.depth, x, y), inside ? 0.5f : 1.0f) << x << " " << y;
    }
  }
}

TEST_F(Raster, EachDrawHasItsOwnTexturesConstantsAndPush) {
  const auto targets = begin();
  auto& pass = drawing(targets);
  pass.draw().sample("base_color", red).push(glm::vec2(-1.0f, 0.0f)).vertices(3);
  pass.draw().sample("base_color", green).push(glm::vec2(1.0f, 0.0f)).vertices(3);
  pass.draw().sample("base_color", red).push(glm::vec2(1.0f, 1.0f)).specialize("kInvert", true).vertices(3);
  graph.execute();
  EXPECT_EQ(pixel(targets.color, 1, 1), kRed);
  EXPECT_EQ(pixel(targets.color, kSize / 2 + 1, 1), kGreen);
  EXPECT_EQ(pixel(targets.color, 12, 14), (std::array<float, 3>{0, 1, 1}));
}

TEST_F(Raster, IndexedDrawsDepthAndCulling) {
  for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_FRONT_BIT}) {
    const auto targets = begin();
    auto& pass = drawing(targets);
    pass.draw().sample("base_color", green).indexed(indices, 6, 1, 0, 3);
    pass.draw().sample("base_color", red).cull(cull).vertices(3);  // behind the quad
    graph.execute();
    EXPECT_EQ(pixel(targets.color, 1, 1), kGreen);
    EXPECT_EQ(pixel(targets.color, kSize - 2, kSize - 2), kGreen);
  }
  for (const auto& [cull, seen] :
       {std::pair(VK_CULL_MODE_BACK_BIT, kRed), std::pair(VK_CULL_MODE_FRONT_BIT, kBack)}) {
    const auto targets = begin();
    drawing(targets).draw().sample("base_color", red).cull(cull).vertices(3);
    graph.execute();
    EXPECT_EQ(pixel(targets.color, 1, 1), seen) << "counter-clockwise in the picture is the front";
  }
}

TEST_F(Raster, WithoutAClearTargetsKeepWhatTheyHold) {
  const auto targets = begin();
  drawing(targets).draw().sample("base_color", red).vertices(3);
  RasterState add;
  add.blend = Blend::kAdd;
  auto& over = graph.raster("test.over", gpu_draw_vert_spv, gpu_draw_frag_spv)
                   .color("out_color", targets.color)
                   .color("out_id", graph.create("test.other_id", kId))
                   .depth(targets.depth)
                   .read("Positions", positions)
                   .push(glm::vec2(0.0f));
  over.draw().sample("base_color", green).indexed(indices, 6, 1, 0, 3);
  graph.execute();
  EXPECT_EQ(pixel(targets.color, kSize - 2, kSize - 2), kGreen);
  EXPECT_EQ(single(targets.depth, 1, 1), 0.25f);
}

TEST_F(Raster, DepthAloneIntoALayerAndAViewport) {
  graph.begin();
  const auto shadow = graph.create(
      "test.shadow", ImageDesc{.format = VK_FORMAT_D32_SFLOAT, .width = kSize, .height = kSize, .layers = 2});
  graph.clear("test.clear", shadow, {1, 0, 0, 0});
  auto& pass = graph.raster("test.shadow", gpu_draw_vert_spv)
                   .depth(shadow.layer(1))
                   .viewport(8, 8, 8, 8)
                   .read("Positions", positions)
                   .push(glm::vec2(0.0f));
  pass.draw().indexed(indices, 6, 1, 0, 3);
  graph.execute();
  const auto untouched = shadow.image().downloadFloats(0, 0), drawn = shadow.image().downloadFloats(0, 1);
  EXPECT_EQ(untouched, std::vector<float>(kSize * kSize, 1.0f));
  EXPECT_EQ(drawn[7 * kSize + 9], 1.0f);
  EXPECT_EQ(drawn[9 * kSize + 7], 1.0f);
  EXPECT_EQ(drawn[8 * kSize + 8], 0.25f);
  EXPECT_EQ(drawn[15 * kSize + 15], 0.25f);
}

TEST_F(Raster, ColoursCanBeSampledAfterwards) {
  const auto targets = begin();
  drawing(targets).draw().sample("base_color", red).vertices(3);
  const auto second = graph.create("test.second", kColor);
  graph.raster("test.second", gpu_draw_vert_spv, gpu_draw_frag_spv)
      .color("out_color", second)  // nothing has written it yet: it starts at zero
      .color("out_id", graph.create("test.second_id", kId))
      .read("Positions", positions)
      .push(glm::vec2(0.0f))
      .draw()
      .sample("base_color", targets.color, kNearestClamp)
      .vertices(3);
  graph.execute();
  EXPECT_EQ(pixel(second, 2, 3), kRed);
  EXPECT_EQ(pixel(second, kSize - 2, kSize - 2), (std::array<float, 3>{0, 0, 0}));
}

TEST_F(Raster, MistakesAreNamed) {
  const auto error = [&](auto&& write_down) {
    const auto targets = begin();
    return errorOf([&] {
      write_down(targets);
      graph.execute();
    });
  };
  const auto pass = [&]() -> RasterPass& {
    return graph.raster("test.draw", gpu_draw_vert_spv, gpu_draw_frag_spv);
  };
  EXPECT_EQ(error([&](const Targets&) { pass().draw(); }), "pass 'test.draw': draws into nothing");
  EXPECT_EQ(error([&](const Targets& t) { pass().color("out_color", t.color).draw(); }),
            "pass 'test.draw': output 'out_id' of gpu_draw.vert + gpu_draw.frag has no target");
  EXPECT_EQ(error([&](const Targets& t) { drawing(t).color("out_normal", t.color); }),
            "pass 'test.draw': output 'out_normal': gpu_draw.vert + gpu_draw.frag has no such output or "
            "never writes it");
  EXPECT_EQ(error([&](const Targets& t) { drawing(t).draw().vertices(3); }),
            "pass 'test.draw', binding 'base_color': nothing was given for an image with a sampler of "
            "gpu_draw.vert + "
            "gpu_draw.frag");
  EXPECT_EQ(error([&](const Targets& t) { drawing(t).draw().sample("base_color", t.color).vertices(3); }),
            "pass 'test.draw': 'test.color' is bound as 'out_color' and as 'base_color', and one of them "
            "writes what "
            "the other touches");
  EXPECT_EQ(error([&](const Targets& t) { drawing(t).draw().sample("base_color", red).indexed(indices, 7); }),
            "pass 'test.draw': draws indices up to 7; buffer 'indices' has 6");
  EXPECT_NE(error([&](const Targets& t) {
              pass()
                  .color("out_color", t.color)
                  .color("out_id",
                         graph.create("test.small", ImageDesc{.format = VK_FORMAT_R32_UINT, .width = 4}));
            }).find("target 'test.small' is 4 x 1, 'test.color' is 16 x 16"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam::gpu
