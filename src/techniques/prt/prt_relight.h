// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// All vertices' transfer times the distant light, each frame.
#pragma once

#include <gloam/sh.h>
#include "techniques/prt/prt_transfer.h"

namespace gloam::prt {

/// Adds "prt.vertices", once a chunk: irradiance of all vertices (VertexLight), by a compute pass or on the host as the options of
/// `transfer` say. `light` has its bands; `all_bands` is the light as it is, for `damping` where it rings.
gpu::BufferRef lightVertices(gpu::FrameGraph& graph, const frame::GpuScene& scene,
                             const TransferBuffers& transfer, const sh::ShRgb& light,
                             const sh::ShRgb& all_bands, bool damping);

}  // namespace gloam::prt
