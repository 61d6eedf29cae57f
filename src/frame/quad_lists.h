// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "frame/gbuffer.h"
#include "frame/quads_shared.h"
#include "frame/receivers.h"

namespace gloam::frame {

/// Blocks of pixels between the same four receivers of a level (four_receivers.glsl), which begin half a block before the picture, and
/// what lists of their squares of 2 x 2 pixels have room for: at most `most`, since more cannot be dispatched over.
struct QuadPlan {
  int columns = 0, rows = 0;
  std::uint32_t divisor = 1;
  std::uint32_t misfits = 0, repairs = 0;  ///< squares; surfaces in squares, which may have several
  UpsampleParams upsampleParams() const { return {divisor, misfits}; }
  WidenParams widenParams() const { return {divisor, misfits, repairs}; }
};
QuadPlan planQuads(const GBuffer& gbuffer, const ReceiverLevel& level, std::uint32_t most);

/// A QuadList and room for that many squares after it; empty, as count_and_one says, and so with the other three at their first values.
gpu::BufferRef emptyQuadList(gpu::FrameGraph& graph, const std::string& name, std::uint32_t capacity,
                             std::uint32_t groups_x = 1);

}  // namespace gloam::frame
