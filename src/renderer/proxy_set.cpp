// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-9: every proxy has the albedo of the surface that it stands for, the mean over points spread evenly by area, and is drawn in
// until it shadows as much as that does.
#include "renderer/proxy_set.h"

#include <algorithm>
#include <cmath>

#include "renderer/shadow_radii.h"
#include "trace/surface.h"

namespace gloam {

namespace {

constexpr std::size_t kPointsASphere = 256, kFewestPoints = 1024;

/// Only nodes' meshes, and the meshes that deform: all that poseSpheres reads.
Scene withoutPictures(const Scene& scene, const SceneSpheres& spheres) {
  Scene kept;
  kept.nodes.resize(scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) kept.nodes[n].meshes = scene.nodes[n].meshes;
  kept.meshes.resize(scene.meshes.size());
  for (const SphereSet& set : spheres.sets) {
    if (!set.deforms) continue;
    for (const int mesh : set.meshes) {
      if (mesh < 0 || std::size_t(mesh) >= scene.meshes.size())
        throw Error("sphere sets", "belong to another scene");
      kept.meshes[std::size_t(mesh)].positions = scene.meshes[std::size_t(mesh)].positions;
    }
  }
  return kept;
}

struct AreaPoint {
  int mesh;
  trace::SurfacePoint point;
};

/// Spread evenly by area over all meshes of a set: strata of the running area, two more coordinates of an additive
/// recurrence.
std::vector<AreaPoint> pointsByArea(const Scene& scene, const SphereSet& set, std::size_t count) {
  struct Triangle {
    int mesh;
    int index;
    double end;
  };
  std::vector<Triangle> triangles;
  double total = 0.0;
  for (const int m : set.meshes) {
    const Mesh& mesh = scene.meshes.at(std::size_t(m));
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const glm::vec3 a = mesh.positions[mesh.indices[3 * t]], b = mesh.positions[mesh.indices[3 * t + 1]],
                      c = mesh.positions[mesh.indices[3 * t + 2]];
      total += double(glm::length(glm::cross(b - a, c - a)));
      triangles.push_back({m, int(t), total});
    }
  }
  std::vector<AreaPoint> points;
  if (!(total > 0.0) || !std::isfinite(total)) return points;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = total * (double(i) + 0.5) / double(count);
    while (at + 1 < triangles.size() && triangles[at].end < place) ++at;
    auto u = float(std::fmod(0.7548776662466927 * double(i + 1), 1.0));
    auto v = float(std::fmod(0.5698402909980532 * double(i + 1), 1.0));
    if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
    points.push_back({triangles[at].mesh, {triangles[at].index, u, v}});
  }
  return points;
}

}  // namespace

std::vector<glm::vec3> sphereAlbedos(const Scene& scene, const SphereSet& set) {
  std::vector<glm::vec3> sums(set.spheres.size(), glm::vec3(0.0f));
  std::vector<float> counts(set.spheres.size(), 0.0f);
  glm::vec3 all(0.0f);
  const std::size_t count = std::max(kFewestPoints, kPointsASphere * set.spheres.size());
  const std::vector<AreaPoint> points =
      set.spheres.empty() ? std::vector<AreaPoint>{} : pointsByArea(scene, set, count);
  for (const AreaPoint& at : points) {
    const Mesh& mesh = scene.meshes[std::size_t(at.mesh)];
    const glm::vec3 place = set.shape_from_object * trace::interpolate(mesh, mesh.positions, at.point);
    const glm::vec3 albedo = trace::diffuseAlbedo(scene, mesh, at.point);
    std::size_t nearest = 0;
    float least = INFINITY;
    for (std::size_t s = 0; s < set.spheres.size(); ++s) {
      const float distance = glm::distance(place, set.spheres[s].center) / set.spheres[s].radius;
      if (distance < least) least = distance, nearest = s;
    }
    sums[nearest] += albedo, counts[nearest] += 1.0f, all += albedo;
  }
  const glm::vec3 mean = points.empty() ? glm::vec3(0.5f) : all / float(points.size());
  for (std::size_t s = 0; s < sums.size(); ++s) sums[s] = counts[s] > 0.0f ? sums[s] / counts[s] : mean;
  return sums;
}

ProxySet::ProxySet(const Scene& scene, const SceneSpheres& spheres)
    : spheres_(spheres), scene_(withoutPictures(scene, spheres)) {
  for (const SphereSet& set : spheres_.sets) {
    for (const int mesh : set.meshes) {
      if (mesh < 0 || std::size_t(mesh) >= scene.meshes.size())
        throw Error("sphere sets", "belong to another scene");
    }
    albedos_.push_back(sphereAlbedos(scene, set));
    shares_.push_back(shadowShares(scene, set));
  }
  flats_ = FlatPatches(scene, spheres, 0, kBlockingPatches);
}

std::vector<PosedSphere> ProxySet::drawnIn(const PosedScene& posed) const {
  std::vector<PosedSphere> drawn_in = poseSpheres(spheres_, scene_, posed);
  for (PosedSphere& sphere : drawn_in)
    sphere.radius *= shares_[std::size_t(sphere.set)][std::size_t(sphere.sphere)];
  return drawn_in;
}

std::vector<frame::Proxy> ProxySet::posed(const PosedScene& posed) const {
  return proxiesOf(drawnIn(posed));
}

std::vector<frame::Proxy> ProxySet::proxiesOf(std::span<const PosedSphere> drawn_in) const {
  std::vector<frame::Proxy> proxies;
  for (const PosedSphere& sphere : drawn_in) {
    const glm::vec3 albedo = albedos_[std::size_t(sphere.set)][std::size_t(sphere.sphere)];
    proxies.push_back({sphere.center, sphere.radius, albedo});
  }
  return proxies;
}

}  // namespace gloam
