// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_tessellate_cut.h"

namespace gloam::prt {
namespace {

/// Shares of an edge: how near its ends nothing is cut, and how far above its triangles it is looked along: what stands upon a
/// surface, and does not reach into it, is met as well.
constexpr double kEnds = 0.02, kLift = 1e-4;
/// Surfaces that an edge runs along are its own, or as good as coplanar: cosine to the normal.
constexpr float kGrazing = 0.05f;
constexpr int kMostGrazed = 8;

bool isSheet(const Scene& scene, const PosedScene& posed, int instance) {
  const int material = scene.meshes[std::size_t(posed.instances[std::size_t(instance)].mesh)].material;
  return material != kNone && scene.materials[std::size_t(material)].double_sided;
}

}  // namespace

SplitMesh::Crossing crossingsWith(const trace::Tracer& tracer, const Scene& scene, const PosedScene& posed) {
  return [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal) {
    const double length = glm::distance(a, b);
    if (!(length > 0.0)) return 0.0;
    const glm::vec3 way((b - a) / length);
    float begin = float(kEnds * length);
    for (int k = 0; k < kMostGrazed; ++k) {
      const trace::Hit hit = tracer.closest({.origin = glm::vec3(a + kLift * length * normal),
                                             .direction = way,
                                             .t_near = begin,
                                             .t_far = float((1.0 - kEnds) * length)});
      if (!hit) return 0.0;
      if (std::abs(glm::dot(hit.geometric_normal, way)) > kGrazing && !isSheet(scene, posed, hit.instance))
        return double(hit.distance) / length;
      begin = hit.distance + float(1e-4 * length);
    }
    return 0.0;
  };
}

}  // namespace gloam::prt
