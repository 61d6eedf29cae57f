// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What spheres send (gloam/spherical_lights.h), as a frame takes it: samples where their triangles are now, how far each sphere has
// turned, which spheres of one thing meet.
#pragma once

#include <gloam/spherical_lights.h>

#include "frame/emission.h"
#include "renderer/flat_patches.h"

namespace gloam {

class EmissionSet {
 public:
  /// `shares`: of radii, [set][sphere], as spheres are drawn in (proxy_set.h). Throws Error where the emission belongs to other
  /// spheres or to another scene.
  EmissionSet(const Scene& scene, const SceneSpheres& spheres, const SceneEmission& emission,
              const std::vector<std::vector<float>>& shares);
  /// `spheres` as poseSpheres gives them for this pose. Valid as long as this is.
  frame::Emission posed(const PosedScene& posed, std::span<const PosedSphere> spheres) const;

 private:
  struct Point {
    int part = kNone;
    std::uint32_t vertices[3] = {};
    glm::vec3 weights{0.0f};
    glm::vec3 position{0.0f}, normal{0.0f};  // in the object; outward
    float side = 1.0f;
  };
  struct Set {
    std::vector<int> meshes;
    std::vector<Point> points;  // [sphere][direction]
    std::vector<SphereEmission> spheres;
    int words = 0;
    std::vector<std::uint32_t> meets;  // [sphere][word]
    frame::ProxyLevels levels;
  };
  static frame::EmissionPoint place(const Point& point, const Instance& instance, const glm::mat3& normals);

  std::vector<Set> sets_;
  FlatPatches flats_;
  bool glows_ = false;
};

}  // namespace gloam
