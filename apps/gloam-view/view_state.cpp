// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "view_state.h"

#include <algorithm>

namespace gloam::view {
namespace {

glm::vec3 middleOf(const std::vector<glm::vec3>& points) {
  if (points.empty()) return glm::vec3(0.0f);
  glm::vec3 low = points.front(), high = low;
  for (const glm::vec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
  return (low + high) * 0.5f;
}

}  // namespace

std::shared_ptr<const LoadedScene> makeLoadedScene(LoadedScene given) {
  auto loaded = std::make_shared<LoadedScene>(std::move(given));
  const Scene& scene = loaded->scene;
  loaded->light_nodes = cli::lightNodes(scene);
  for (const Instance& instance : pose(scene, 0.0f).instances)
    loaded->instance_nodes.push_back(instance.node);
  for (const Mesh& mesh : scene.meshes) loaded->mesh_middles.push_back(middleOf(mesh.positions));
  return loaded;
}

std::shared_ptr<const LoadedScene> fittedScene(const std::shared_ptr<const LoadedScene>& loaded) {
  if (!loaded->unbaked) return loaded;
  const Scene &baked = loaded->scene, &before = loaded->unbaked->scene;
  const auto same = [](const Mesh& a, const Mesh& b) {
    return a.positions == b.positions && a.indices == b.indices;
  };
  const bool fits =
      baked.nodes.size() == before.nodes.size() &&
      std::equal(baked.meshes.begin(), baked.meshes.end(), before.meshes.begin(), before.meshes.end(), same);
  return fits ? loaded->unbaked : loaded;
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
