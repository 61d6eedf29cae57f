// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sphere sets as a frame takes them: where they are now, drawn in to shadow as much as the model (shadow_radii.h), and what colour
// they send back (PX-9).
#pragma once

#include <gloam/spheres.h>

#include "frame/proxy.h"
#include "renderer/flat_patches.h"

namespace gloam {

class ProxySet {
 public:
  /// Keeps what posing needs, not the scene. Throws Error where the sets belong to another scene.
  ProxySet(const Scene& scene, const SceneSpheres& spheres);
  /// In the order of poseSpheres, which it gives with radii drawn in. Throws Error where the pose does not fit.
  std::vector<PosedSphere> drawnIn(const PosedScene& posed) const;
  /// The same as a frame takes them.
  std::vector<frame::Proxy> posed(const PosedScene& posed) const;
  std::vector<frame::Proxy> proxiesOf(std::span<const PosedSphere> drawn_in) const;
  /// What has no spheres, as blockers of light (flat_patches.h).
  std::vector<frame::Patch> flats(const PosedScene& posed) const { return flats_.blockers(posed); }
  const SceneSpheres& spheres() const { return spheres_; }
  /// Of radii, as they are drawn in: [set][sphere].
  const std::vector<std::vector<float>>& shares() const { return shares_; }

 private:
  SceneSpheres spheres_;
  Scene scene_;                                  // nodes, and places of the vertices that spheres follow
  std::vector<std::vector<glm::vec3>> albedos_;  // [set][sphere]
  std::vector<std::vector<float>> shares_;       // of radii; the same
  std::vector<std::vector<float>> bulges_;       // of widths; the same
  FlatPatches flats_;
};

/// Mean diffuse albedo of the surface near each sphere of a set (nearest by |p - c| / r), textures and vertex colours
/// included; 0 to 1, linear.
std::vector<glm::vec3> sphereAlbedos(const Scene& scene, const SphereSet& set);

}  // namespace gloam
