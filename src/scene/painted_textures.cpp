// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/painted_textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

std::uint8_t byteOf(float value) {
  return std::uint8_t(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

// A hash to -1..1 (the finaliser of a counter-based generator).
float lattice(int x, int y, std::uint32_t seed) {
  std::uint32_t h = std::uint32_t(x) * 0x9E3779B1u ^ std::uint32_t(y) * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  h ^= h >> 15;
  return float(h >> 8) / 8388608.0f - 1.0f;
}

int wrapped(int i, int period) {
  return ((i % period) + period) % period;
}

}  // namespace

Texture paint(const std::string& name, int width, int height,
              const std::function<glm::vec4(float u, float v)>& color) {
  Texture texture;
  texture.name = name;
  texture.width = width;
  texture.height = height;
  texture.rgba.resize(std::size_t(width) * std::size_t(height) * 4);
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      const glm::vec4 c = color((float(column) + 0.5f) / float(width), (float(row) + 0.5f) / float(height));
      std::uint8_t* texel = &texture.rgba[(std::size_t(row) * std::size_t(width) + std::size_t(column)) * 4];
      for (int k = 0; k < 4; ++k) texel[k] = byteOf(c[k]);
    }
  });
  return texture;
}

Texture paintNormals(const std::string& name, int width, int height,
                     const std::function<float(float u, float v)>& surface_height) {
  const float du = 1.0f / float(width), dv = 1.0f / float(height);
  return paint(name, width, height, [&](float u, float v) {
    const float slope_right = (surface_height(u + du, v) - surface_height(u - du, v)) / (2.0f * du);
    const float slope_up = (surface_height(u, v - dv) - surface_height(u, v + dv)) / (2.0f * dv);
    const glm::vec3 n = glm::normalize(glm::vec3(-slope_right, -slope_up, 1.0f));
    return glm::vec4(0.5f + 0.5f * n, 1.0f);
  });
}

float tilingNoise(float x, float y, int period, std::uint32_t seed) {
  const float fx = std::floor(x), fy = std::floor(y);
  const int ix = int(fx), iy = int(fy);
  const auto fade = [](float t) { return t * t * t * (t * (6.0f * t - 15.0f) + 10.0f); };
  const float tx = fade(x - fx), ty = fade(y - fy);
  const auto at = [&](int dx, int dy) {
    return lattice(wrapped(ix + dx, period), wrapped(iy + dy, period), seed);
  };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), tx), glm::mix(at(0, 1), at(1, 1), tx), ty);
}

glm::vec4 stored(const glm::vec3& linear, float alpha) {
  glm::vec4 c(0.0f, 0.0f, 0.0f, alpha);
  for (int k = 0; k < 3; ++k) {
    const float x = std::clamp(linear[k], 0.0f, 1.0f);
    c[k] = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  }
  return c;
}

float smoothStep(float a, float b, float x) {
  const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace gloam
