// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Holes of alpha-masked materials: a filter that the tracing library asks at every candidate hit. Geometry without holes
// has none, since a filter costs a call a hit.
#pragma once

#include <gloam/scene.h>

#include "trace/embree.h"

namespace gloam::trace {

/// What the filter needs to know of one instance; has to live as long as the geometry.
struct AlphaMask {
  const Scene* scene = nullptr;
  const Mesh* mesh = nullptr;
};

/// Whether hits of this mesh have to be asked at all.
bool hasHoles(const Scene& scene, const Mesh& mesh);
/// Installs the filter for closest hits and for occlusion.
void setAlphaFilter(RTCGeometry geometry, const AlphaMask& mask);

}  // namespace gloam::trace
