// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pairs of pictures for tests of measures, made of exact arithmetic, so that another program can make them too.
#pragma once

#include <gloam/image.h>

#include <cmath>
#include <cstdint>

namespace gloam::test {

/// Tiles of colours with noise, 0 to 1; `variant` 1 is the same picture with other noise, a moved edge and a dot.
inline Image displayPicture(int width, int height, int variant) {
  Image image(width, height, 3);
  std::uint32_t state = 1u + std::uint32_t(variant) * 977u;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        state = state * 1664525u + 1013904223u;
        const float noise = float(state >> 24) / 1024.0f;
        const int tile = ((x + 2 * variant * (y / 16)) / 8 * 5 + y / 8 * 3 + c * 2) % 7;
        const bool dot = variant == 1 && x == width / 2 && y == height / 2;
        image.at(x, y)[c] = dot ? 1.0f : float(tile) / 10.0f + noise * (c == 1 ? 1.0f : 0.5f);
      }
  return image;
}

/// The same over ten powers of two.
inline Image radiancePicture(int width, int height, int variant) {
  Image image = displayPicture(width, height, variant);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = std::ldexp(image.at(x, y)[c], (x / 8 + y / 4) % 11 - 5);
  return image;
}

inline Image constantPicture(int width, int height, float r, float g, float b) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixelCount(); ++i)
    image.pixels[3 * i] = r, image.pixels[3 * i + 1] = g, image.pixels[3 * i + 2] = b;
  return image;
}

}  // namespace gloam::test
