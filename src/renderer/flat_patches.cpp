// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Surface points, spread by area, are grouped by where they lie and which of six ways they face (flat_groups.h): what blocks by cells of
// one size, what sends where it sends most. Each group becomes the rectangle that bounds its points, scaled to their area; what
// blocks, not far beyond these bounds: of many strips, one behind another, only one is seen.
#include "renderer/flat_patches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "renderer/flat_groups.h"
#include "scene/transforms.h"

namespace gloam {

namespace {

constexpr float kThin = 0.2f;       // thickness over width of what blocks as one side
constexpr float kThinnest = 1e-3f;  // of a cell's side: half of a rectangle's width, at least
// Beyond the bounds of its points: what is hollow has more area than its outline, a row of strips far more.
constexpr float kMostGrown = 1.5f;
constexpr float kEnclosed = 0.95f;  // of its points
// Of its size: how far off what encloses it is, on the mean. What lies closer over its ground ends beside what sees the sky.
constexpr float kRoom = 0.25f;

/// The rectangle that bounds these points, scaled to their area, by `most_scale` at most; none where they face all ways.
void addPatch(const FlatGroup& group, const glm::mat3& axes, float thinnest, float most_scale,
              std::vector<frame::Patch>& patches) {
  glm::vec3 normal(0.0f), albedo(0.0f), emission(0.0f);
  float depth = 0.0f, enclosed = 0.0f, room = 0.0f;
  const int w = group.axis, u = (w + 1) % 3, v = (w + 2) % 3;
  for (const FlatPoint& point : group.points) {
    normal += point.area * point.normal, albedo += point.area * point.albedo;
    emission += point.area * point.emission, depth += point.area * glm::dot(axes[w], point.place);
    enclosed += point.room > 0.0f ? point.area : 0.0f, room += point.area * point.room;
  }
  if (!(glm::length(normal) > 0.0f)) return;
  const glm::vec3 middle = 0.5f * (group.low + group.high);
  const glm::vec3 half = glm::max(0.5f * (group.high - group.low), glm::vec3(thinnest));
  frame::Patch patch;
  patch.normal = glm::normalize(normal);
  patch.center = middle[u] * axes[u] + middle[v] * axes[v] + depth / group.area * axes[w];
  const glm::vec3 along = glm::normalize(axes[u] - glm::dot(axes[u], patch.normal) * patch.normal);
  const float scale = std::min(most_scale, std::sqrt(group.area / (4.0f * half[u] * half[v])));
  patch.half_u = scale * half[u] * along;
  patch.half_v = scale * half[v] * glm::cross(patch.normal, along);
  patch.albedo = albedo / group.area;
  patch.glow = emission / group.area;
  patch.enclosed = enclosed >= kEnclosed * group.area && room >= kRoom * group.area * std::sqrt(group.area);
  patches.push_back(patch);
}

frame::Patch moved(const frame::Patch& patch, const glm::mat4& matrix) {
  const glm::mat3 m(matrix);
  frame::Patch result = patch;
  result.center = glm::vec3(matrix * glm::vec4(patch.center, 1.0f));
  result.half_u = m * patch.half_u, result.half_v = m * patch.half_v;
  const glm::vec3 normal = normalTransform(m) * patch.normal;
  if (glm::length(normal) > 0.0f) result.normal = glm::normalize(normal);
  return result;
}

float areaOf(const frame::Patch& patch) {
  return 4.0f * glm::length(glm::cross(patch.half_u, patch.half_v));
}

/// The two sides of a thin thing block once: of each pair the side that looks at `toward` stays.
void keepOneOfPairs(std::vector<frame::Patch>& patches, const glm::mat4& world_from_object,
                    const glm::vec3& toward) {
  const auto looks = [&](const frame::Patch& patch) { return glm::dot(toward - patch.center, patch.normal); };
  std::vector<frame::Patch> world;
  for (const frame::Patch& patch : patches) world.push_back(moved(patch, world_from_object));
  std::vector<bool> dropped(patches.size(), false);
  for (std::size_t a = 0; a < patches.size(); ++a) {
    for (std::size_t b = 0; b < patches.size() && !dropped[a]; ++b) {
      if (a == b || dropped[b] || glm::dot(world[a].normal, world[b].normal) > -0.9f) continue;
      const glm::vec3 apart = world[a].center - world[b].center;
      const float size = std::sqrt(std::min(areaOf(world[a]), areaOf(world[b])));
      const float across = std::abs(glm::dot(apart, world[b].normal));
      const bool pair =
          across < kThin * size && glm::dot(apart, apart) - across * across < 0.1f * size * size;
      if (pair)
        dropped[looks(world[a]) < looks(world[b]) || (looks(world[a]) == looks(world[b]) && a > b) ? a : b] =
            true;
    }
  }
  std::size_t i = 0;
  std::erase_if(patches, [&](const frame::Patch&) { return dropped[i++]; });
}

}  // namespace

FlatPatches::FlatPatches(const Scene& scene, const SceneSpheres& spheres, int senders, int blockers,
                         int glowing) {
  std::vector<bool> casts(scene.nodes.size(), false);
  for (const SphereSet& set : spheres.sets) {
    for (const int node : set.nodes)
      casts.at(std::size_t(node)) = casts[std::size_t(node)] || !set.spheres.empty();
  }
  const PosedScene posed = gloam::pose(scene, 0.0f);
  std::vector<const Instance*> instances;
  double area = 0.0;
  std::map<std::pair<int, int>, int> copies;
  for (const Instance& instance : posed.instances) {
    const int copy = copies[{instance.node, instance.mesh}]++;
    const double own = instance.deformed() || casts[std::size_t(instance.node)]
                           ? 0.0
                           : areaOf(scene.meshes[std::size_t(instance.mesh)], instance.world_from_object);
    if (!(own > 0.0) || !std::isfinite(own)) continue;
    area += own;
    instances.push_back(&instance);
    things_.push_back({.node = instance.node, .mesh = instance.mesh, .copy = copy});
  }
  if (instances.empty()) return;
  std::vector<std::vector<FlatPoint>> points;
  for (const Instance* instance : instances) points.push_back(pointsOf(scene, *instance, area / kFlatPoints));
  std::vector<glm::mat3> axes;
  for (const Instance* instance : instances) axes.push_back(rotationFactor(instance->world_from_object));
  const auto keep = [&](const std::vector<std::vector<FlatGroup>>& groups, float side, float most_scale,
                        std::vector<frame::Patch> Placed::*list) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      std::vector<frame::Patch>& patches = things_[i].*list;
      for (const FlatGroup& group : groups[i])
        addPatch(group, axes[i], kThinnest * side, most_scale, patches);
      const glm::mat4 object_from_world = glm::inverse(instances[i]->world_from_object);
      for (frame::Patch& patch : patches) patch = moved(patch, object_from_world);
    }
  };
  const auto fill = [&](const std::vector<std::vector<FlatPoint>>& points, int most,
                        std::vector<frame::Patch> Placed::*list) {
    float area = 0.0f;
    int things = 0;
    for (const std::vector<FlatPoint>& own : points) {
      things += own.empty() ? 0 : 1;
      for (const FlatPoint& point : own) area += point.area;
    }
    if (most <= 0 || !(area > 0.0f)) return;
    for (float side = std::sqrt(area / float(most));; side *= 1.15f) {
      std::vector<std::vector<FlatGroup>> groups;
      std::size_t count = 0;
      for (std::size_t i = 0; i < instances.size(); ++i)
        count += groups.emplace_back(groupedByCells(points[i], axes[i], side)).size();
      if (int(count) > std::max(most, 6 * things) && side <= 1e6f * std::sqrt(area)) continue;
      return keep(groups, side, kMostGrown, list);
    }
  };
  if (senders > 0) {
    meetSurfaces(scene, posed, instances, points);
    keep(groupedByLight(points, axes, senders), float(std::sqrt(area / senders)), INFINITY, &Placed::senders);
  }
  fill(points, blockers, &Placed::blockers);
  if (glowing > 0) fill(shiningPoints(scene, posed, instances), glowing, &Placed::glowing);
  const glm::vec3 middle = 0.5f * (posed.bounds_min + posed.bounds_max);
  std::vector<float> areas;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    keepOneOfPairs(things_[i].blockers, instances[i]->world_from_object, middle);
    for (const frame::Patch& patch : things_[i].blockers)
      areas.push_back(areaOf(moved(patch, instances[i]->world_from_object)));
  }
  if (areas.size() <= std::size_t(kMostBlockers)) return;
  std::ranges::nth_element(areas, areas.begin() + kMostBlockers, std::greater());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    std::erase_if(things_[i].blockers, [&](const frame::Patch& patch) {
      return areaOf(moved(patch, instances[i]->world_from_object)) <= areas[std::size_t(kMostBlockers)];
    });
  }
}

std::vector<frame::Patch> FlatPatches::blockers(const PosedScene& posed) const {
  frame::Emission emission;
  pose(posed, emission);
  return std::move(emission.blocking_patches);
}

void FlatPatches::pose(const PosedScene& posed, frame::Emission& emission) const {
  for (const Placed& thing : things_) {
    int copy = 0;
    for (const Instance& instance : posed.instances) {
      if (instance.node != thing.node || instance.mesh != thing.mesh || copy++ != thing.copy) continue;
      for (const frame::Patch& patch : thing.senders)
        emission.sending_patches.push_back(moved(patch, instance.world_from_object));
      for (const frame::Patch& patch : thing.blockers)
        emission.blocking_patches.push_back(moved(patch, instance.world_from_object));
      for (const frame::Patch& patch : thing.glowing)
        emission.glowing_patches.push_back(moved(patch, instance.world_from_object));
      break;
    }
  }
}

}  // namespace gloam
