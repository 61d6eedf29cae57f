// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <map>

#include "frame/gbuffer.h"

namespace gloam::frame {

/// Points that receive light: one for each block of divisor x divisor pixels.
struct ReceiverLevel {
  int divisor = 1, width = 0, height = 0;
  gpu::ImageRef position;      ///< world, float; w: 1, or 0 where the block shows background alone
  gpu::ImageRef normal_depth;  ///< shading normal, float; w: depth along the camera's axis, metres
};

/// Receivers at full, 1/2, 1/4 and 1/8 of the rendering's size, made from the G-buffer when first asked for.
/// A block is represented by the pixel in its middle, or, where that is background, by its first covered one.
class Receivers {
 public:
  Receivers(gpu::FrameGraph& graph, const GBuffer& gbuffer, gpu::BufferRef view)
      : graph_(graph), gbuffer_(gbuffer), view_(view) {}
  /// Adds the pass "frame.receivers_N" unless this frame has it. Divisors are 1, 2, 4 and 8; others: Error.
  const ReceiverLevel& at(int divisor);
  /// Points of someone's own in place of those that at(level.divisor) would make.
  void set(const ReceiverLevel& level) { levels_[level.divisor] = level; }

 private:
  gpu::FrameGraph& graph_;
  const GBuffer& gbuffer_;
  gpu::BufferRef view_;
  std::map<int, ReceiverLevel> levels_;
};

}  // namespace gloam::frame
