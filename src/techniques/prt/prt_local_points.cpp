// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4: "we sample the lighting dynamically and sparsely near the surface". Points: Lloyd's
// k-means over the surface moved outward, begun from farthest points (Gonzalez 1985).
#include "techniques/prt/prt_local_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/transforms.h"

namespace gloam::prt {

namespace {

constexpr float kPush = 0.05f;  ///< of the surface's extent
constexpr int kRounds = 24;

float squared(const glm::vec3& v) {
  return glm::dot(v, v);
}

glm::vec3 meanOf(std::span<const glm::vec3> points) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& p : points) sum += glm::dvec3(p);
  return glm::vec3(sum / double(points.size()));
}

std::size_t nearest(std::span<const glm::vec3> points, const glm::vec3& to) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (squared(points[i] - to) < squared(points[best] - to)) best = i;
  }
  return best;
}

/// Seeds as far from one another as can be, the first as far as can be from the middle.
std::vector<glm::vec3> farthestPoints(std::span<const glm::vec3> points, int count) {
  const glm::vec3 middle = meanOf(points);
  std::vector<float> distance(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distance[i] = squared(points[i] - middle);
  std::vector<glm::vec3> seeds;
  for (int k = 0; k < count; ++k) {
    const auto farthest = std::size_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
    seeds.push_back(points[farthest]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float to_seed = squared(points[i] - seeds.back());
      distance[i] = k == 0 ? to_seed : std::min(distance[i], to_seed);
    }
  }
  return seeds;
}

}  // namespace

void SurfaceSampler::add(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                         std::span<const std::uint32_t> indices, const glm::mat4& placed) {
  const glm::mat3 normal_matrix = normalTransform(glm::mat3(placed));
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    Triangle triangle{};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = indices[t + std::size_t(k)];
      triangle.corner[k] = glm::vec3(placed * glm::vec4(positions[v], 1.0f));
      triangle.normal += normal_matrix * normals[v];
    }
    const float length = glm::length(triangle.normal);
    if (length > 0.0f) triangle.normal /= length;
    const glm::vec3 e1 = triangle.corner[1] - triangle.corner[0],
                    e2 = triangle.corner[2] - triangle.corner[0];
    area_ += 0.5 * double(glm::length(glm::cross(e1, e2)));
    triangle.area_until = area_;
    triangles_.push_back(triangle);
  }
}

SurfacePoints SurfaceSampler::points(int count) const {
  SurfacePoints result;
  if (!(area_ > 0.0)) return result;
  std::size_t at = 0;
  for (int i = 0; i < count; ++i) {
    const double area = area_ * (double(i) + 0.5) / double(count);
    while (at + 1 < triangles_.size() && triangles_[at].area_until < area) ++at;
    // Places within triangles by the R2 sequence (Roberts 2018), folded over the diagonal.
    double u = std::fmod(0.7548776662466927 * (i + 1), 1.0), v = std::fmod(0.5698402909980532 * (i + 1), 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Triangle& t = triangles_[at];
    result.positions.push_back(float(1.0 - u - v) * t.corner[0] + float(u) * t.corner[1] +
                               float(v) * t.corner[2]);
    result.normals.push_back(t.normal);
  }
  return result;
}

std::vector<glm::vec3> pickPoints(const SurfacePoints& surface, int count) {
  if (surface.positions.empty())
    return std::vector<glm::vec3>(std::size_t(std::max(count, 1)), glm::vec3(0.0f));
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& p : surface.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<glm::vec3> outside;
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    outside.push_back(surface.positions[i] + kPush * glm::length(high - low) * surface.normals[i]);
  if (count <= 1) return {meanOf(outside)};

  std::vector<glm::vec3> centres = farthestPoints(outside, count);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<glm::dvec3> sums(centres.size(), glm::dvec3(0.0));
    std::vector<double> counts(centres.size(), 0.0);
    for (const glm::vec3& p : outside) {
      const std::size_t k = nearest(centres, p);
      sums[k] += glm::dvec3(p);
      counts[k] += 1.0;
    }
    for (std::size_t k = 0; k < centres.size(); ++k) {
      if (counts[k] > 0.0) centres[k] = glm::vec3(sums[k] / counts[k]);
    }
  }
  for (glm::vec3& centre : centres) centre = outside[nearest(outside, centre)];
  return centres;
}

}  // namespace gloam::prt
