// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/flat_points.h"

#include <cmath>

#include "math/sampling.h"
#include "trace/surface.h"
#include "trace/tracer.h"

namespace gloam {

namespace {

constexpr int kShiningPoints = 4000;  // of all that shines
constexpr int kRays = 4;              // from each point
constexpr float kClear = 1e-5f;       // of the scene's size: how far off a surface its rays begin
constexpr float kBefore = 0.05f;      // of the square root of the shining area: what lies nearer covers it

bool mayShine(const Scene& scene, const Instance& instance) {
  const int material = scene.meshes[std::size_t(instance.mesh)].material;
  return material != kNone && scene.materials[std::size_t(material)].emission != glm::vec3(0.0f);
}

}  // namespace

double areaOf(const Mesh& mesh, const glm::mat4& world_from_object) {
  double area = 0.0;
  const glm::mat3 m(world_from_object);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = m * mesh.positions[mesh.indices[i]], b = m * mesh.positions[mesh.indices[i + 1]],
                    c = m * mesh.positions[mesh.indices[i + 2]];
    area += 0.5 * double(glm::length(glm::cross(b - a, c - a)));
  }
  return area;
}

// The same additive recurrence within each stratum of the running area.
std::vector<FlatPoint> pointsOf(const Scene& scene, const Instance& instance, double area_each) {
  const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
  const float mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f ? -1.0f : 1.0f;
  std::vector<FlatPoint> points;
  double running = 0.0, next = 0.5 * area_each;
  std::uint32_t count = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    glm::vec3 p[3];
    for (std::size_t c = 0; c < 3; ++c)
      p[c] = glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[mesh.indices[3 * t + c]], 1.0f));
    const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const float size = glm::length(across);
    if (!(size > 0.0f)) continue;
    running += 0.5 * double(size);
    for (; next < running; next += area_each) {
      ++count;
      auto u = float(std::fmod(0.7548776662466927 * double(count), 1.0));
      auto v = float(std::fmod(0.5698402909980532 * double(count), 1.0));
      if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
      const trace::SurfacePoint at{int(t), u, v};
      points.push_back({(1.0f - u - v) * p[0] + u * p[1] + v * p[2], mirrored / size * across,
                        trace::reflectance(scene, mesh, at), trace::emission(scene, mesh, at),
                        float(area_each)});
    }
  }
  return points;
}

void meetSurfaces(const Scene& scene, const PosedScene& posed, const std::vector<const Instance*>& instances,
                  std::vector<std::vector<FlatPoint>>& points) {
  const trace::Tracer tracer(scene, posed, {.reproducible = true});
  PosedScene flat = posed;
  flat.instances.clear();
  for (const Instance* instance : instances) flat.instances.push_back(*instance);
  const trace::Tracer among_flat(scene, flat, {.reproducible = true});
  const float before = kClear * glm::length(posed.bounds_max - posed.bounds_min);
  std::uint32_t count = 0;
  for (std::vector<FlatPoint>& own : points) {
    for (FlatPoint& point : own) {
      const glm::mat3 world_from_local = sampling::frame(point.normal);
      int met = 0, met_flat = 0;
      float far = 0.0f;
      for (int k = 0; k < kRays; ++k) {
        ++count;
        const glm::vec2 u(std::fmod(0.7548776662466927 * double(count), 1.0),
                          std::fmod(0.5698402909980532 * double(count), 1.0));
        const glm::vec3 direction = world_from_local * sampling::cosineHemisphere(u);
        const trace::Ray ray{.origin = point.place + before * point.normal, .direction = direction};
        if (!tracer.occluded(ray)) continue;
        ++met;
        const trace::Hit hit = among_flat.closest(ray);
        if (hit.instance == kNone) continue;
        ++met_flat;
        far += hit.distance;
      }
      point.meets = float(met) / float(kRays);
      point.room = met_flat == kRays ? far / float(kRays) : 0.0f;
    }
  }
}

std::vector<std::vector<FlatPoint>> shiningPoints(const Scene& scene, const PosedScene& posed,
                                                  const std::vector<const Instance*>& instances) {
  std::vector<std::vector<FlatPoint>> shining(instances.size());
  double area = 0.0;
  for (const Instance* instance : instances) {
    if (mayShine(scene, *instance))
      area += areaOf(scene.meshes[std::size_t(instance->mesh)], instance->world_from_object);
  }
  if (!(area > 0.0)) return shining;
  const trace::Tracer tracer(scene, posed);
  const float before = kBefore * float(std::sqrt(area));
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!mayShine(scene, *instances[i])) continue;
    const auto own = int(instances[i] - posed.instances.data());
    for (FlatPoint point : pointsOf(scene, *instances[i], area / kShiningPoints)) {
      if (point.emission == glm::vec3(0.0f)) continue;
      for (int side = 0; side < 2; ++side, point.normal = -point.normal) {
        const trace::Hit hit = tracer.closest({.origin = point.place + 1e-4f * before * point.normal,
                                               .direction = point.normal,
                                               .t_near = 1e-3f * before});
        const bool inside = hit.instance == own && glm::dot(hit.geometric_normal, point.normal) > 0.0f;
        if (!inside && !(hit.distance < before)) shining[i].push_back(point);
      }
    }
  }
  return shining;
}

}  // namespace gloam
