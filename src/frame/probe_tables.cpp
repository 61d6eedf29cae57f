// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What probes need that does not change from frame to frame (SH-2).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/probes.h"
#include "math/sampling.h"

namespace gloam::frame {

namespace {

constexpr int kPoints = 4;        ///< a side of a texel, of the projection's quadrature
constexpr int kSkyPoints = 16;    ///< the same of the sky's picture
constexpr int kWidestSky = 1024;  ///< texels around of the map that it is taken from
const glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);

/// Calls visit(direction, solid angle) for points of a texel; their solid angles sum to the texel's.
template <class Visit>
void forPoints(int size, int points, int face, int row, int column, const Visit& visit) {
  const auto place = [&](int texel, int point) {
    return (float(texel) + (float(point) + 0.5f) / float(points)) / float(size);
  };
  const auto density = [](float u, float v) {
    const float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
    return 1.0f / std::pow(1.0f + a * a + b * b, 1.5f);
  };
  float sum = 0.0f;
  for (int y = 0; y < points; ++y) {
    for (int x = 0; x < points; ++x) sum += density(place(column, x), place(row, y));
  }
  const float scale = sh::cubeSolidAngle(column, row, size) / sum;
  for (int y = 0; y < points; ++y) {
    for (int x = 0; x < points; ++x) {
      const float u = place(column, x), v = place(row, y);
      visit(sh::cubeDirection(face, u, v), scale * density(u, v));
    }
  }
}

template <class Visit>
void forTexels(int size, const Visit& visit) {
  std::size_t texel = 0;
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) visit(texel++, face, row, column);
    }
  }
}

std::vector<float> projectionTable(int size) {
  std::vector<float> table(std::size_t(6 * size * size) * kProbeStride, 0.0f);
  forTexels(size, [&](std::size_t texel, int face, int row, int column) {
    float* at = &table[texel * kProbeStride];
    forPoints(size, kPoints, face, row, column, [&](const glm::vec3& d, float solid_angle) {
      const sh::Sh y = sh::evaluate(sh::kMaxOrder, d);
      for (int i = 0; i < y.size(); ++i) at[i] += solid_angle * y[i];
      at[kProbeSolidAngle] += solid_angle;
    });
  });
  return table;
}

/// The environment's map in memory, small enough to be gone through.
Environment mapInMemory(const EnvironmentLight& light) {
  const gpu::Image& map = light.picture().map();
  const EnvironmentRow& row = light.picture().row();
  int mip = 0;
  while ((map.width() >> mip) > kWidestSky && mip + 1 < map.desc().mips) ++mip;
  const std::vector<float> rgba = map.downloadFloats(mip);
  Environment environment;
  environment.width = std::max(map.width() >> mip, 1);
  environment.height = std::max(map.height() >> mip, 1);
  environment.radiance.resize(rgba.size() / 4);
  for (std::size_t i = 0; i < environment.radiance.size(); ++i)
    environment.radiance[i] = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
  environment.rotation_rad = std::atan2(row.sin_rotation, row.cos_rotation);
  environment.intensity = row.intensity;
  return environment;
}

/// A texel of the cube that holds a direction: the inverse of sh::cubeDirection.
std::size_t cubeTexel(const glm::vec3& d, int size) {
  const glm::vec3 a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
  const int face = 2 * axis + (d[axis] < 0.0f ? 1 : 0);
  const glm::vec3 p = d / a[axis];
  constexpr glm::vec2 kSigns[6] = {{-1, -1}, {1, -1}, {1, 1}, {1, -1}, {1, -1}, {-1, -1}};
  const glm::vec2 place = kSigns[face] * (axis == 0   ? glm::vec2(p.z, p.y)
                                          : axis == 1 ? glm::vec2(p.x, p.z)
                                                      : glm::vec2(p.x, p.y));
  const auto texel = [&](float x) { return std::clamp(int((0.5f * x + 0.5f) * float(size)), 0, size - 1); };
  return (std::size_t(face) * std::size_t(size) + std::size_t(texel(place.y))) * std::size_t(size) +
         std::size_t(texel(place.x));
}

/// Discs go to the texels in which points of theirs lie, with their solid angle.
void addDiscs(const std::vector<DiscRow>& discs, int size, const std::vector<float>& table,
              std::vector<glm::vec3>& texels) {
  constexpr int kRings = 24, kAround = 48;
  for (const DiscRow& disc : discs) {
    const glm::mat3 axes = sampling::frame(disc.direction);
    const float height = 1.0f - std::cos(disc.radius_rad);
    const float share = 2.0f * std::numbers::pi_v<float> * height / float(kRings * kAround);
    for (int i = 0; i < kRings * kAround; ++i) {
      const float z = 1.0f - height * (float(i / kAround) + 0.5f) / float(kRings);
      const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
      const float phi = 2.0f * std::numbers::pi_v<float> * (float(i % kAround) + 0.5f) / float(kAround);
      const std::size_t texel = cubeTexel(axes * glm::vec3(r * std::cos(phi), r * std::sin(phi), z), size);
      texels[texel] += share / table[texel * kProbeStride + kProbeSolidAngle] * disc.radiance;
    }
  }
}

}  // namespace

const gpu::Buffer& ProbeTables::projection(int size) {
  gpu::Buffer& buffer = projections_[size];
  if (!buffer) buffer = gpu::Buffer(device_, "frame.probe_table", projectionTable(size));
  return buffer;
}

const ProbeTables::Sky& ProbeTables::sky(const EnvironmentLight& environment, int size) {
  if (sky_revision_ == environment.revision() && sky_size_ == size) return sky_;
  std::vector<glm::vec3> texels(std::size_t(6 * size * size), glm::vec3(0.0f));
  ProbeSky row{};
  if (!environment.empty()) {
    const Environment map = mapInMemory(environment);
    const std::vector<float> table = projectionTable(size);
    const int points = std::clamp(kSkyPoints * 16 / size, 2, 2 * kSkyPoints);
    for (int i = 0; i < sh::kMaxCoefficients; ++i) row.remainder[i] = environment.sh()[i];
    forTexels(size, [&](std::size_t texel, int face, int y, int x) {
      float all = 0.0f;
      forPoints(size, points, face, y, x, [&](const glm::vec3& d, float solid_angle) {
        texels[texel] += solid_angle * radianceFrom(map, d);
        all += solid_angle;
      });
      texels[texel] /= all;
    });
    addDiscs(environment.picture().discs(), size, table, texels);
    forTexels(size, [&](std::size_t texel, int, int, int) {
      const float* at = &table[texel * kProbeStride];
      for (int i = 0; i < sh::kMaxCoefficients; ++i) row.remainder[i] -= at[i] * texels[texel];
      row.luminance += at[kProbeSolidAngle] * glm::dot(texels[texel], kLuminance);
    });
  }
  sky_.texels = gpu::Buffer(device_, "frame.probe_sky", texels);
  sky_.row = gpu::Buffer(device_, "frame.probe_sky_row", std::span<const ProbeSky>(&row, 1));
  sky_revision_ = environment.revision();
  sky_size_ = size;
  return sky_;
}

}  // namespace gloam::frame
