// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres that go with their objects (Sloan et al. 2007, section 6; SS-2). Of a deforming one each sphere follows the rigid
// motion that carries its anchors p to their places p' best: c' = m' + s R (c - m), m the means, R the rotation factor of
// sum (p' - m') (p - m)^T (Kabsch), s the ratio of their spreads.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "scene/transforms.h"
#include "spheres/objects.h"

namespace gloam {
namespace spheres {
namespace {

constexpr std::size_t kAnchors = 32;

struct Candidate {
  SphereAnchor anchor;
  glm::vec3 place;
};

/// Of each sphere: the vertices that it is nearest to.
std::vector<std::vector<Candidate>> segments(const SphereSet& set, const Scene& scene) {
  std::vector<std::vector<Candidate>> parts(set.spheres.size());
  for (std::size_t part = 0; part < set.meshes.size(); ++part) {
    const Mesh& mesh = scene.meshes[std::size_t(set.meshes[part])];
    std::vector<bool> used(mesh.vertexCount(), false);
    for (const std::uint32_t i : mesh.indices) used[i] = true;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      if (!used[v]) continue;
      std::size_t nearest = 0;
      float least = INFINITY;
      for (std::size_t s = 0; s < set.spheres.size(); ++s) {
        const float distance =
            glm::distance(mesh.positions[v], set.spheres[s].center) / set.spheres[s].radius;
        if (distance < least) least = distance, nearest = s;
      }
      parts[nearest].push_back({{int(part), std::uint32_t(v)}, mesh.positions[v]});
    }
  }
  return parts;
}

/// Where a sphere is nearest to no vertex (a coarse mesh): the vertex nearest to it.
Candidate nearestVertex(const SphereSet& set, const Scene& scene, const Sphere& sphere) {
  Candidate best{};
  float least = INFINITY;
  for (std::size_t part = 0; part < set.meshes.size(); ++part) {
    const Mesh& mesh = scene.meshes[std::size_t(set.meshes[part])];
    for (const std::uint32_t v : mesh.indices) {
      const float distance = glm::distance(mesh.positions[v], sphere.center);
      if (distance < least) least = distance, best = {{int(part), v}, mesh.positions[v]};
    }
  }
  return best;
}

}  // namespace

void addAnchors(SphereSet& set, const Scene& scene) {
  const std::vector<std::vector<Candidate>> parts = segments(set, scene);
  const std::vector<glm::vec3> ways = sampling::fibonacciSphere(int(kAnchors));
  set.anchors.clear();
  set.first_anchor.assign(1, 0);
  for (std::size_t s = 0; s < set.spheres.size(); ++s) {
    std::vector<std::size_t> chosen;
    for (const glm::vec3& way : ways) {  // the outermost each way: they hold the others between them
      const auto outermost = std::ranges::max_element(
          parts[s], {}, [&](const Candidate& c) { return glm::dot(c.place - set.spheres[s].center, way); });
      if (outermost != parts[s].end()) chosen.push_back(std::size_t(outermost - parts[s].begin()));
    }
    std::ranges::sort(chosen);
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::size_t c : chosen) set.anchors.push_back(parts[s][c].anchor);
    if (chosen.empty()) set.anchors.push_back(nearestVertex(set, scene, set.spheres[s]).anchor);
    set.first_anchor.push_back(std::uint32_t(set.anchors.size()));
  }
}

}  // namespace spheres

namespace {

constexpr float kMostGrowth = 1.3f;

/// The instances of one standing object: one for each of its meshes.
using Parts = std::vector<const Instance*>;

glm::vec3 placeOf(const SphereAnchor& anchor, const Parts& parts, const glm::vec3& rest) {
  const Instance& instance = *parts[std::size_t(anchor.part)];
  if (instance.deformed()) return instance.deformed_positions[anchor.vertex];
  return glm::vec3(instance.world_from_object * glm::vec4(rest, 1.0f));
}

/// A sphere where it is, and how it has turned.
struct Followed {
  Sphere sphere;
  glm::mat3 turn;
};

Followed followAnchors(const SphereSet& set, std::size_t index, const Scene& scene, const Parts& parts) {
  const Sphere& sphere = set.spheres[index];
  const std::span anchors(set.anchors.begin() + set.first_anchor[index],
                          set.anchors.begin() + set.first_anchor[index + 1]);
  std::vector<glm::vec3> rest, now;
  glm::vec3 rest_mean(0.0f), now_mean(0.0f);
  for (const SphereAnchor& anchor : anchors) {
    const Mesh& mesh = scene.meshes[std::size_t(set.meshes[std::size_t(anchor.part)])];
    rest.push_back(mesh.positions[anchor.vertex]);
    now.push_back(placeOf(anchor, parts, rest.back()));
    rest_mean += rest.back() / float(anchors.size());
    now_mean += now.back() / float(anchors.size());
  }
  glm::mat3 covariance(0.0f);
  float rest_spread = 0.0f, now_spread = 0.0f;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const glm::vec3 a = rest[i] - rest_mean, b = now[i] - now_mean;
    covariance += glm::outerProduct(b, a);
    rest_spread += glm::dot(a, a), now_spread += glm::dot(b, b);
  }
  const float scale = rest_spread > 0.0f ? std::sqrt(now_spread / rest_spread) : 1.0f;
  const glm::mat3 turn = rest_spread > 0.0f ? rotationFactor(covariance) : glm::mat3(1.0f);
  Sphere posed;
  posed.center = now_mean + scale * (turn * (sphere.center - rest_mean));
  float rest_reach = 0.0f, now_reach = 0.0f;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    rest_reach = std::max(rest_reach, glm::distance(rest[i], sphere.center));
    now_reach = std::max(now_reach, glm::distance(now[i], posed.center));
  }
  const float spread = rest_reach > 0.0f ? now_reach / rest_reach : 1.0f;
  posed.radius = sphere.radius * std::clamp(spread, scale / kMostGrowth, scale * kMostGrowth);
  return {posed, turn};
}

Sphere followMatrix(const Sphere& sphere, const glm::mat4& world_from_shape, float stretch) {
  return {glm::vec3(world_from_shape * glm::vec4(sphere.center, 1.0f)), sphere.radius * stretch};
}

[[noreturn]] void refuse() {
  throw Error("sphere sets", "belong to another scene than the one that is posed");
}

void checkSet(const SphereSet& set, const Scene& scene) {
  for (const int m : set.meshes) {
    if (m < 0 || std::size_t(m) >= scene.meshes.size()) refuse();
  }
  for (const int n : set.nodes) {
    if (n < 0 || std::size_t(n) >= scene.nodes.size() || scene.nodes[std::size_t(n)].meshes != set.meshes)
      refuse();
  }
  if (!set.deforms || set.spheres.empty()) return;  // what only receives has nothing that follows it
  if (set.first_anchor.size() != set.spheres.size() + 1 || set.first_anchor.back() != set.anchors.size())
    refuse();
  for (const SphereAnchor& anchor : set.anchors) {
    if (std::size_t(anchor.part) >= set.meshes.size()) refuse();
    if (anchor.vertex >= scene.meshes[std::size_t(set.meshes[std::size_t(anchor.part)])].vertexCount())
      refuse();
  }
}

/// Copy c of an object: the c-th instance of each of its meshes (the last where a mesh has fewer).
Parts partsOf(const SphereSet& set, std::span<const Instance> of_node, std::size_t copy) {
  Parts parts;
  for (const int mesh : set.meshes) {
    const Instance* found = nullptr;
    std::size_t seen = 0;
    for (const Instance& instance : of_node) {
      if (instance.mesh == mesh && seen++ <= copy) found = &instance;
    }
    if (found == nullptr) refuse();
    parts.push_back(found);
  }
  return parts;
}

void poseObject(const SphereSet& set, int set_index, const Scene& scene, const Parts& parts, int instance,
                std::vector<PosedSphere>& out) {
  const bool follow =
      set.deforms && std::ranges::any_of(parts, [](const Instance* i) { return i->deformed(); });
  const glm::mat4 world_from_shape =
      parts.front()->world_from_object * glm::mat4(glm::inverse(set.shape_from_object));
  const glm::vec3 scale = glm::abs(decomposeLinear(glm::mat3(world_from_shape)).scale);
  const float stretch = std::max({scale.x, scale.y, scale.z});
  const glm::mat3 turn = rotationFactor(world_from_shape);
  for (std::size_t s = 0; s < set.spheres.size(); ++s) {
    const Followed posed = follow ? followAnchors(set, s, scene, parts)
                                  : Followed{followMatrix(set.spheres[s], world_from_shape, stretch), turn};
    out.push_back({posed.sphere.center, posed.sphere.radius, set_index, int(s), instance, posed.turn});
  }
}

}  // namespace

std::vector<PosedSphere> poseSpheres(const SceneSpheres& spheres, const Scene& scene,
                                     const PosedScene& posed) {
  std::vector<int> set_of_node(scene.nodes.size(), kNone);
  for (std::size_t s = 0; s < spheres.sets.size(); ++s) {
    checkSet(spheres.sets[s], scene);
    for (const int n : spheres.sets[s].nodes) set_of_node[std::size_t(n)] = int(s);
  }
  std::vector<PosedSphere> out;
  for (std::size_t first = 0; first < posed.instances.size();) {
    const int node = posed.instances[first].node;
    std::size_t end = first, copies = 0;
    for (; end < posed.instances.size() && posed.instances[end].node == node; ++end) {
      copies += posed.instances[end].mesh == posed.instances[first].mesh ? 1 : 0;
    }
    if (node < 0 || std::size_t(node) >= set_of_node.size()) refuse();
    const int index = set_of_node[std::size_t(node)];
    if (index != kNone && !spheres.sets[std::size_t(index)].spheres.empty()) {
      const SphereSet& set = spheres.sets[std::size_t(index)];
      const std::span of_node(posed.instances.begin() + std::ptrdiff_t(first), end - first);
      for (std::size_t copy = 0; copy < copies; ++copy) {
        poseObject(set, index, scene, partsOf(set, of_node, copy), int(first + copy), out);
      }
    }
    first = end;
  }
  return out;
}

}  // namespace gloam
