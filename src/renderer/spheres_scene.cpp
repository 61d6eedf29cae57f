// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/spheres_scene.h"

#include <fmt/core.h>

#include "renderer/proxy_set.h"
#include "scene/builtin_shapes.h"

namespace gloam {

namespace {

constexpr int kFrequency = 16;  // 5,120 triangles: within 0.2 % of a sphere's radius

}  // namespace

Scene spheresInPlace(const Scene& scene, const SceneSpheres& spheres, const PosedScene& posed) {
  const std::vector<frame::Proxy> proxies = ProxySet(scene, spheres).posed(posed);
  Scene result = scene;
  for (const SphereSet& set : spheres.sets) {
    if (set.spheres.empty()) continue;
    for (const int n : set.nodes) {
      Node& node = result.nodes.at(std::size_t(n));
      node.meshes.clear(), node.skin = kNone;
    }
  }
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    const frame::Proxy& proxy = proxies[i];
    Material material;
    material.name = fmt::format("sphere {}", i);
    material.base_color = glm::vec4(proxy.albedo, 1.0f);
    material.metallic = 0.0f, material.roughness = 1.0f;
    material.specular = 0.0f;
    Mesh mesh = shapes::moved(shapes::icosphere(proxy.radius, kFrequency), proxy.center);
    mesh.name = material.name;
    mesh.material = int(result.materials.size());
    Node node;
    node.name = material.name;
    node.meshes = {int(result.meshes.size())};
    result.materials.push_back(std::move(material));
    result.meshes.push_back(std::move(mesh));
    result.roots.push_back(int(result.nodes.size()));
    result.nodes.push_back(std::move(node));
  }
  return result;
}

}  // namespace gloam
