// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "node_moves.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gloam::cli {
namespace {

constexpr const char* kOption = "--move";

std::vector<int> shownNodes(const Scene& scene) {
  std::vector<int> shown = scene.roots;
  for (std::size_t next = 0; next < shown.size(); ++next) {
    const Node& node = scene.nodes[std::size_t(shown[next])];
    shown.insert(shown.end(), node.children.begin(), node.children.end());
  }
  std::ranges::sort(shown);
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return shown;
}

void move(Instance& instance, const glm::mat4& motion) {
  if (!instance.deformed()) {
    instance.world_from_object = motion * instance.world_from_object;
    return;
  }
  const glm::mat3 turn(motion);  // a rotation: the hand does not scale
  for (glm::vec3& p : instance.deformed_positions) p = glm::vec3(motion * glm::vec4(p, 1.0f));
  for (glm::vec3& n : instance.deformed_normals) n = turn * n;
  for (glm::vec4& t : instance.deformed_tangents) t = glm::vec4(turn * glm::vec3(t), t.w);
}

void include(PosedScene& posed, const Instance& instance, const Mesh& mesh) {
  const auto& points = instance.deformed() ? instance.deformed_positions : mesh.positions;
  for (const glm::vec3& p : points) {
    const glm::vec3 world(instance.world_from_object * glm::vec4(p, 1.0f));
    posed.bounds_min = glm::min(posed.bounds_min, world);
    posed.bounds_max = glm::max(posed.bounds_max, world);
  }
}

std::ptrdiff_t countOf(const Scene& scene, const std::string& name) {
  return std::ranges::count(scene.nodes, name, &Node::name);
}

std::string nodeText(const Scene& scene, int node) {
  const std::string& name = scene.nodes[std::size_t(node)].name;
  const bool clear = !name.empty() && name[0] != '#' && countOf(scene, name) == 1;
  return clear ? name : fmt::format("#{}", node);
}

int nodeOf(const Scene& scene, const std::string& text) {
  if (text.starts_with('#')) {
    std::size_t index = 0;
    const auto [end, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    if (problem == std::errc{} && end == text.data() + text.size() && index < scene.nodes.size())
      return int(index);
    throw Error(kOption, fmt::format("no node '{}': the scene has {}, from #0 on", text, scene.nodes.size()));
  }
  const std::ptrdiff_t count = countOf(scene, text);
  if (count > 1)
    throw Error(kOption, fmt::format("{} nodes are called '{}'; expected # and an index", count, text));
  const auto found = std::ranges::find(scene.nodes, text, &Node::name);
  if (found != scene.nodes.end()) return int(found - scene.nodes.begin());
  std::vector<std::string> names;
  for (const Node& node : scene.nodes) names.push_back(node.name);
  throw Error(kOption, fmt::format("no node '{}'{}; expected a name or # and an index", text,
                                   didYouMean(text, names)));
}

}  // namespace

glm::mat4 motionOf(const Scene& scene, const NodeMoves& moves, int node) {
  glm::mat4 motion(1.0f);
  for (; node != kNone; node = scene.nodes[std::size_t(node)].parent) {
    const auto found = moves.find(node);
    if (found != moves.end()) motion = found->second * motion;
  }
  return motion;
}

void moveNode(const Scene& scene, NodeMoves& moves, int node, const glm::mat4& motion) {
  const glm::mat4 above = motionOf(scene, moves, scene.nodes[std::size_t(node)].parent);
  const auto [own, unused] = moves.try_emplace(node, 1.0f);
  own->second = glm::inverse(above) * motion * above * own->second;
}

std::vector<int> lightNodes(const Scene& scene) {
  std::vector<int> nodes;
  for (const int node : shownNodes(scene)) {
    if (scene.nodes[std::size_t(node)].light != kNone) nodes.push_back(node);
  }
  return nodes;
}

PosedScene poseMoved(const Scene& scene, const NodeMoves& moves, float time_s) {
  PosedScene posed = pose(scene, time_s);
  if (moves.empty()) return posed;
  for (Instance& instance : posed.instances) {
    const glm::mat4 motion = motionOf(scene, moves, instance.node);
    if (motion == glm::mat4(1.0f)) continue;
    move(instance, motion);
    include(posed, instance, scene.meshes[std::size_t(instance.mesh)]);
  }
  const std::vector<int> lights = lightNodes(scene);
  for (std::size_t i = 0; i < std::min(posed.lights.size(), lights.size()); ++i) {
    const glm::mat4 motion = motionOf(scene, moves, lights[i]);
    posed.lights[i].position = glm::vec3(motion * glm::vec4(posed.lights[i].position, 1.0f));
    posed.lights[i].direction = glm::mat3(motion) * posed.lights[i].direction;
  }
  return posed;
}

MoveText parseMove(const std::string& text) {
  const std::size_t equals = text.rfind('=');  // names may hold one
  const Error wrong(kOption, fmt::format("'{}': expected NODE=X,Y,Z or NODE=X,Y,Z,QX,QY,QZ,QW", text));
  if (equals == std::string::npos || equals == 0) throw wrong;
  std::vector<float> values;
  for (std::size_t at = equals + 1; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    values.push_back(float(parseNumber(kOption, text.substr(at, comma - at), {-1e9, 1e9})));
    at = comma + 1;
  }
  if (values.size() != 3 && values.size() != 7) throw wrong;
  glm::mat4 motion = glm::translate(glm::mat4(1.0f), {values[0], values[1], values[2]});
  if (values.size() == 7) {
    const glm::quat turn(values[6], values[3], values[4], values[5]);
    if (!(glm::length(turn) > 1e-6f)) throw wrong;
    motion *= glm::mat4_cast(glm::normalize(turn));
  }
  return {text.substr(0, equals), motion};
}

NodeMoves movesIn(const Scene& scene, const std::vector<MoveText>& texts) {
  NodeMoves moves;
  for (const MoveText& text : texts) {
    const auto [own, unused] = moves.try_emplace(nodeOf(scene, text.node), 1.0f);
    own->second = text.motion * own->second;
  }
  return moves;
}

std::vector<std::string> moveTexts(const Scene& scene, const NodeMoves& moves) {
  std::vector<std::string> texts;
  for (const auto& [node, motion] : moves) {
    const glm::vec3 shift(motion[3]);
    const glm::quat turn = glm::normalize(glm::quat_cast(glm::mat3(motion)));
    std::string text = fmt::format("{}={},{},{}", nodeText(scene, node), shift.x, shift.y, shift.z);
    if (glm::mat3(motion) != glm::mat3(1.0f))
      text += fmt::format(",{},{},{},{}", turn.x, turn.y, turn.z, turn.w);
    texts.push_back(std::move(text));
  }
  return texts;
}

void addMoveOption(CLI::App& app, std::vector<MoveText>& moves) {
  const auto read = [&moves](const std::vector<std::string>& texts) {
    moves.clear();
    for (const std::string& text : texts) moves.push_back(parseMove(text));
  };
  app.add_option_function<std::vector<std::string>>(kOption, read,
                                                    "moves a node of the scene, with all below it, by metres "
                                                    "of the world; a quaternion behind them turns "
                                                    "it about the origin before; as often as wanted")
      ->type_name("NODE=X,Y,Z")
      ->allow_extra_args(false)
      ->group("View");
}

}  // namespace gloam::cli
