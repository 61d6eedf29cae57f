// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Equirectangular maps: u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2, v up; the top row is stored first.
#include "scene/environment.h"

#include <fmt/core.h>
#include <gloam/image.h>
#include <gloam/lights.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

// Only these two hold radiance; a PNG would be taken for light with its highlights cut off.
void checkKind(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char head[4] = {};
  if (!file || !file.read(head, 4)) return;  // readImage says what is wrong
  const bool exr = std::memcmp(head, "\x76\x2f\x31\x01", 4) == 0;
  if (!exr && std::memcmp(head, "#?", 2) != 0) throw Error(path, "expected an .exr or .hdr environment map");
}

glm::vec3 rgbOf(const float* pixel, int channels) {
  return channels < 3 ? glm::vec3(pixel[0]) : glm::vec3(pixel[0], pixel[1], pixel[2]);
}

Environment readEnvironment(const std::string& path) {
  checkKind(path);
  const Image image = readImage(path);
  if (const auto bad = firstNonFinite(image)) {
    throw Error(path, fmt::format("pixel ({}, {}) is {}; radiance must be finite", bad->x, bad->y,
                                  std::isnan(bad->value) ? "not a number" : "infinite"));
  }
  Environment environment;
  environment.name = path;
  environment.width = image.width;
  environment.height = image.height;
  environment.radiance.resize(image.pixelCount());
  std::size_t negative = 0;
  for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
    const glm::vec3 radiance = rgbOf(&image.pixels[i * std::size_t(image.channels)], image.channels);
    environment.radiance[i] = glm::max(radiance, glm::vec3(0.0f));
    if (environment.radiance[i] != radiance) ++negative;
  }
  if (negative > 0)
    environment.warnings.push_back(fmt::format("{}: {} negative pixels were set to 0", path, negative));
  if (image.width != 2 * image.height) {
    environment.warnings.push_back(
        fmt::format("{}: {} x {} pixels; an equirectangular map is twice as wide as high", path, image.width,
                    image.height));
  }
  return environment;
}

glm::vec3 texel(const Environment& environment, int column, int row) {
  column = ((column % environment.width) + environment.width) % environment.width;
  row = std::clamp(row, 0, environment.height - 1);
  return environment.radiance[std::size_t(row) * std::size_t(environment.width) + std::size_t(column)];
}

}  // namespace

Environment loadEnvironment(const std::string& path_or_name) {
  const std::string prefix = "sky:";
  if (path_or_name.compare(0, prefix.size(), prefix) == 0) return makeSky(path_or_name.substr(prefix.size()));
  return readEnvironment(path_or_name);
}

glm::vec3 radianceFrom(const Environment& environment, const glm::vec3& direction) {
  if (environment.empty()) return glm::vec3(0.0f);
  const glm::vec3 d = glm::normalize(direction);
  const float c = std::cos(environment.rotation_rad), s = std::sin(environment.rotation_rad);
  return environment.intensity *
         mapRadiance(environment, {c * d.x - s * d.z, d.y, s * d.x + c * d.z});  // turned back about +Y
}

glm::vec3 mapRadiance(const Environment& environment, const glm::vec3& local) {
  const float u = std::atan2(local.z, local.x) / (2.0f * kPi) + 0.5f;
  const float v = std::asin(std::clamp(local.y, -1.0f, 1.0f)) / kPi + 0.5f;
  const float x = u * float(environment.width) - 0.5f, y = (1.0f - v) * float(environment.height) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y);
  const int column = int(x0), row = int(y0);
  const glm::vec3 top =
      glm::mix(texel(environment, column, row), texel(environment, column + 1, row), x - x0);
  const glm::vec3 bottom =
      glm::mix(texel(environment, column, row + 1), texel(environment, column + 1, row + 1), x - x0);
  return glm::mix(top, bottom, y - y0);
}

glm::vec3 texelDirection(const Environment& environment, int column, int row) {
  const float phi = 2.0f * kPi * ((float(column) + 0.5f) / float(environment.width) - 0.5f);
  const float elevation = kPi * (0.5f - (float(row) + 0.5f) / float(environment.height));
  return {std::cos(elevation) * std::cos(phi), std::sin(elevation), std::cos(elevation) * std::sin(phi)};
}

sh::ShRgb projectEnvironment(const Environment& environment, int order) {
  if (environment.empty() && !environment.lights) return sh::ShRgb(order);
  sh::ShRgb light = environment.lights
                        ? sh::truncated(environment.lights->sh, order)
                        : sh::projectEquirectangular(order, environment.radiance, environment.width,
                                                     environment.height);
  light *= glm::vec3(environment.intensity);
  if (environment.rotation_rad == 0.0f) return light;
  const float c = std::cos(environment.rotation_rad), s = std::sin(environment.rotation_rad);
  return sh::rotate(glm::mat3(c, 0.0f, -s, 0.0f, 1.0f, 0.0f, s, 0.0f, c), light);
}

}  // namespace gloam
