// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-9: every proxy has the albedo of the surface that it stands for, the mean over points spread evenly by area, and is drawn in
// until it shadows as much as that does; how far it still bulges out of it is known to the receivers (spheres/receiver_rule.h).
#include "renderer/proxy_set.h"

#include <algorithm>
#include <cmath>

#include "renderer/set_surface.h"
#include "renderer/shadow_radii.h"
#include "renderer/sphere_bulges.h"

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
    const glm::vec3 place = placeOf(scene, set, at);
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
    bulges_.push_back(sphereBulges(scene, set, shares_.back()));
  }
  flats_ = FlatPatches(scene, spheres, 0, kBlockingPatches, 0);
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
    const auto set = std::size_t(sphere.set), index = std::size_t(sphere.sphere);
    proxies.push_back({sphere.center, sphere.radius, albedos_[set][index], bulges_[set][index]});
  }
  return proxies;
}

}  // namespace gloam
