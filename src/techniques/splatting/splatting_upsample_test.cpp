// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The three laws of upsampling (row MS-6) on levels made by hand, whose neighbours differ by any number of levels; and its slow
// twin.
#include <gtest/gtest.h>

#include <bit>
#include <deque>
#include <functional>
#include <random>

#include "frame/view.h"
#include "gpu/test_device.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {
namespace {

constexpr int kLevels = 6;

struct Buffer {
  int width = 0, height = 0;
  std::vector<glm::vec4> light;  ///< A: 0 empty
};
using Buffers = std::vector<Buffer>;

/// Leaves of a random tree over a picture; some of its texels show nothing. Values by `value`(x, y, level).
Buffers randomTree(int width, int height, unsigned seed, const std::function<float(int, int, int)>& value) {
  std::mt19937 random(seed);
  Buffers levels;
  for (int k = 0; k < kLevels; ++k) {
    Buffer level{(width + (1 << k) - 1) >> k, (height + (1 << k) - 1) >> k, {}};
    level.light.resize(std::size_t(level.width) * std::size_t(level.height), glm::vec4(0.0f));
    levels.push_back(level);
  }
  const std::function<void(int, int, int)> grow = [&](int x, int y, int k) {
    Buffer& level = levels[std::size_t(k)];
    if (x >= level.width || y >= level.height) return;
    const auto dice = random() % 8;
    if (k == 0 || dice < 3) {
      if (dice != 1)
        level.light[std::size_t(y) * std::size_t(level.width) + std::size_t(x)] =
            glm::vec4(glm::vec3(value(x, y, k)), 1.0f);
      return;
    }
    for (int i = 0; i < 4; ++i) grow(2 * x + i % 2, 2 * y + i / 2, k - 1);
  };
  const Buffer coarsest = levels.back();
  for (int y = 0; y < coarsest.height; ++y) {
    for (int x = 0; x < coarsest.width; ++x) grow(x, y, kLevels - 1);
  }
  return levels;
}

/// Row MS-6 in plain words.
std::vector<glm::vec4> twin(const Buffers& levels) {
  std::vector<glm::vec4> coarse;
  for (int k = kLevels - 1; k >= 0; --k) {
    const Buffer& level = levels[std::size_t(k)];
    std::vector<glm::vec4> result = level.light;
    for (int y = 0; y < level.height && k + 1 < kLevels; ++y) {
      for (int x = 0; x < level.width; ++x) {
        glm::vec4& own = result[std::size_t(y) * std::size_t(level.width) + std::size_t(x)];
        if (own.a > 0.0f) continue;
        const Buffer& parents = levels[std::size_t(k + 1)];
        const auto at = [&](int px, int py) {
          return px < 0 || py < 0 || px >= parents.width || py >= parents.height
                     ? glm::vec4(0.0f)
                     : coarse[std::size_t(py) * std::size_t(parents.width) + std::size_t(px)];
        };
        const int sx = x % 2 ? 1 : -1, sy = y % 2 ? 1 : -1;
        if (at(x / 2, y / 2).a <= 0.0f) continue;
        glm::vec4 sum = 9.0f * at(x / 2, y / 2) + 3.0f * at(x / 2 + sx, y / 2) +
                        3.0f * at(x / 2, y / 2 + sy) + at(x / 2 + sx, y / 2 + sy);
        own = glm::vec4(glm::vec3(sum) / sum.a, 1.0f);
      }
    }
    coarse = result;
  }
  return coarse;
}

/// On the device; no surface ends anywhere.
std::vector<glm::vec4> upsampled(const Buffers& buffers) {
  gpu::Device& device = gpu::testDevice();
  gpu::FrameGraph graph(device);
  std::deque<gpu::Image> images;
  std::vector<Level> levels;
  const auto image = [&](VkFormat format, const Buffer& buffer) -> gpu::Image& {
    return images.emplace_back(
        device, "test", gpu::ImageDesc{.format = format, .width = buffer.width, .height = buffer.height});
  };
  // One normal (512, 512, 1023) in ten bits each, and one depth.
  const glm::uvec4 flat(0x3ff80200u, 0x3ff80200u, std::bit_cast<std::uint32_t>(1.0f),
                        std::bit_cast<std::uint32_t>(1.0f));
  for (const Buffer& buffer : buffers) {
    gpu::Image& light = image(VK_FORMAT_R32G32B32A32_SFLOAT, buffer);
    light.upload(buffer.light);
    gpu::Image& ranges = image(VK_FORMAT_R32G32B32A32_UINT, buffer);
    ranges.upload(std::vector<glm::uvec4>(buffer.light.size(), flat));
    levels.push_back({.width = buffer.width, .height = buffer.height, .ranges = ranges, .light = light});
  }
  gpu::Image normals(
      device, "normals",
      gpu::ImageDesc{
          .format = VK_FORMAT_R32G32_UINT, .width = buffers[0].width, .height = buffers[0].height});
  normals.upload(std::vector<glm::uvec2>(buffers[0].light.size(), glm::uvec2(0u)));
  graph.begin();
  const gpu::ImageRef result = recordUpsampling(graph, levels, {0.2f, 0.1f}, Upsampling::kSurfaces, 0.0f,
                                                graph.uploadOne("view", frame::FrameView{}), normals);
  graph.execute();
  graph.wait();
  return result.image().download<glm::vec4>();
}

constexpr std::pair<int, int> kSizes[] = {{64, 64}, {53, 37}, {129, 40}};

TEST(SplattingUpsampling, ConstantsStayAndEmptyStaysEmpty) {
  for (const auto& [width, height] : kSizes) {
    for (unsigned seed = 0; seed < 3; ++seed) {
      const Buffers levels = randomTree(width, height, seed, [](int, int, int) { return 3.7f; });
      const std::vector<glm::vec4> pixels = upsampled(levels);
      std::size_t lit = 0;
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          bool has_light = false;  // at its place, of any level
          for (int k = 0; k < kLevels; ++k)
            has_light |= levels[std::size_t(k)]
                             .light[std::size_t(y >> k) * std::size_t(levels[std::size_t(k)].width) +
                                    std::size_t(x >> k)]
                             .a > 0.0f;
          const glm::vec4 got = pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
          ASSERT_NEAR(got.x, has_light ? 3.7f : 0.0f, has_light ? 3.7e-5f : 0.0f) << x << ' ' << y;
          ASSERT_EQ(got.a > 0.0f, has_light);
          lit += has_light;
        }
      }
      EXPECT_GT(lit, pixels.size() / 4);
      EXPECT_LT(lit, pixels.size());
    }
  }
}

TEST(SplattingUpsampling, ValuesStayBetweenTheirSourcesAndAreThoseOfTheTwin) {
  for (const auto& [width, height] : kSizes) {
    std::mt19937 random(7);
    const Buffers levels =
        randomTree(width, height, 11, [&](int, int, int) { return 0.5f + float(random() % 1000) / 1000.0f; });
    const std::vector<glm::vec4> pixels = upsampled(levels), want = twin(levels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(pixels[i][c], want[i][c], 1e-5f) << i;
      if (want[i].a > 0.0f) {
        ASSERT_GE(pixels[i].x, 0.5f);
        ASSERT_LE(pixels[i].x, 1.5f);
      }
    }
  }
}

// A ramp is no staircase: bilinear interpolation of whole levels keeps it, away from their borders.
TEST(SplattingUpsampling, RampsAreKept) {
  Buffers levels = randomTree(64, 64, 1, [](int, int, int) { return 0.0f; });
  for (Buffer& level : levels) std::ranges::fill(level.light, glm::vec4(0.0f));
  Buffer& coarse = levels[2];
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x)
      coarse.light[std::size_t(y * coarse.width + x)] = glm::vec4(glm::vec3(4.0f * float(x) + 1.5f), 1.0f);
  }
  const std::vector<glm::vec4> pixels = upsampled(levels);
  for (int x = 6; x < 58; ++x) EXPECT_NEAR(pixels[std::size_t(30 * 64 + x)].x, float(x), 1e-4f);
}

}  // namespace
}  // namespace gloam::splatting
