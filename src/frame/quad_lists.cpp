// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/quad_lists.h"

#include <algorithm>

namespace gloam::frame {

QuadPlan planQuads(const GBuffer& gbuffer, const ReceiverLevel& level, std::uint32_t most) {
  const auto blocks = [&](int pixels) {
    return (pixels + level.divisor / 2 + level.divisor - 1) / level.divisor;
  };
  QuadPlan plan;
  plan.columns = blocks(gbuffer.width);
  plan.rows = blocks(gbuffer.height);
  plan.divisor = std::uint32_t(level.divisor);
  const std::uint32_t squares =
      std::uint32_t(plan.columns) * std::uint32_t(plan.rows) * plan.divisor * plan.divisor / 4;
  plan.misfits = std::min(squares, most);
  plan.repairs = std::min(2 * squares, most);
  return plan;
}

gpu::BufferRef emptyQuadList(gpu::FrameGraph& graph, const std::string& name, std::uint32_t capacity,
                             std::uint32_t groups_x) {
  const gpu::BufferRef list =
      graph.create(name, gpu::BufferDesc{.bytes = sizeof(QuadList) + 4 * std::size_t(capacity)});
  graph.clear(name, list.slice(0, sizeof(QuadList)), 1);
  if (groups_x != 1) graph.clear(name, list.slice(0, 4), groups_x);
  return list;
}

}  // namespace gloam::frame
