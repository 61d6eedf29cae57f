// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gloam::gpu {

/// What the numbers of a format are.
enum class Numbers : std::uint8_t { kFloat, kHalf, kUnorm, kSnorm, kSrgb, kUint, kSint, kDepth, kPacked };

struct FormatInfo {
  VkFormat format = VK_FORMAT_UNDEFINED;
  const char* name = "";
  int channels = 0;
  int bytes = 0;  ///< a pixel
  Numbers numbers = Numbers::kFloat;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// The formats that this library handles; throws Error for others.
const FormatInfo& formatInfo(VkFormat format);
inline int channelCount(VkFormat format) {
  return formatInfo(format).channels;
}

/// IEEE 754 binary16, round to nearest even; overflow gives infinity.
std::uint16_t halfFromFloat(float value);
float floatFromHalf(std::uint16_t half);

/// Pixels of a format to floats, the first `channels` of each (0: all; more than there are: 0), and back, all of them.
std::vector<float> floatsFromPixels(VkFormat format, std::span<const std::byte> pixels, int channels = 0);
std::vector<std::byte> pixelsFromFloats(VkFormat format, std::span<const float> values);

}  // namespace gloam::gpu
