// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The surface that a sphere set stands for: points of it, and which way it looks.
#pragma once

#include <gloam/spheres.h>

#include <vector>

#include "trace/surface.h"

namespace gloam {

struct AreaPoint {
  int mesh;
  trace::SurfacePoint point;
};

/// Spread evenly by area over all meshes of a set; none where it has no area.
std::vector<AreaPoint> pointsByArea(const Scene& scene, const SphereSet& set, std::size_t count);
/// In shape space.
glm::vec3 placeOf(const Scene& scene, const SphereSet& set, const AreaPoint& at);
/// Unit, in shape space, as the triangle winds; 0 where it has no area.
glm::vec3 normalOf(const Scene& scene, const SphereSet& set, const AreaPoint& at);
/// 1 where faces look outward, -1 where inward.
float facing(const Scene& scene, const SphereSet& set);

}  // namespace gloam
