// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/format.h"

#include <gloam/error.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <string>

namespace gloam::gpu {
namespace {

constexpr VkImageAspectFlags kColor = VK_IMAGE_ASPECT_COLOR_BIT;
constexpr VkImageAspectFlags kDepth = VK_IMAGE_ASPECT_DEPTH_BIT;

constexpr FormatInfo kFormats[] = {
    {VK_FORMAT_R8_UNORM, "R8_UNORM", 1, 1, Numbers::kUnorm, kColor},
    {VK_FORMAT_R8G8_UNORM, "R8G8_UNORM", 2, 2, Numbers::kUnorm, kColor},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", 4, 4, Numbers::kUnorm, kColor},
    {VK_FORMAT_R8G8B8A8_SNORM, "R8G8B8A8_SNORM", 4, 4, Numbers::kSnorm, kColor},
    {VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB", 4, 4, Numbers::kSrgb, kColor},
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM", 4, 4, Numbers::kUnorm, kColor},
    {VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB", 4, 4, Numbers::kSrgb, kColor},
    {VK_FORMAT_R8_UINT, "R8_UINT", 1, 1, Numbers::kUint, kColor},
    {VK_FORMAT_R8G8B8A8_UINT, "R8G8B8A8_UINT", 4, 4, Numbers::kUint, kColor},
    {VK_FORMAT_R16_UNORM, "R16_UNORM", 1, 2, Numbers::kUnorm, kColor},
    {VK_FORMAT_R16G16_UNORM, "R16G16_UNORM", 2, 4, Numbers::kUnorm, kColor},
    {VK_FORMAT_R16G16_SNORM, "R16G16_SNORM", 2, 4, Numbers::kSnorm, kColor},
    {VK_FORMAT_R16G16B16A16_UNORM, "R16G16B16A16_UNORM", 4, 8, Numbers::kUnorm, kColor},
    {VK_FORMAT_R16G16B16A16_SNORM, "R16G16B16A16_SNORM", 4, 8, Numbers::kSnorm, kColor},
    {VK_FORMAT_R16_UINT, "R16_UINT", 1, 2, Numbers::kUint, kColor},
    {VK_FORMAT_R16G16_UINT, "R16G16_UINT", 2, 4, Numbers::kUint, kColor},
    {VK_FORMAT_R16G16B16A16_UINT, "R16G16B16A16_UINT", 4, 8, Numbers::kUint, kColor},
    {VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", 1, 2, Numbers::kHalf, kColor},
    {VK_FORMAT_R16G16_SFLOAT, "R16G16_SFLOAT", 2, 4, Numbers::kHalf, kColor},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT", 4, 8, Numbers::kHalf, kColor},
    {VK_FORMAT_R32_UINT, "R32_UINT", 1, 4, Numbers::kUint, kColor},
    {VK_FORMAT_R32G32_UINT, "R32G32_UINT", 2, 8, Numbers::kUint, kColor},
    {VK_FORMAT_R32G32B32A32_UINT, "R32G32B32A32_UINT", 4, 16, Numbers::kUint, kColor},
    {VK_FORMAT_R32_SINT, "R32_SINT", 1, 4, Numbers::kSint, kColor},
    {VK_FORMAT_R32_SFLOAT, "R32_SFLOAT", 1, 4, Numbers::kFloat, kColor},
    {VK_FORMAT_R32G32_SFLOAT, "R32G32_SFLOAT", 2, 8, Numbers::kFloat, kColor},
    {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT", 4, 16, Numbers::kFloat, kColor},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "B10G11R11_UFLOAT", 3, 4, Numbers::kPacked, kColor},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "A2B10G10R10_UNORM", 4, 4, Numbers::kPacked, kColor},
    {VK_FORMAT_D16_UNORM, "D16_UNORM", 1, 2, Numbers::kUnorm, kDepth},
    {VK_FORMAT_D32_SFLOAT, "D32_SFLOAT", 1, 4, Numbers::kFloat, kDepth},
};

bool storedBlueFirst(VkFormat format) {
  return format == VK_FORMAT_B8G8R8A8_UNORM || format == VK_FORMAT_B8G8R8A8_SRGB;
}

/// One channel of `bytes` bytes.
float readChannel(const std::byte* from, int bytes, Numbers numbers) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, static_cast<std::size_t>(bytes));  // little-endian, as Vulkan hosts are
  const float max_unsigned = bytes == 1 ? 255.0f : 65535.0f;
  switch (numbers) {
    case Numbers::kHalf:
      return floatFromHalf(static_cast<std::uint16_t>(word));
    case Numbers::kUnorm:
    case Numbers::kSrgb:
      return static_cast<float>(word) / max_unsigned;
    case Numbers::kSnorm: {
      const int value = bytes == 1 ? static_cast<std::int8_t>(word) : static_cast<std::int16_t>(word);
      return std::max(-1.0f, static_cast<float>(value) / (bytes == 1 ? 127.0f : 32767.0f));
    }
    case Numbers::kUint:
      return static_cast<float>(word);
    case Numbers::kSint:
      return static_cast<float>(static_cast<std::int32_t>(word));
    default:
      return std::bit_cast<float>(word);
  }
}

constexpr std::size_t kBlockPixels = 16;  // a number known to the compiler, which then uses vectors

float widened(std::uint16_t half) {
  // Exponent and mantissa at a float's places, times 2^112: exact, also below the normal range. No branch, so
  // that compilers vectorise loops over it.
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
  const std::uint32_t shifted = static_cast<std::uint32_t>(half & 0x7fffu) << 13;
  const auto finite = std::bit_cast<std::uint32_t>(std::bit_cast<float>(shifted) * 0x1p112f);
  const std::uint32_t infinite = shifted < 0x0f800000u ? 0u : ~0u;
  return std::bit_cast<float>(sign | (finite & ~infinite) | ((shifted | 0x7f800000u) & infinite));
}

/// kBlockPixels halves.
void widenBlock(const std::byte* from, float* to) {
  std::array<std::uint16_t, kBlockPixels> halves;
  std::memcpy(halves.data(), from, sizeof halves);
  for (std::size_t i = 0; i < kBlockPixels; ++i) to[i] = widened(halves[i]);
}

/// Pixels of any format, all its channels.
void readBlock(VkFormat format, const FormatInfo& info, const std::byte* from, std::size_t count, float* to) {
  const int channel_bytes = info.bytes / info.channels;
  for (std::size_t pixel = 0; pixel < count; ++pixel, from += info.bytes, to += info.channels) {
    if (info.numbers == Numbers::kPacked) {
      std::uint32_t word = 0;
      std::memcpy(&word, from, sizeof word);
      const bool ufloat = format == VK_FORMAT_B10G11R11_UFLOAT_PACK32;
      const glm::vec4 unpacked =
          ufloat ? glm::vec4(glm::unpackF2x11_1x10(word), 0.0f) : glm::unpackUnorm3x10_1x2(word);
      for (int c = 0; c < info.channels; ++c) to[c] = unpacked[c];
      continue;
    }
    for (int c = 0; c < info.channels; ++c)
      to[c] = readChannel(from + std::ptrdiff_t{c} * channel_bytes, channel_bytes, info.numbers);
    if (storedBlueFirst(format)) std::swap(to[0], to[2]);
  }
}

void writeChannel(std::byte* to, int bytes, Numbers numbers, float value) {
  const float max_unsigned = bytes == 1 ? 255.0f : 65535.0f;
  const auto rounded = [&](float low, float high, float scale) {
    // A NaN has no nearest integer; it becomes the least.
    return std::lround((value >= low ? std::min(value, high) : low) * scale);
  };
  std::uint32_t word = 0;
  switch (numbers) {
    case Numbers::kHalf:
      word = halfFromFloat(value);
      break;
    case Numbers::kUnorm:
    case Numbers::kSrgb:
      word = static_cast<std::uint32_t>(rounded(0.0f, 1.0f, max_unsigned));
      break;
    case Numbers::kSnorm:
      word = static_cast<std::uint32_t>(rounded(-1.0f, 1.0f, bytes == 1 ? 127.0f : 32767.0f));
      break;
    case Numbers::kUint: {
      const double top = bytes == 4 ? 4294967295.0 : max_unsigned;
      word = value > 0.0f ? static_cast<std::uint32_t>(std::min<double>(value, top)) : 0u;
      break;
    }
    case Numbers::kSint: {
      const double clamped = value >= -2147483648.0f ? std::min<double>(value, 2147483647.0) : -2147483648.0;
      word = static_cast<std::uint32_t>(static_cast<std::int32_t>(clamped));
      break;
    }
    default:
      word = std::bit_cast<std::uint32_t>(value);
      break;
  }
  std::memcpy(to, &word, static_cast<std::size_t>(bytes));
}

}  // namespace

const FormatInfo& formatInfo(VkFormat format) {
  for (const auto& info : kFormats) {
    if (info.format == format) return info;
  }
  throw Error("gpu",
              "VkFormat " + std::to_string(static_cast<int>(format)) + " is not one that gloam handles");
}

std::uint16_t halfFromFloat(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return static_cast<std::uint16_t>(sign | 0x7e00u);  // NaN stays one
  if (magnitude >= 0x477ff000u)
    return static_cast<std::uint16_t>(sign | 0x7c00u);  // 65520 and more round to infinity
  std::uint32_t half = 0;
  if (magnitude >= 0x38800000u) {  // normal: shift the mantissa, adding what rounds to nearest even
    const std::uint32_t rebased = magnitude - 0x38000000u;
    half = (rebased + 0xfffu + (rebased >> 13 & 1u)) >> 13;
  } else {  // subnormal: let the adder round, at the exponent where a half's last bit is a float's last
    const float shifted = std::bit_cast<float>(magnitude) + std::bit_cast<float>(0x3f000000u);
    half = std::bit_cast<std::uint32_t>(shifted) - 0x3f000000u;
  }
  return static_cast<std::uint16_t>(sign | half);
}

float floatFromHalf(std::uint16_t half) {
  return widened(half);
}

std::vector<float> floatsFromPixels(VkFormat format, std::span<const std::byte> pixels, int channels) {
  const FormatInfo& info = formatInfo(format);
  const std::size_t count = pixels.size() / static_cast<std::size_t>(info.bytes);
  const auto stored = static_cast<std::size_t>(info.channels);
  const auto kept = channels == 0 ? stored : static_cast<std::size_t>(channels);
  std::vector<float> values(count * kept);
  if (info.numbers == Numbers::kFloat && kept == stored) {
    std::memcpy(values.data(), pixels.data(), values.size() * sizeof(float));
    return values;
  }
  std::array<float, kBlockPixels * 4> block{};
  for (std::size_t first = 0; first < count; first += kBlockPixels) {
    const std::size_t pixels_here = std::min(kBlockPixels, count - first);
    const std::byte* from = pixels.data() + first * static_cast<std::size_t>(info.bytes);
    float* to = values.data() + first * kept;
    float* row = kept == stored && pixels_here == kBlockPixels ? to : block.data();
    if (info.numbers == Numbers::kHalf && pixels_here == kBlockPixels) {  // most of what is read back
      for (std::size_t c = 0; c < stored; ++c) widenBlock(from + 2 * c * kBlockPixels, row + c * kBlockPixels);
    } else {
      readBlock(format, info, from, pixels_here, row);
    }
    if (row == to) continue;
    for (std::size_t pixel = 0; pixel < pixels_here; ++pixel)
      std::copy_n(row + pixel * stored, std::min(kept, stored), to + pixel * kept);
  }
  return values;
}

std::vector<std::byte> pixelsFromFloats(VkFormat format, std::span<const float> values) {
  const FormatInfo& info = formatInfo(format);
  const std::size_t count = values.size() / static_cast<std::size_t>(info.channels);
  std::vector<std::byte> pixels(count * static_cast<std::size_t>(info.bytes));
  const int channel_bytes = info.bytes / info.channels;
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const float* from = values.data() + pixel * static_cast<std::size_t>(info.channels);
    std::byte* to = pixels.data() + pixel * static_cast<std::size_t>(info.bytes);
    if (info.numbers == Numbers::kPacked) {
      const std::uint32_t word = format == VK_FORMAT_B10G11R11_UFLOAT_PACK32
                                     ? glm::packF2x11_1x10(glm::vec3(from[0], from[1], from[2]))
                                     : glm::packUnorm3x10_1x2(glm::vec4(from[0], from[1], from[2], from[3]));
      std::memcpy(to, &word, sizeof word);
      continue;
    }
    for (int c = 0; c < info.channels; ++c) {
      const int source = storedBlueFirst(format) && c != 3 ? 2 - c : c;
      writeChannel(to + std::ptrdiff_t{c} * channel_bytes, channel_bytes, info.numbers, from[source]);
    }
  }
  return pixels;
}

}  // namespace gloam::gpu
