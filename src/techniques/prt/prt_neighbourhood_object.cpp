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

/// By those of markBelow(): whether animation moves one of them.
bool animationMoves(const Scene& scene, const std::vector<std::uint8_t>& below) {
  return std::ranges::any_of(channelsInPlay(scene), [&](const AnimationChannel* channel) {
    return channel->path != AnimationChannel::Path::kWeights && below[std::size_t(channel->node)];
  });
}

constexpr int kInstants = 33;  // of the whole animation, at which is asked who stands near whom

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& box, const glm::mat4& placed) {
    for (int c = 0; c < 8 && box.low.x <= box.high.x; ++c) {
      const glm::vec3 corner(c & 1 ? box.high.x : box.low.x, c & 2 ? box.high.y : box.low.y,
                             c & 4 ? box.high.z : box.low.z);
      add(glm::vec3(placed * glm::vec4(corner, 1.0f)));
    }
  }
  Box widened(float lengths) const {
    const glm::vec3 side = high - low, more(lengths * std::max({side.x, side.y, side.z}));
    return {low - more, high + more};
  }
  bool touches(const Box& other) const {
    return glm::all(glm::lessThanEqual(low, other.high)) && glm::all(glm::lessThanEqual(other.low, high));
  }
};

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

std::vector<int> neighbourhoodNodesThatMeet(const Scene& scene, float reach, float time_s) {
  const std::vector<int> nodes = neighbourhoodNodes(scene, time_s);
  std::vector<std::vector<std::uint8_t>> below;
  std::vector<std::uint8_t> moves, meets;
  for (const int node : nodes) {
    below.push_back(markBelow(scene, node));
    moves.push_back(animationMoves(scene, below.back()));
  }
  meets = moves;
  std::vector<Box> of_meshes;
  for (const Mesh& mesh : scene.meshes) {
    Box& box = of_meshes.emplace_back();
    for (const glm::vec3& p : mesh.positions) box.add(p);
  }
  const float end = scene.duration_s();
  for (int instant = 0; instant < kInstants; ++instant) {
    const PosedScene posed = pose(scene, end * float(instant) / float(kInstants - 1));
    std::vector<Box> boxes(nodes.size());
    for (const Instance& instance : posed.instances) {
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (below[i][std::size_t(instance.node)])
          boxes[i].add(of_meshes[std::size_t(instance.mesh)], instance.world_from_object);
      }
    }
    for (std::size_t m = 0; m < nodes.size(); ++m) {
      for (std::size_t i = 0; i < nodes.size() && moves[m]; ++i)
        meets[i] = meets[i] || boxes[i].touches(boxes[m].widened(reach));
    }
  }
  std::vector<int> chosen;
  for (const bool moving : {true, false}) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (meets[i] && bool(moves[i]) == moving) chosen.push_back(nodes[i]);
  }
  return chosen;
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
  const glm::vec3 side = object.bounds_max - object.bounds_min;
  if (!(std::max({side.x, side.y, side.z}) > 1e-18f))
    throw Error(place, "all of its triangles lie in one point: there is no room for a grid");
  return object;
}

}  // namespace prt
}  // namespace gloam
