// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which nodes carry a neighbourhood, and what stands at and below one of them, in its own axes.
#include <fmt/format.h>

#include <algorithm>

#include "scene/animation.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_apart.h"
#include "techniques/prt/prt_neighbourhood_trace.h"

namespace gloam {
namespace {

glm::mat4 localAt(const Scene& scene, std::size_t index, float time_s) {
  const Node& node = scene.nodes[index];
  Trs trs{node.translation, node.rotation, node.scale};
  if (node.matrix) trs = decomposeTrs(*node.matrix).value_or(Trs{});
  bool moved = false;
  std::vector<float> v;
  for (const AnimationChannel* channel : channelsInPlay(scene)) {
    if (channel->node != int(index) || channel->path == AnimationChannel::Path::kWeights) continue;
    moved = true;
    sampleChannel(*channel, time_s, v);
    if (channel->path == AnimationChannel::Path::kRotation) trs.rotation = {v[3], v[0], v[1], v[2]};
    if (channel->path == AnimationChannel::Path::kTranslation) trs.translation = {v[0], v[1], v[2]};
    if (channel->path == AnimationChannel::Path::kScale) trs.scale = {v[0], v[1], v[2]};
  }
  return node.matrix && !moved ? *node.matrix : composeTrs(trs);
}

glm::mat4 worldOfNode(const Scene& scene, int node, float time_s) {
  glm::mat4 world(1.0f);
  for (; node != kNone; node = scene.nodes[std::size_t(node)].parent)
    world = localAt(scene, std::size_t(node), time_s) * world;
  return world;
}

/// By node: whether it is the given one or lies below it.
std::vector<std::uint8_t> markBelow(const Scene& scene, int node) {
  std::vector<std::uint8_t> below(scene.nodes.size(), 0);
  std::vector<int> open = {node};
  while (!open.empty()) {
    const std::size_t n = std::size_t(open.back());
    open.pop_back();
    if (below[n]) continue;
    below[n] = 1;
    open.insert(open.end(), scene.nodes[n].children.begin(), scene.nodes[n].children.end());
  }
  return below;
}

}  // namespace

std::vector<int> neighbourhoodNodes(const Scene& scene, float time_s) {
  const std::vector<int> object = prt::objectsOfNodes(scene, pose(scene, time_s));
  std::vector<int> nodes;
  for (std::size_t n = 0; n < object.size(); ++n) {
    const int parent = scene.nodes[n].parent;
    if (object[n] != kNone && (parent == kNone || object[std::size_t(parent)] == kNone))
      nodes.push_back(int(n));
  }
  return nodes;
}

bool animationMoves(const Scene& scene, int node) {
  const std::vector<std::uint8_t> below = markBelow(scene, node);
  return std::ranges::any_of(channelsInPlay(scene), [&](const AnimationChannel* channel) {
    return channel->path != AnimationChannel::Path::kWeights && below[std::size_t(channel->node)];
  });
}

namespace prt {

NeighbourhoodObject neighbourhoodObject(const Scene& scene, int node, float time_s) {
  const std::string place = "node '" + scene.nodes.at(std::size_t(node)).name + "'";
  const PosedScene posed = pose(scene, time_s);
  const std::vector<std::uint8_t> below = markBelow(scene, node);
  const glm::mat4 world_from_node = worldOfNode(scene, node, time_s);
  const glm::mat3 turn = rotationFactor(world_from_node);
  glm::mat4 axes_from_world(glm::transpose(turn));
  axes_from_world[3] = glm::vec4(-(glm::transpose(turn) * glm::vec3(world_from_node[3])), 1.0f);
  NeighbourhoodObject object;
  object.scale = glm::transpose(turn) * glm::mat3(world_from_node);
  if (!(std::abs(glm::determinant(object.scale)) > 1e-30f))
    throw Error(place, "its scale is 0: there is no room for a grid");
  const glm::mat3 node_from_axes = glm::inverse(object.scale);
  object.bounds_min = glm::vec3(std::numeric_limits<float>::max());
  object.bounds_max = -object.bounds_min;
  for (Instance instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (!below[std::size_t(instance.node)] || instance.deformed() || mesh.indices.empty()) continue;
    instance.world_from_object = axes_from_world * instance.world_from_object;
    for (const std::uint32_t v : mesh.indices) {
      const glm::vec3 p(instance.world_from_object * glm::vec4(mesh.positions[v], 1.0f));
      object.bounds_min = glm::min(object.bounds_min, node_from_axes * p);
      object.bounds_max = glm::max(object.bounds_max, node_from_axes * p);
    }
    object.triangles += mesh.triangleCount();
    object.vertices += mesh.vertexCount();
    object.posed.instances.push_back(std::move(instance));
  }
  if (object.posed.instances.empty())
    throw Error(place, "there are no rigid triangles at or below it that could throw a shadow");
  return object;
}

}  // namespace prt
}  // namespace gloam
