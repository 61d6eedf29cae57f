// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene_light.h"

#include <fmt/ranges.h>
#include <scene/coverage.h>

#include <algorithm>

namespace gloam::cli {
namespace {

float brightest(const glm::vec3& color) {
  return std::max({color.r, color.g, color.b});
}

}  // namespace

bool glows(const Scene& scene, int index) {
  const Mesh& mesh = scene.meshes[std::size_t(index)];
  return !mesh.indices.empty() && brightest(scene.materials[std::size_t(mesh.material)].emission) > 0.0f;
}

Coverage lightIn(const Scene& scene, const PosedScene& posed, const Environment& environment, int bounces) {
  Coverage light;
  light.environment_direct = !environment.empty() && environment.intensity > 0.0f;
  light.local_direct = std::ranges::any_of(
      posed.lights, [](const PosedLight& lamp) { return brightest(lamp.light.intensity) > 0.0f; });
  const std::vector<bool> glowing = glowingInstances(scene, posed);
  light.emitter_direct = std::ranges::find(glowing, true) != glowing.end();
  light.environment_indirect = light.environment_direct && bounces > 0;
  light.local_indirect = light.local_direct && bounces > 0;
  light.emitter_indirect = light.emitter_direct && bounces > 0;
  return light;
}

std::vector<bool> glowingInstances(const Scene& scene, const PosedScene& posed) {
  std::vector<bool> glowing;
  for (const Instance& instance : posed.instances) glowing.push_back(glows(scene, instance.mesh));
  return glowing;
}

void remarkDark(const TechniqueInfo& technique, const Settings& settings, const Coverage& in_scene,
                Console& console) {
  if (in_scene == Coverage{}) {
    console.remark("nothing in the scene sends light: all is black but what is behind it");
    return;
  }
  const Coverage covers = coverageWith(technique, settings);
  if (both(covers, in_scene) != Coverage{}) return;
  console.remark(fmt::format("{} has no light here: {} {}, the scene has {}", technique.name,
                             covers == technique.covers ? "it covers" : "with these options it covers",
                             fmt::join(coverageNames(covers), ", "),
                             fmt::join(coverageNames(in_scene), ", ")));
}

}  // namespace gloam::cli
