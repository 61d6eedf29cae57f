// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where edges of a mesh enter or leave another body: light ends there, at a line that is in no mesh.
#pragma once

#include "techniques/prt/prt_tessellate_split.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// For SplitMesh::cut, against the rigid surfaces of a scene that have an inside: not double-sided ones. All three must outlive it.
SplitMesh::Crossing crossingsWith(const trace::Tracer& tracer, const Scene& scene, const PosedScene& posed);

}  // namespace gloam::prt
