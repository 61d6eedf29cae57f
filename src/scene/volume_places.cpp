// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/volume_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {

VolumePlaces::VolumePlaces(const Scene& scene) {
  if (!carriesVolumes(scene)) return;
  skeleton_.nodes = scene.nodes;
  skeleton_.roots = scene.roots;
  skeleton_.animations = scene.animations;
  skeleton_.meshes.resize(1);
  for (Node& node : skeleton_.nodes) {
    node.meshes.clear();
    node.instances.clear();
    node.morph_weights.clear();
    node.skin = node.camera = node.light = kNone;
    if (node.volume) node.meshes = {0};
  }
  for (Animation& animation : skeleton_.animations)
    std::erase_if(animation.channels, [](const AnimationChannel& channel) {
      return channel.path == AnimationChannel::Path::kWeights;
    });
}

std::vector<PlacedVolume> VolumePlaces::at(float time_s) const {
  std::vector<PlacedVolume> placed;
  if (skeleton_.nodes.empty()) return placed;
  for (const Instance& instance : pose(skeleton_, time_s).instances)
    placed.push_back(
        {instance.node, skeleton_.nodes[std::size_t(instance.node)].volume, instance.world_from_object});
  return placed;
}

bool carriesVolumes(const Scene& scene) {
  return std::ranges::any_of(scene.nodes, [](const Node& node) { return node.volume != nullptr; });
}

bool carriesUnbakedVolumes(const Scene& scene) {
  return std::ranges::any_of(
      scene.nodes, [](const Node& node) { return node.volume && node.volume->transfer == nullptr; });
}

std::string volumeNames(const Scene& scene) {
  std::string names;
  for (const Node& node : scene.nodes) {
    if (!node.volume) continue;
    const std::string& name = node.volume->name.empty() ? node.name : node.volume->name;
    names += (names.empty() ? "" : ", ") + (name.empty() ? "a volume" : name);
  }
  return names;
}

void checkVolume(const Volume& volume, const std::string& place) {
  constexpr double kMost = 2147483647.0;
  const glm::ivec3 size = volume.size;
  if (glm::any(glm::lessThan(size, glm::ivec3(2))) ||
      double(size.x) * double(size.y) * double(size.z) > kMost)
    throw Error(place, fmt::format("{} x {} x {} voxels; expected 2 or more each way, 2^31 at most", size.x,
                                   size.y, size.z));
  if (volume.density.size() != volume.voxels())
    throw Error(place, fmt::format("{} densities for {} voxels", volume.density.size(), volume.voxels()));
  for (std::size_t i = 0; i < volume.density.size(); ++i)
    if (!(volume.density[i] >= 0.0f && std::isfinite(volume.density[i])))
      throw Error(place, fmt::format("voxel {}: a density of {}; expected 0 or more", i, volume.density[i]));
  for (int c = 0; c < 3; ++c) {
    if (!(volume.bounds_max[c] > volume.bounds_min[c]) || !(std::abs(volume.bounds_min[c]) <= 1e12f) ||
        !(std::abs(volume.bounds_max[c]) <= 1e12f))
      throw Error(place, fmt::format("a box from {} to {}; expected room between, within 1e12",
                                     volume.bounds_min[c], volume.bounds_max[c]));
    if (!(volume.albedo[c] >= 0.0f && volume.albedo[c] <= 1.0f))
      throw Error(place, fmt::format("an albedo of {}; expected 0 to 1", volume.albedo[c]));
  }
  if (!(volume.asymmetry > -1.0f && volume.asymmetry < 1.0f))
    throw Error(place, fmt::format("an asymmetry of {}; expected between -1 and 1", volume.asymmetry));
}

}  // namespace gloam
