// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Mean projected areas by lines (Cauchy, Crofton): of lines spread evenly over all that meet a ball, the share that meets a body
// within is the body's mean projected area over that of the ball.
#include "renderer/shadow_radii.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "renderer/set_surface.h"
#include "trace/tracer.h"

namespace gloam {

namespace {

constexpr std::uint32_t kLinesASphere = 512, kLines = 16384;
constexpr float kLeastShare = 0.3f;  // of a radius

struct Line {
  glm::vec3 middle, direction;  // direction: unit; the middle is the point nearest to the ball's centre
};

/// The i-th line through a ball, by an additive recurrence in four dimensions: powers of the root of x^5 = x + 1.
Line lineThrough(const Sphere& ball, std::uint32_t i) {
  const auto coordinate = [i](double step) { return float(std::fmod(0.5 + step * double(i + 1), 1.0)); };
  const glm::vec3 way =
      sampling::uniformSphere({coordinate(0.8566748838545029), coordinate(0.7338918566271260)});
  const glm::vec2 u(coordinate(0.6287067210378087), coordinate(0.5385972572236101));
  const glm::vec3 side =
      glm::normalize(glm::cross(way, std::abs(way.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const float angle = 6.28318531f * u.x, distance = ball.radius * std::sqrt(u.y);
  return {ball.center + distance * (std::cos(angle) * side + std::sin(angle) * glm::cross(way, side)), way};
}

/// The object alone, in shape space.
trace::Tracer tracerOf(const Scene& scene, const SphereSet& set) {
  PosedScene posed;
  for (const int mesh : set.meshes) {
    Instance instance;
    instance.mesh = mesh;
    instance.node = set.nodes.empty() ? kNone : set.nodes.front();
    instance.world_from_object = glm::mat4(set.shape_from_object);
    posed.instances.push_back(std::move(instance));
  }
  return {scene, posed};
}

/// Whether the object is met on the chord of a line through a sphere: a face within, or one beyond that is seen from behind, so
/// that all of the chord lies inside.
bool meetsWithin(const trace::Tracer& tracer, const Sphere& sphere, const Line& line, float outward) {
  const glm::vec3 to = line.middle - sphere.center;
  const float half = std::sqrt(std::max(0.0f, sphere.radius * sphere.radius - glm::dot(to, to)));
  const trace::Hit hit = tracer.closest({line.middle - half * line.direction, line.direction});
  if (!hit) return false;
  return hit.distance <= 2.0f * half || outward * glm::dot(hit.geometric_normal, line.direction) > 0.0f;
}

/// The factor at which the spheres' union meets as many of the lines through `all` as the object does.
float commonFactor(const trace::Tracer& tracer, const std::vector<Sphere>& spheres, const Sphere& all) {
  std::vector<float> factors(kLines);  // of each line: at which the first sphere meets it
  std::vector<char> met(kLines);
  tbb::parallel_for(std::uint32_t(0), kLines, [&](std::uint32_t i) {
    const Line line = lineThrough(all, i);
    float least = INFINITY;
    for (const Sphere& sphere : spheres) {
      const glm::vec3 to = sphere.center - line.middle;
      const float along = glm::dot(to, line.direction);
      least = std::min(least, std::sqrt(std::max(0.0f, glm::dot(to, to) - along * along)) / sphere.radius);
    }
    factors[i] = least;
    met[i] = tracer.occluded({line.middle - 2.0f * all.radius * line.direction, line.direction}) ? 1 : 0;
  });
  const auto count = std::count(met.begin(), met.end(), char(1));
  if (count == 0 || count == std::ptrdiff_t(kLines)) return 1.0f;
  std::nth_element(factors.begin(), factors.begin() + count, factors.end());
  return factors[std::size_t(count)];
}

}  // namespace

std::vector<float> shadowShares(const Scene& scene, const SphereSet& set) {
  if (set.spheres.empty()) return {};
  const trace::Tracer tracer = tracerOf(scene, set);
  const float outward = facing(scene, set);
  std::vector<float> shares(set.spheres.size());
  std::vector<Sphere> drawn_in = set.spheres;
  tbb::parallel_for(std::size_t(0), shares.size(), [&](std::size_t s) {
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < kLinesASphere; ++i) {
      const Line line = lineThrough(set.spheres[s], i);
      met += meetsWithin(tracer, set.spheres[s], line, outward) ? 1u : 0u;
    }
    shares[s] = std::max(kLeastShare, std::sqrt(float(met) / float(kLinesASphere)));
    drawn_in[s].radius *= shares[s];
  });
  Sphere all = set.spheres.front();
  for (const Sphere& sphere : set.spheres) all = boundingSphere(all, sphere);
  const float factor = commonFactor(tracer, drawn_in, all);
  for (float& share : shares) share = std::clamp(share * factor, kLeastShare, 1.0f);
  return shares;
}

}  // namespace gloam
