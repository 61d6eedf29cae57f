// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "spheres/objects.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/scene_fingerprint.h"
#include "scene/transforms.h"

namespace gloam::spheres {
namespace {

constexpr int kCurvePoints = 2000, kCurveEnd = 64;
constexpr float kLooseEnough =
    3.0f;  // air over volume: drawn in (renderer/shadow_radii), such spheres still look alike
constexpr float kLooseLimbs = 1.3f;        // of what deforms: a foot, and the shadow at it, takes two spheres
constexpr float kWorth = 0.12f;            // air over volume that a second sphere takes off: it is given
constexpr long kFewest = 26, kMost = 128;  // spheres of a scene, where their number is not given
constexpr float kEvenStretch = 0.98f;      // least over greatest stretch that still counts as even

std::string nameOf(const Scene& scene, const Node& node, std::size_t index) {
  if (!node.name.empty()) return node.name;
  const std::string& mesh = scene.meshes[std::size_t(node.meshes.front())].name;
  return mesh.empty() ? fmt::format("object {}", index) : mesh;
}

/// What is left of a matrix without its rotation and its size: M = Q S, S over its greatest stretch.
glm::mat3 stretchOf(const glm::mat3& matrix) {
  const glm::vec3 scale = glm::abs(decomposeLinear(matrix).scale);
  const float greatest = std::max({scale.x, scale.y, scale.z});
  const float least = std::min({scale.x, scale.y, scale.z});
  if (!(greatest > 0.0f) || least >= kEvenStretch * greatest) return glm::mat3(1.0f);
  return glm::transpose(rotationFactor(matrix)) * matrix / greatest;
}

bool sameStretch(const glm::mat3& a, const glm::mat3& b) {
  float difference = 0.0f;
  for (int i = 0; i < 9; ++i) difference = std::max(difference, std::abs(a[i / 3][i % 3] - b[i / 3][i % 3]));
  return difference < 1e-3f;
}

bool deforms(const Scene& scene, const Node& node) {
  return std::ranges::any_of(node.meshes, [&](int m) {
    const Mesh& mesh = scene.meshes[std::size_t(m)];
    return (node.skin != kNone && mesh.influences > 0) || !mesh.morph_targets.empty();
  });
}

Soup soupOf(const Scene& scene, const SphereSet& set) {
  Soup soup;
  for (const int m : set.meshes) {
    const Mesh& mesh = scene.meshes[std::size_t(m)];
    const auto first = std::uint32_t(soup.positions.size());
    for (const glm::vec3& p : mesh.positions) soup.positions.push_back(set.shape_from_object * p);
    for (const std::uint32_t i : mesh.indices) soup.indices.push_back(first + i);
  }
  for (const std::uint32_t i : soup.indices) {
    const glm::vec3& p = soup.positions[i];
    if (!std::isfinite(p.x + p.y + p.z)) throw Error(set.name, "a vertex is not a number or infinite");
  }
  return soup;
}

/// Deformed: the box of its vertices stands for where it is and how large.
void place(Object& object, const Instance& instance) {
  const Solid& solid = object.solid;
  glm::mat4 unit(1.0f);
  if (instance.deformed()) {
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : instance.deformed_positions) low = glm::min(low, p), high = glm::max(high, p);
    const glm::vec3 size = high - low;
    const float scale = std::max({size.x, size.y, size.z});
    unit = glm::mat4(glm::mat3(scale));
    unit[3] = glm::vec4(0.5f * (low + high), 1.0f);
  } else {
    glm::mat3 object_from_shape(1.0f);
    if (std::abs(glm::determinant(object.set.shape_from_object)) > 1e-12f) {
      object_from_shape = glm::inverse(object.set.shape_from_object);
    }
    unit = glm::mat4(object_from_shape * glm::mat3(solid.scale));
    unit[3] = glm::vec4(object_from_shape * solid.origin, 1.0f);
    unit = instance.world_from_object * unit;
  }
  object.world_from_unit = unit;
  object.world_scale3 = std::abs(glm::determinant(glm::mat3(unit)));
}

/// What 1, 2, 4 … spheres would hold of air: quick fits, clusters without a search, about a third more than a search leaves.
/// Each doubling takes off a fifth at least and three quarters at most, so that chance does not rule.
std::vector<float> outsideOf(const Object& object) {
  FitPoints points;
  for (const glm::vec3& p : sampleSurface(object.solid.soup, kCurvePoints, 1)) points.add(p);
  std::vector<float> outside;
  for (int k = 1; k <= kCurveEnd; k *= 2) {
    Fit fit(*object.solid.coarse, points, 1, 0);
    fit.startFromClusters(k);
    const float found = float(fit.cost()) * object.world_scale3;
    outside.push_back(k == 1 ? found : std::clamp(found, 0.25f * outside.back(), 0.8f * outside.back()));
  }
  return outside;
}

/// The same for any number, by powers of k between and beyond.
float outsideAt(const Object& object, int k) {
  const std::vector<float>& outside = object.outside;
  const float place = std::log2(float(k));
  const auto below = std::min(std::size_t(place), outside.size() - 2);
  if (!(outside[below] > 0.0f)) return 0.0f;
  return outside[below] * std::pow(outside[below + 1] / outside[below], place - float(below));
}

/// Spheres with which an object holds no more air than so many times its volume; two, where that helps much (a pedestal).
int neededCount(const Object& object) {
  const float volume = object.solid.volume * object.world_scale3;
  const float loose = object.set.deforms ? kLooseLimbs : kLooseEnough;
  if (object.round()) return 1;
  int k = outsideAt(object, 1) - outsideAt(object, 2) > kWorth * volume ? 2 : 1;
  while (k < kCurveEnd && outsideAt(object, k) > loose * volume) ++k;
  return k;
}

void deal(const std::vector<Object*>& casters, int count, bool among_others) {
  long left = count;
  if (count == 0) {
    long needed = 0;
    for (const Object* object : casters) needed += long(object->places) * neededCount(*object);
    if (needed > kFewest && needed <= kMost) {
      for (Object* object : casters) object->count = neededCount(*object);
      return;
    }
    left = std::clamp<long>(needed, kFewest, kMost);
  }
  for (Object* object : casters) object->count = 1, left -= long(object->places);
  // Where one more sphere takes off most; large pieces first, as long as one fits. What holds less air than its volume is tight
  // already, and counts by as much.
  const auto gain = [](const Object& object) {
    if (object.round()) return 0.0f;
    const float volume = object.solid.volume * object.world_scale3;
    const float air = outsideAt(object, object.count);
    return (air - outsideAt(object, object.count + 1)) * std::min(1.0f, air / volume);
  };
  while (left > 0) {
    Object* best = nullptr;
    for (Object* object : casters) {
      if (long(object->places) > left) continue;
      if (best == nullptr || gain(*object) > gain(*best)) best = object;
    }
    if (best == nullptr || (gain(*best) <= 0.0f && (among_others || count == 0))) break;
    ++best->count;
    left -= long(best->places);
  }
}

/// The one that is farthest from what its spheres may hold, by quick fits that hold more than the final ones; null: none is.
Object* mostMisrepresented(const std::vector<Object*>& casters) {
  constexpr float kQuickFits = 2.0f;
  Object* worst = nullptr;
  float most = kQuickFits * float(kTooLoose);
  for (Object* object : casters) {
    const float volume = object->solid.volume * object->world_scale3;
    const float air = volume > 0.0f ? outsideAt(*object, object->count) / volume : 0.0f;
    if (air > most) most = air, worst = object;
  }
  if (worst != nullptr) {
    worst->set.receive_only =
        fmt::format("thin: {} {} would hold some {:.0f} times its volume of air; a larger count may serve",
                    worst->count, worst->count == 1 ? "sphere" : "spheres", most);
    worst->count = 0;
  }
  return worst;
}

}  // namespace

std::string geometryOf(const Scene& scene, const std::vector<int>& meshes) {
  Fingerprint print;
  for (const int m : meshes) {
    const Mesh& mesh = scene.meshes[std::size_t(m)];
    addAll(print, mesh.positions, mesh.indices);
  }
  return print.text();
}

std::vector<Object> listObjects(const Scene& scene, const PosedScene& posed, const Progress& progress) {
  std::vector<Object> objects;
  std::vector<const Instance*> first_places;
  int last_node = kNone;
  for (const Instance& instance : posed.instances) {
    if (instance.node == last_node) {  // another part or copy of the same
      if (instance.mesh == objects.back().set.meshes.front()) ++objects.back().places;
      continue;
    }
    const Node& node = scene.nodes[std::size_t(instance.node)];
    const bool any = std::ranges::any_of(
        node.meshes, [&](int m) { return !scene.meshes[std::size_t(m)].indices.empty(); });
    if (!any) continue;
    last_node = instance.node;
    Object object;
    object.set.name = nameOf(scene, node, objects.size());
    object.set.meshes = node.meshes;
    object.set.nodes = {instance.node};
    object.set.deforms = deforms(scene, node);
    if (!object.set.deforms) object.set.shape_from_object = stretchOf(glm::mat3(instance.world_from_object));
    objects.push_back(std::move(object));
    first_places.push_back(&instance);
  }
  // Nodes that place the same meshes alike share a set.
  std::vector<Object> distinct;
  std::vector<const Instance*> places;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto same = std::ranges::find_if(distinct, [&](const Object& other) {
      return other.set.meshes == objects[i].set.meshes && other.set.deforms == objects[i].set.deforms &&
             sameStretch(other.set.shape_from_object, objects[i].set.shape_from_object);
    });
    if (same != distinct.end()) {
      same->set.nodes.push_back(objects[i].set.nodes.front());
      same->places += objects[i].places;
    } else {
      distinct.push_back(std::move(objects[i]));
      places.push_back(first_places[i]);
    }
  }
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    progress.report(double(i) / double(distinct.size()), "spheres: " + distinct[i].set.name);
    distinct[i].set.geometry = geometryOf(scene, distinct[i].set.meshes);
    distinct[i].solid = makeSolid(soupOf(scene, distinct[i].set), progress.should_stop);
    place(distinct[i], *places[i]);
  }
  return distinct;
}

void spreadCount(std::vector<Object>& objects, int count) {
  std::vector<Object*> casters;
  for (Object& object : objects) {
    if (object.casts()) casters.push_back(&object);
  }
  tbb::parallel_for(std::size_t(0), casters.size(),
                    [&](std::size_t i) { casters[i]->outside = outsideOf(*casters[i]); });
  deal(casters, count, objects.size() > 1);
  while (casters.size() > 1) {
    Object* worst = mostMisrepresented(casters);
    if (worst == nullptr) break;
    std::erase(casters, worst);
    deal(casters, count, true);
  }
}

}  // namespace gloam::spheres
