// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_pack.h"

#include <scene/half_float.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

namespace gloam::cli {
namespace {

constexpr int kEffort = 6;  // zlib: beyond, twice the time for a hundredth of the size

std::string deflated(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), uLong(bytes.size()), kEffort) != Z_OK) {
    throw std::bad_alloc();
  }
  return base64(packed.data(), size);
}

/// What stands before a value: its left neighbour, or the one above at the beginning of a row.
template <class T>
T before(const std::vector<T>& plane, std::size_t i, std::size_t width) {
  if (i % width != 0) return plane[i - 1];
  return i == 0 ? T(0) : plane[i - width];
}

}  // namespace

std::string base64(const void* bytes, std::size_t size) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* at = static_cast<const std::uint8_t*>(bytes);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < size ? at[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= size ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string packedHalves(const Image& picture) {
  const std::size_t count = picture.pixelCount(), width = std::size_t(picture.width);
  const std::size_t channels = std::size_t(picture.channels);
  std::vector<std::uint8_t> bytes(3 * 2 * count);
  std::vector<std::uint16_t> plane(count);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < count; ++i) plane[i] = halfFromFloat(picture.pixels[i * channels + c]);
    for (std::size_t i = 0; i < count; ++i) {
      const auto step = std::uint16_t(plane[i] - before(plane, i, width));
      bytes[2 * c * count + i] = std::uint8_t(step >> 8);
      bytes[2 * c * count + count + i] = std::uint8_t(step);
    }
  }
  return deflated(bytes);
}

std::string packedBytes(const Image& map) {
  const std::size_t count = map.pixelCount(), channels = std::size_t(map.channels);
  std::vector<std::uint8_t> plane(count), bytes(count);
  for (std::size_t i = 0; i < count; ++i) {
    plane[i] = std::uint8_t(std::lround(255.0f * std::clamp(map.pixels[i * channels], 0.0f, 1.0f)));
    bytes[i] = std::uint8_t(plane[i] - before(plane, i, std::size_t(map.width)));
  }
  return deflated(bytes);
}

Image shrunk(const Image& picture, int factor) {
  if (factor == 1) return picture;
  Image small(picture.width / factor, picture.height / factor, picture.channels);
  const float share = 1.0f / float(factor * factor);
  for (int y = 0; y < small.height * factor; ++y) {
    for (int x = 0; x < small.width * factor; ++x) {
      for (int c = 0; c < picture.channels; ++c) {
        small.at(x / factor, y / factor)[c] += picture.at(x, y)[c] * share;
      }
    }
  }
  return small;
}

}  // namespace gloam::cli
