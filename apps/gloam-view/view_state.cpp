// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "view_state.h"

#include <algorithm>

namespace gloam::view {
namespace {

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

glm::vec3 middleOf(const std::vector<glm::vec3>& points) {
  if (points.empty()) return glm::vec3(0.0f);
  glm::vec3 low = points.front(), high = low;
  for (const glm::vec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
  return (low + high) * 0.5f;
}

}  // namespace

std::shared_ptr<const LoadedScene> makeLoadedScene(std::string name, bool ground, Scene scene) {
  auto loaded = std::make_shared<LoadedScene>();
  loaded->name = std::move(name);
  loaded->ground = ground;
  for (const int node : shownNodes(scene)) {
    if (scene.nodes[std::size_t(node)].light != kNone) loaded->light_nodes.push_back(node);
  }
  for (const Instance& instance : pose(scene, 0.0f).instances)
    loaded->instance_nodes.push_back(instance.node);
  for (const Mesh& mesh : scene.meshes) loaded->mesh_middles.push_back(middleOf(mesh.positions));
  loaded->scene = std::move(scene);
  return loaded;
}

std::vector<glm::vec3> instancePlaces(const LoadedScene& loaded, const PosedScene& posed) {
  std::vector<glm::vec3> places;
  for (const Instance& instance : posed.instances) {
    places.push_back(instance.deformed()
                         ? middleOf(instance.deformed_positions)
                         : glm::vec3(instance.world_from_object *
                                     glm::vec4(loaded.mesh_middles[std::size_t(instance.mesh)], 1.0f)));
  }
  return places;
}

glm::mat4 motionOf(const Scene& scene, const NodeEdits& edits, int node) {
  glm::mat4 motion(1.0f);
  for (; node != kNone; node = scene.nodes[std::size_t(node)].parent) {
    const auto edit = edits.find(node);
    if (edit != edits.end()) motion = edit->second.world_from_placed * motion;
  }
  return motion;
}

void moveNode(const Scene& scene, NodeEdits& edits, int node, const glm::mat4& motion) {
  const glm::mat4 above = motionOf(scene, edits, scene.nodes[std::size_t(node)].parent);
  NodeEdit& edit = edits[node];
  edit.world_from_placed = glm::inverse(above) * motion * above * edit.world_from_placed;
}

PosedScene poseEdited(const LoadedScene& loaded, const NodeEdits& edits, float time_s) {
  PosedScene posed = pose(loaded.scene, time_s);
  if (edits.empty()) return posed;
  for (Instance& instance : posed.instances) {
    const glm::mat4 motion = motionOf(loaded.scene, edits, instance.node);
    if (motion == glm::mat4(1.0f)) continue;
    move(instance, motion);
    include(posed, instance, loaded.scene.meshes[std::size_t(instance.mesh)]);
  }
  for (std::size_t i = 0; i < std::min(posed.lights.size(), loaded.light_nodes.size()); ++i) {
    const glm::mat4 motion = motionOf(loaded.scene, edits, loaded.light_nodes[i]);
    posed.lights[i].position = glm::vec3(motion * glm::vec4(posed.lights[i].position, 1.0f));
    posed.lights[i].direction = glm::mat3(motion) * posed.lights[i].direction;
  }
  return posed;
}

Environment describedLight(const ViewState& state) {
  std::vector<DistantLight> lights = state.lights.at(state.time_s);
  if (state.base && !state.base->map->empty()) {
    DistantLight base = *state.base;
    base.rotation_rad += glm::radians(state.env_rotation_deg);
    base.intensity *= state.env_intensity;
    lights.insert(lights.begin(), std::move(base));
  }
  return describeLights(std::move(lights));
}

Environment paintedLight(const ViewState& state) {
  Environment environment;
  if (state.base) {
    environment = *state.base->map;
    environment.rotation_rad += state.base->rotation_rad + glm::radians(state.env_rotation_deg);
    environment.intensity *= state.base->intensity * state.env_intensity;
  }
  return state.lights.empty() ? environment : paintLights(environment, state.lights.at(state.time_s));
}

}  // namespace gloam::view
