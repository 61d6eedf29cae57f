// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/alpha_filter.h"

#include "trace/surface.h"

namespace gloam::trace {
namespace {

// Takes back hits in places that are cut out. Called with 1 to 16 rays.
void dropHoles(const RTCFilterFunctionNArguments* args) {
  const auto& mask = *static_cast<const AlphaMask*>(args->geometryUserPtr);
  const float cutoff = mask.scene->materials[std::size_t(mask.mesh->material)].alpha_cutoff;
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const SurfacePoint point{int(RTCHitN_primID(args->hit, args->N, i)), RTCHitN_u(args->hit, args->N, i),
                             RTCHitN_v(args->hit, args->N, i)};
    if (baseColor(*mask.scene, *mask.mesh, point).a < cutoff) args->valid[i] = 0;
  }
}

}  // namespace

bool hasHoles(const Scene& scene, const Mesh& mesh) {
  const Material& material = scene.materials[std::size_t(mesh.material)];
  return material.alpha_mask &&
         (material.base_color_map || !mesh.colors.empty() || material.base_color.a < material.alpha_cutoff);
}

void setAlphaFilter(RTCGeometry geometry, const AlphaMask& mask) {
  rtcSetGeometryUserData(geometry, const_cast<AlphaMask*>(&mask));
  rtcSetGeometryIntersectFilterFunction(geometry, dropHoles);
  rtcSetGeometryOccludedFilterFunction(geometry, dropHoles);
}

}  // namespace gloam::trace
