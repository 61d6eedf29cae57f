// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/format.h"

#include <gloam/error.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace gloam::gpu {
namespace {

TEST(Half, EveryHalfSurvivesTheRoundTrip) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = floatFromHalf(half);
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(floatFromHalf(halfFromFloat(value)))) << bits;
    } else {
      EXPECT_EQ(halfFromFloat(value), half) << bits << " is " << value;
    }
  }
}

TEST(Half, KnownValues) {
  EXPECT_EQ(floatFromHalf(0x3c00), 1.0f);
  EXPECT_EQ(floatFromHalf(0xc000), -2.0f);
  EXPECT_EQ(floatFromHalf(0x7bff), 65504.0f);
  EXPECT_EQ(floatFromHalf(0x0001), 0x1p-24f);
  EXPECT_EQ(floatFromHalf(0x7c00), std::numeric_limits<float>::infinity());
}

/// The slow twin: the nearest of all halves, of two equally near ones the even.
std::uint16_t nearestHalf(float value) {
  std::uint16_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::uint32_t bits = 0; bits < 0x7c00; ++bits) {
    const double distance =
        std::abs(static_cast<double>(floatFromHalf(static_cast<std::uint16_t>(bits))) - value);
    if (distance < best_distance || (distance == best_distance && (bits & 1u) == 0)) {
      best = static_cast<std::uint16_t>(bits);
      best_distance = distance;
    }
  }
  return best;
}

TEST(Half, RoundsToNearestEven) {
  for (const std::uint16_t bits : {0x0000, 0x0001, 0x0002, 0x03ff, 0x0400, 0x3bff, 0x3c00, 0x3c01, 0x7bfe}) {
    const float a = floatFromHalf(bits);
    const float b = floatFromHalf(static_cast<std::uint16_t>(bits + 1));
    const float middle = 0.5f * (a + b);
    for (const float value : {middle, std::nextafter(middle, a), std::nextafter(middle, b), a, b}) {
      EXPECT_EQ(halfFromFloat(value), nearestHalf(value)) << value;
      EXPECT_EQ(halfFromFloat(-value), nearestHalf(value) | 0x8000) << -value;
    }
  }
}

TEST(Half, OverflowGivesInfinityFromHalfwayOn) {
  EXPECT_EQ(halfFromFloat(std::nextafter(65520.0f, 0.0f)), 0x7bff);
  EXPECT_EQ(halfFromFloat(65520.0f), 0x7c00);
  EXPECT_EQ(halfFromFloat(-1e30f), 0xfc00);
}

TEST(Format, PixelsRoundTripThroughFloats) {
  const std::vector<float> values{0.0f, 0.25f, 0.5f, 1.0f, 1.0f, 0.75f, 0.125f, 0.0f};
  struct Case {
    VkFormat format;
    float tolerance;
  };
  for (const auto& [format, tolerance] :
       {Case{VK_FORMAT_R8G8B8A8_UNORM, 0.51f / 255}, Case{VK_FORMAT_B8G8R8A8_UNORM, 0.51f / 255},
        Case{VK_FORMAT_R8G8B8A8_SNORM, 0.51f / 127}, Case{VK_FORMAT_R16G16B16A16_UNORM, 0.51f / 65535},
        Case{VK_FORMAT_R16G16B16A16_SFLOAT, 0.0f}, Case{VK_FORMAT_R32G32B32A32_SFLOAT, 0.0f},
        Case{VK_FORMAT_R32_SFLOAT, 0.0f}, Case{VK_FORMAT_D32_SFLOAT, 0.0f}}) {
    const auto pixels = pixelsFromFloats(format, values);
    const FormatInfo& info = formatInfo(format);
    EXPECT_EQ(pixels.size() * static_cast<std::size_t>(info.channels),
              values.size() * static_cast<std::size_t>(info.bytes));
    const auto back = floatsFromPixels(format, pixels);
    ASSERT_EQ(back.size(), values.size()) << info.name;
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(back[i], values[i], tolerance) << info.name << " " << i;
  }
}

TEST(Format, BlueFirstFormatsKeepTheirOrderInMemory) {
  const std::vector<float> red{1.0f, 0.0f, 0.0f, 0.0f};
  EXPECT_EQ(pixelsFromFloats(VK_FORMAT_B8G8R8A8_UNORM, red)[2], std::byte{255});
  EXPECT_EQ(pixelsFromFloats(VK_FORMAT_R8G8B8A8_UNORM, red)[0], std::byte{255});
}

TEST(Format, OutOfRangeAndNanAreClamped) {
  const std::vector<float> values{-3.0f, 7.0f, std::nanf(""), 0.5f};
  const auto pixels = pixelsFromFloats(VK_FORMAT_R8G8B8A8_UNORM, values);
  EXPECT_EQ(pixels[0], std::byte{0});
  EXPECT_EQ(pixels[1], std::byte{255});
  EXPECT_EQ(pixels[2], std::byte{0});
  EXPECT_EQ(pixels[3], std::byte{128});
  EXPECT_EQ(pixelsFromFloats(VK_FORMAT_R32_UINT, std::vector<float>{std::nanf("")})[0], std::byte{0});
}

TEST(Format, UnknownOnesAreNamed) {
  EXPECT_THROW(formatInfo(VK_FORMAT_BC1_RGB_UNORM_BLOCK), Error);
}

}  // namespace
}  // namespace gloam::gpu
