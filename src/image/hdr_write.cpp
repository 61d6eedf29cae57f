// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Radiance RGBE with new run lengths (format: hdr_read.cpp). Mantissas are rounded, so that m * 2^(e - 136)
// is the nearest value there is.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "image/atomic_file.h"
#include "image/formats.h"

namespace gloam {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

Rgbe rgbeOf(const float* rgb) {
  float value[3];
  for (int c = 0; c < 3; ++c)
    value[c] = rgb[c] > 0.0f ? std::min(rgb[c], 1.6e38f) : 0.0f;  // also not-a-number
  const float largest = std::max({value[0], value[1], value[2]});
  if (largest < 1e-38f) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest = f * 2^exponent, 1/2 <= f < 1
  if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
  Rgbe result;
  for (int c = 0; c < 3; ++c)
    result[c] = static_cast<std::uint8_t>(std::min(255L, std::lround(std::ldexp(value[c], 8 - exponent))));
  result[3] = static_cast<std::uint8_t>(exponent + 128);
  return result;
}

// Runs of at least four equal bytes are worth a code; what lies between goes as it is.
void packChannel(const std::vector<Rgbe>& line, std::size_t channel, std::vector<std::uint8_t>& out) {
  constexpr std::size_t kMinRun = 4, kMaxRun = 127, kMaxLiteral = 128;
  const auto runAt = [&](std::size_t x) {
    std::size_t end = x + 1;
    while (end < line.size() && end - x < kMaxRun && line[end][channel] == line[x][channel]) ++end;
    return end - x;
  };
  for (std::size_t x = 0; x < line.size();) {
    const std::size_t run = runAt(x);
    if (run >= kMinRun) {
      out.push_back(static_cast<std::uint8_t>(128 + run));
      out.push_back(line[x][channel]);
      x += run;
      continue;
    }
    std::size_t end = x;
    while (end < line.size() && end - x < kMaxLiteral && runAt(end) < kMinRun) ++end;
    out.push_back(static_cast<std::uint8_t>(end - x));
    for (; x < end; ++x) out.push_back(line[x][channel]);
  }
}

}  // namespace

void writeHdr(const Image& image, const std::filesystem::path& path) {
  checkWritable(image, path);
  if (image.channels < 3) throw Error(path.string(), "HDR holds R, G, B; the picture has fewer channels");
  AtomicFile file(path);
  const std::string header =
      fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
  file.write(header.data(), header.size());
  std::vector<Rgbe> line(static_cast<std::size_t>(image.width));
  std::vector<std::uint8_t> packed;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) line[static_cast<std::size_t>(x)] = rgbeOf(image.at(x, y));
    if (image.width < 8 || image.width > 0x7fff) {
      file.write(line.data(), line.size() * sizeof(Rgbe));
      continue;
    }
    packed = {2, 2, static_cast<std::uint8_t>(image.width >> 8),
              static_cast<std::uint8_t>(image.width & 255)};
    for (std::size_t channel = 0; channel < 4; ++channel) packChannel(line, channel, packed);
    file.write(packed.data(), packed.size());
  }
  file.commit();
}

}  // namespace gloam
