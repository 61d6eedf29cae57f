// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A cloud over a plain: balls that flow into one another, frayed by noise, cut flat below as clouds are.
#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "scene/scene_builder.h"
#include "scene/volume_files.h"

namespace gloam {
namespace {

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

float latticeValue(const glm::ivec3& p) {
  const glm::uvec4 bits = sampling::pcg4d({std::uint32_t(p.x), std::uint32_t(p.y), std::uint32_t(p.z), 5u});
  return sampling::toUnitFloat(bits.x);
}

/// Smooth noise in 0 to 1: random values at whole numbers, interpolated.
float noise(const glm::vec3& p) {
  const glm::vec3 low = glm::floor(p), f = p - low, s = f * f * (3.0f - 2.0f * f);
  float sum = 0.0f;
  for (int c = 0; c < 8; ++c) {
    const glm::ivec3 corner(c & 1, c >> 1 & 1, c >> 2);
    const glm::vec3 w = glm::mix(1.0f - s, s, glm::vec3(corner));
    sum += w.x * w.y * w.z * latticeValue(glm::ivec3(low) + corner);
  }
  return sum;
}

float turbulence(glm::vec3 p) {
  float sum = 0.0f, weight = 0.5f;
  for (int octave = 0; octave < 4; ++octave) {
    sum += weight * noise(p);
    p = 2.03f * p + glm::vec3(17.1f, 5.3f, 31.7f);
    weight *= 0.5f;
  }
  return sum / (1.0f - 2.0f * weight);
}

/// Share of the full density at a place of the box 2.4 x 1.5 x 1.8 about the origin.
float cloudAt(const glm::vec3& p) {
  struct Ball {
    glm::vec3 center;
    float radius;
  };
  static constexpr Ball kBalls[] = {
      {{-0.62f, -0.28f, 0.05f}, 0.40f}, {{-0.22f, -0.06f, -0.10f}, 0.52f}, {{0.22f, 0.10f, 0.06f}, 0.52f},
      {{0.64f, -0.22f, -0.02f}, 0.42f}, {{0.05f, -0.28f, 0.42f}, 0.40f},   {{-0.05f, 0.36f, -0.04f}, 0.32f},
      {{0.38f, -0.30f, -0.42f}, 0.34f}, {{-0.42f, -0.32f, -0.42f}, 0.32f}, {{0.80f, -0.38f, 0.14f}, 0.24f},
  };
  float empty = 1.0f;  // a smooth union
  for (const Ball& b : kBalls) empty *= 1.0f - smoothstep(1.25f, 0.2f, glm::length(p - b.center) / b.radius);
  const float ball = smoothstep(0.0f, 0.15f, 1.0f - empty);  // no tatters far from any
  const float frayed = 1.0f - empty + 1.25f * ball * (turbulence(4.2f * p + 9.0f) - 0.56f);
  const float rim = smoothstep(0.0f, 0.12f, 0.72f - std::abs(p.y)) *
                    smoothstep(0.0f, 0.1f, 1.15f - std::abs(p.x)) *
                    smoothstep(0.0f, 0.1f, 0.85f - std::abs(p.z));
  return smoothstep(0.30f, 0.75f, frayed) * smoothstep(-0.62f, -0.44f, p.y) * rim;
}

}  // namespace

Scene makeCloud(const Detail& detail, NamedValues& values) {
  const float density = float(values.take("density", 22, 0, 1000));
  const float albedo = float(values.take("albedo", 0.995, 0, 1));
  Volume volume;
  volume.name = "cloud";
  volume.asymmetry = float(values.take("g", 0.6, -0.95, 0.95));
  volume.albedo = glm::vec3(albedo);
  volume.bounds_min = {-1.2f, -0.75f, -0.9f};
  volume.bounds_max = {1.2f, 0.75f, 0.9f};
  const float factor = std::min(detail.factor, 4.0f);
  volume.size = glm::max(glm::ivec3(factor * glm::vec3(64, 40, 48)), glm::ivec3(4));
  const glm::vec3 cell = (volume.bounds_max - volume.bounds_min) / glm::vec3(volume.size);
  volume.density.reserve(volume.voxels());
  for (int z = 0; z < volume.size.z; ++z)
    for (int y = 0; y < volume.size.y; ++y)
      for (int x = 0; x < volume.size.x; ++x)
        volume.density.push_back(density * cloudAt(volume.bounds_min + (glm::vec3(x, y, z) + 0.5f) * cell));
  return volumeScene("cloud", std::move(volume), 0.5f, detail.cell(0.05f));
}

}  // namespace gloam
