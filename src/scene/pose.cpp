// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A scene at one instant: nodes animated and placed, meshes instanced and deformed, cameras and lights put
// where they stand.
#include <gloam/scene.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "math/box.h"
#include "scene/animation.h"
#include "scene/deform.h"
#include "scene/transforms.h"

namespace gloam {
namespace {

// A node's own state at the time: what animation moves.
struct NodeState {
  Trs trs;
  std::optional<glm::mat4> matrix;
  std::vector<float> morph_weights;
  bool morph_animated = false;
  glm::mat4 local() const { return matrix ? *matrix : composeTrs(trs); }
};

// glTF forbids animating a node that has a matrix; where it happens the matrix is taken apart first.
Trs& animatedTrs(NodeState& state) {
  if (state.matrix) {
    state.trs = decomposeTrs(*state.matrix).value_or(Trs{glm::vec3((*state.matrix)[3])});
    state.matrix.reset();
  }
  return state.trs;
}

void applyChannel(const AnimationChannel& channel, const std::vector<float>& value, NodeState& state) {
  using Path = AnimationChannel::Path;
  switch (channel.path) {
    case Path::kTranslation:
      animatedTrs(state).translation = {value[0], value[1], value[2]};
      break;
    case Path::kRotation:
      animatedTrs(state).rotation = glm::quat(value[3], value[0], value[1], value[2]);
      break;
    case Path::kScale:
      animatedTrs(state).scale = {value[0], value[1], value[2]};
      break;
    case Path::kWeights:
      state.morph_weights = value;
      state.morph_animated = true;
      break;
  }
}

std::vector<NodeState> nodeStates(const Scene& scene, float time_s) {
  std::vector<NodeState> states(scene.nodes.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Node& node = scene.nodes[i];
    states[i].trs = {node.translation, node.rotation, node.scale};
    states[i].matrix = node.matrix;
    states[i].morph_weights = node.morph_weights;
  }
  std::vector<float> value;
  for (const AnimationChannel* channel : channelsInPlay(scene)) {
    sampleChannel(*channel, time_s, value);
    applyChannel(*channel, value, states[std::size_t(channel->node)]);
  }
  return states;
}

// Parents before children. Nodes outside the shown scene are placed too: joints may lie there.
std::vector<int> topologicalOrder(const Scene& scene) {
  std::vector<int> order;
  order.reserve(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].parent == kNone) order.push_back(int(i));
  }
  for (std::size_t next = 0; next < order.size(); ++next) {
    const Node& node = scene.nodes[std::size_t(order[next])];
    order.insert(order.end(), node.children.begin(), node.children.end());
  }
  return order;
}

std::vector<int> shownNodes(const Scene& scene) {
  std::vector<int> shown = scene.roots;
  for (std::size_t next = 0; next < shown.size(); ++next) {
    const Node& node = scene.nodes[std::size_t(shown[next])];
    shown.insert(shown.end(), node.children.begin(), node.children.end());
  }
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return shown;
}

bool isMorphed(const Mesh& mesh, const NodeState& state) {
  if (mesh.morph_targets.empty()) return false;
  return state.morph_animated || std::any_of(state.morph_weights.begin(), state.morph_weights.end(),
                                             [](float w) { return w != 0.0f; });
}

void addInstances(const Scene& scene, int node_index, const NodeState& state,
                  const std::vector<glm::mat4>& world, PosedScene& posed) {
  const Node& node = scene.nodes[std::size_t(node_index)];
  std::vector<glm::mat4> world_from_mesh;
  if (node.skin != kNone) {
    const Skin& skin = scene.skins[std::size_t(node.skin)];
    world_from_mesh.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      world_from_mesh.push_back(world[std::size_t(skin.joints[j])] * skin.joint_from_mesh[j]);
    }
  }
  for (const int mesh_index : node.meshes) {
    const Mesh& mesh = scene.meshes[std::size_t(mesh_index)];
    const bool skinned = !world_from_mesh.empty() && mesh.influences > 0;
    const bool deformed = skinned || isMorphed(mesh, state);
    // Joints alone place a skinned mesh: copies of it would coincide.
    const std::size_t copies = skinned || node.instances.empty() ? 1 : node.instances.size();
    for (std::size_t copy = 0; copy < copies; ++copy) {
      Instance instance;
      instance.mesh = mesh_index;
      instance.node = node_index;
      glm::mat4 placed = world[std::size_t(node_index)];
      if (!skinned && !node.instances.empty()) placed = placed * node.instances[copy];
      if (deformed) {
        deformMesh(mesh, state.morph_weights,
                   skinned ? std::span<const glm::mat4>(world_from_mesh) : std::span<const glm::mat4>(),
                   placed, instance);
      } else {
        instance.world_from_object = placed;
      }
      posed.instances.push_back(std::move(instance));
    }
  }
}

// A camera or a light takes the node's place and direction, not its scale.
glm::mat4 unscaled(const glm::mat4& world) {
  glm::mat3 axes = rotationFactor(world);
  if (glm::determinant(axes) < 0.0f) axes[0] = -axes[0];
  glm::mat4 m(axes);
  m[3] = world[3];
  return m;
}

Box boundsOf(const Instance& instance, const Mesh& mesh) {
  const std::vector<glm::vec3>& points = instance.deformed() ? instance.deformed_positions : mesh.positions;
  const glm::mat4& world = instance.world_from_object;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, points.size(), 4096), Box{},
      [&](const auto& range, Box box) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          box.add(glm::vec3(world * glm::vec4(points[i], 1.0f)));
        return box;
      },
      [](Box a, const Box& b) {
        a.add(b);
        return a;
      });
}

}  // namespace

PosedScene pose(const Scene& scene, float time_s) {
  const std::vector<NodeState> states = nodeStates(scene, time_s);
  std::vector<glm::mat4> world(scene.nodes.size(), glm::mat4(1.0f));
  for (const int i : topologicalOrder(scene)) {
    const int parent = scene.nodes[std::size_t(i)].parent;
    const glm::mat4 local = states[std::size_t(i)].local();
    world[std::size_t(i)] = parent == kNone ? local : world[std::size_t(parent)] * local;
  }
  PosedScene posed;
  posed.time_s = time_s;
  for (const int i : shownNodes(scene)) {
    const Node& node = scene.nodes[std::size_t(i)];
    addInstances(scene, i, states[std::size_t(i)], world, posed);
    if (node.camera == kNone && node.light == kNone) continue;
    const glm::mat4 placed = unscaled(world[std::size_t(i)]);
    if (node.camera != kNone) posed.cameras.push_back({scene.cameras[std::size_t(node.camera)], placed});
    if (node.light != kNone) {
      posed.lights.push_back(
          {scene.lights[std::size_t(node.light)], glm::vec3(placed[3]), -glm::vec3(placed[2])});
    }
  }
  Box bounds;
  for (const Instance& instance : posed.instances) {
    bounds.add(boundsOf(instance, scene.meshes[std::size_t(instance.mesh)]));
  }
  if (!bounds.empty()) {
    posed.bounds_min = bounds.low;
    posed.bounds_max = bounds.high;
  }
  return posed;
}

}  // namespace gloam
