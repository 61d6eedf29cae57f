// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 7.1 (SL-7): samples go with their triangles, spheres with their objects; nothing is made
// again.
#include "renderer/emission_set.h"

#include <algorithm>

#include "scene/transforms.h"

namespace gloam {

namespace {

constexpr int kSendingPatches = 160;

[[noreturn]] void refuse() {
  throw Error("emission of spheres", "belongs to other spheres or to another scene");
}

std::vector<std::uint32_t> meetingPairs(const SphereSet& set, const std::vector<float>& shares, int words) {
  const std::size_t count = set.spheres.size();
  std::vector<std::uint32_t> bits(count * std::size_t(words), 0u);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      const float reach = set.spheres[a].radius * shares[a] + set.spheres[b].radius * shares[b];
      if (a == b || glm::distance(set.spheres[a].center, set.spheres[b].center) < reach)
        bits[a * std::size_t(words) + b / 32] |= 1u << (b % 32);
    }
  }
  return bits;
}

/// Each level of the tree over a set's spheres as they were fitted (SS-3), so that motion changes no groups.
frame::ProxyLevels levelsOf(const SphereSet& set) {
  frame::ProxyLevels levels;
  const SphereTree tree = makeSphereTree(set.spheres);
  std::vector<std::vector<int>> leaves(tree.nodes.size());
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    const SphereTree::Node& node = tree.nodes[n];
    if (node.children == 0) leaves[n] = {node.sphere};
    for (int c = 0; c < node.children; ++c) {
      const std::vector<int>& of_child = leaves[std::size_t(node.first_child + c)];
      leaves[n].insert(leaves[n].end(), of_child.begin(), of_child.end());
    }
  }
  for (int depth = 0;; ++depth) {
    std::vector<std::vector<int>> groups;
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
      const SphereTree::Node& node = tree.nodes[n];
      if (node.depth == depth || (node.children == 0 && node.depth < depth)) groups.push_back(leaves[n]);
    }
    if (groups.size() >= set.spheres.size()) return levels;
    levels.push_back(std::move(groups));
  }
}

/// The first instance of a node's, given one of them.
int firstOfNode(const PosedScene& posed, int instance) {
  while (instance > 0 &&
         posed.instances[std::size_t(instance) - 1].node == posed.instances[std::size_t(instance)].node)
    --instance;
  return instance;
}

/// The instances of one standing object, one for each of its meshes, as poseSpheres takes them.
std::vector<const Instance*> partsOf(const std::vector<int>& meshes, const PosedScene& posed, int instance) {
  const int first = firstOfNode(posed, instance), copy = instance - first;
  std::vector<const Instance*> parts;
  for (const int mesh : meshes) {
    const Instance* found = nullptr;
    int seen = 0;
    for (std::size_t i = std::size_t(first);
         i < posed.instances.size() && posed.instances[i].node == posed.instances[std::size_t(first)].node;
         ++i) {
      if (posed.instances[i].mesh == mesh && seen++ <= copy) found = &posed.instances[i];
    }
    if (found == nullptr) refuse();
    parts.push_back(found);
  }
  return parts;
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 0.0f ? v / length : otherwise;
}

}  // namespace

EmissionSet::EmissionSet(const Scene& scene, const SceneSpheres& spheres, const SceneEmission& emission,
                         const std::vector<std::vector<float>>& shares) {
  if (emission.sets.size() != spheres.sets.size()) refuse();
  for (std::size_t s = 0; s < spheres.sets.size(); ++s) {
    const SphereSet& given = spheres.sets[s];
    if (emission.sets[s].spheres.size() != given.spheres.size()) refuse();
    Set set{.meshes = given.meshes, .points = {}, .spheres = emission.sets[s].spheres};
    for (const SphereEmission& sphere : set.spheres) {
      for (const EmissionSample& sample : sphere.samples) {
        Point& point = set.points.emplace_back();
        if (sample.part == kNone) continue;
        if (sample.part < 0 || std::size_t(sample.part) >= given.meshes.size()) refuse();
        const Mesh& mesh = scene.meshes.at(std::size_t(given.meshes[std::size_t(sample.part)]));
        if (sample.triangle >= mesh.triangleCount()) refuse();
        point.part = sample.part;
        point.weights = {1.0f - sample.u - sample.v, sample.u, sample.v};
        point.side = sample.side < 0 ? -1.0f : 1.0f;
        for (int c = 0; c < 3; ++c) {
          point.vertices[c] = mesh.indices[std::size_t(sample.triangle) * 3 + std::size_t(c)];
          point.position += point.weights[c] * mesh.positions[point.vertices[c]];
          if (!mesh.normals.empty()) point.normal += point.weights[c] * mesh.normals[point.vertices[c]];
        }
      }
      for (const glm::vec3& value : sphere.glow.coefficients()) glows_ = glows_ || value != glm::vec3(0.0f);
    }
    set.words = int(given.spheres.size() + 31) / 32;
    set.meets = meetingPairs(given, shares.at(s), set.words);
    set.levels = levelsOf(given);
    sets_.push_back(std::move(set));
  }
  flats_ = FlatPatches(scene, spheres, kSendingPatches, kBlockingPatches, kGlowingPatches);
}

frame::EmissionPoint EmissionSet::place(const Point& point, const Instance& instance,
                                        const glm::mat3& normals) {
  frame::EmissionPoint placed;
  placed.sends = 1.0f;
  if (instance.deformed()) {
    for (int c = 0; c < 3; ++c) {
      placed.position += point.weights[c] * instance.deformed_positions[point.vertices[c]];
      placed.normal += point.weights[c] * instance.deformed_normals[point.vertices[c]];
    }
  } else {
    placed.position = glm::vec3(instance.world_from_object * glm::vec4(point.position, 1.0f));
    placed.normal = normals * point.normal;
  }
  placed.normal = point.side * unitOr(placed.normal, glm::vec3(0.0f));
  if (placed.normal == glm::vec3(0.0f)) placed.sends = 0.0f;
  return placed;
}

frame::Emission EmissionSet::posed(const PosedScene& posed, std::span<const PosedSphere> spheres) const {
  frame::Emission emission{.points_each = kEmissionDirections, .glows = glows_};
  emission.points.reserve(spheres.size() * kEmissionDirections);
  for (const Set& set : sets_) emission.words = std::max(emission.words, set.words);
  int object = -1;
  for (std::size_t first = 0; first < spheres.size();) {
    std::size_t end = first;
    while (end < spheres.size() && spheres[end].instance == spheres[first].instance) ++end;
    if (std::size_t(spheres[first].set) >= sets_.size()) refuse();
    const Set& set = sets_[std::size_t(spheres[first].set)];
    if (end - first != set.spheres.size()) refuse();
    const std::vector<const Instance*> parts = partsOf(set.meshes, posed, spheres[first].instance);
    std::vector<glm::mat3> normals;
    for (const Instance* part : parts) normals.push_back(normalTransform(glm::mat3(part->world_from_object)));
    ++object;
    for (std::size_t i = first; i < end; ++i) {
      const auto s = std::size_t(spheres[i].sphere);
      emission.proxies.push_back({object, int(first), int(end - first), spheres[i].world_from_shape,
                                  &set.spheres[s].albedo, &set.spheres[s].glow, &set.levels});
      for (int j = 0; j < kEmissionDirections; ++j) {
        const Point& point = set.points[s * kEmissionDirections + std::size_t(j)];
        emission.points.push_back(point.part == kNone ? frame::EmissionPoint{}
                                                      : place(point, *parts[std::size_t(point.part)],
                                                              normals[std::size_t(point.part)]));
      }
      for (int w = 0; w < emission.words; ++w)
        emission.meets.push_back(w < set.words ? set.meets[s * std::size_t(set.words) + std::size_t(w)] : 0u);
    }
    first = end;
  }
  flats_.pose(posed, emission);
  return emission;
}

}  // namespace gloam
