// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Surface points, spread by area, go into boxes of one size by where they lie and which of six ways they face; each box becomes the
// rectangle that bounds its points, scaled to their area.
#include "renderer/flat_patches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "renderer/flat_points.h"
#include "scene/transforms.h"

namespace gloam {

namespace {

constexpr float kThin = 0.2f;          // thickness over width of what blocks as one side
constexpr float kLeastFilled = 0.02f;  // of a box's side squared

/// Points of one box.
struct Box {
  glm::vec3 place{0.0f}, normal{0.0f}, albedo{0.0f}, emission{0.0f};
  glm::vec2 low{INFINITY}, high{-INFINITY};
  float depth = 0.0f, area = 0.0f;
};

std::vector<frame::Patch> patchesOf(const std::vector<FlatPoint>& points, const glm::mat3& axes, float side) {
  std::map<std::tuple<int, int, int, int>, Box> boxes;
  const glm::mat3 to_own = glm::transpose(axes);
  for (const FlatPoint& point : points) {
    const glm::vec3 q = to_own * point.place, m = to_own * point.normal, size = glm::abs(m);
    const int w = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    const auto cell = [&](float x) { return int(std::floor(std::clamp(x / side + 0.37f, -1e6f, 1e6f))); };
    Box& box = boxes[{2 * w + (m[w] > 0.0f ? 1 : 0), cell(q[u]), cell(q[v]), cell(q[w])}];
    box.low = glm::min(box.low, {q[u], q[v]}), box.high = glm::max(box.high, {q[u], q[v]});
    box.depth += point.area * q[w], box.area += point.area;
    box.normal += point.area * point.normal, box.albedo += point.area * point.albedo;
    box.emission += point.area * point.emission;
  }
  std::vector<frame::Patch> patches;
  for (const auto& [key, box] : boxes) {
    if (box.area < kLeastFilled * side * side || !(glm::length(box.normal) > 0.0f)) continue;
    const int w = std::get<0>(key) / 2, u = (w + 1) % 3, v = (w + 2) % 3;
    const glm::vec2 middle = 0.5f * (box.low + box.high);
    const glm::vec2 half = glm::max(0.5f * (box.high - box.low), glm::vec2(1e-3f * side));
    frame::Patch patch;
    patch.normal = glm::normalize(box.normal);
    patch.center = middle.x * axes[u] + middle.y * axes[v] + box.depth / box.area * axes[w];
    const glm::vec3 along = glm::normalize(axes[u] - glm::dot(axes[u], patch.normal) * patch.normal);
    const float scale = std::sqrt(box.area / (4.0f * half.x * half.y));
    patch.half_u = scale * half.x * along;
    patch.half_v = scale * half.y * glm::cross(patch.normal, along);
    patch.albedo = box.albedo / box.area;
    patch.glow = box.emission / box.area;
    patches.push_back(patch);
  }
  return patches;
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
      std::size_t count = 0;
      for (std::size_t i = 0; i < instances.size(); ++i) {
        const glm::mat4& matrix = instances[i]->world_from_object;
        std::vector<frame::Patch>& patches = things_[i].*list;
        patches = patchesOf(points[i], rotationFactor(matrix), side);
        for (frame::Patch& patch : patches) patch = moved(patch, glm::inverse(matrix));
        count += patches.size();
      }
      if (int(count) <= std::max(most, 6 * things) || side > 1e6f * std::sqrt(area)) return;
    }
  };
  fill(points, senders, &Placed::senders);
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
