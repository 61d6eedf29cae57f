// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "outline.h"

#include <algorithm>
#include <array>

namespace gloam::view {
namespace {

using Mask = std::vector<std::uint8_t>;

/// Where the mask is set within `reach` pixels to either side, `stride` apart, along lines of `length` pixels.
Mask widened(const Mask& mask, int lines, int line_stride, int length, int stride, int reach) {
  Mask wide(mask.size(), 0);
  for (int line = 0; line < lines; ++line) {
    int since = reach + 1;  // pixels after the last one that was set
    for (int i = -reach; i < length; ++i) {
      const int ahead = i + reach;
      const bool set =
          ahead < length &&
          mask[std::size_t(line) * std::size_t(line_stride) + std::size_t(ahead) * std::size_t(stride)] != 0;
      since = set ? -2 * reach : since + 1;
      if (i >= 0 && since <= 0)
        wide[std::size_t(line) * std::size_t(line_stride) + std::size_t(i) * std::size_t(stride)] = 1;
    }
  }
  return wide;
}

Mask widened(const Mask& mask, int width, int height, int reach) {
  return widened(widened(mask, height, width, width, 1, reach), width, 1, height, width, reach);
}

}  // namespace

std::vector<bool> instancesBelow(const Scene& scene, const std::vector<int>& instance_nodes, int node) {
  std::vector<bool> below;
  for (int at : instance_nodes) {
    while (at != kNone && at != node) at = scene.nodes[std::size_t(at)].parent;
    below.push_back(at == node && node != kNone);
  }
  return below;
}

void drawOutline(std::vector<std::uint8_t>& rgba, int width, int height,
                 const std::vector<std::uint32_t>& ids, const std::vector<bool>& chosen) {
  const std::size_t count = std::size_t(std::max(width, 0)) * std::size_t(std::max(height, 0));
  if (ids.size() != count || rgba.size() != 4 * count) return;
  Mask mask(count, 0);
  for (std::size_t i = 0; i < count; ++i)
    mask[i] = ids[i] > 0 && ids[i] <= chosen.size() && chosen[ids[i] - 1] ? 1 : 0;
  const int thick = std::clamp(height / 250, 1, 4);
  const Mask line = widened(mask, width, height, thick);
  const Mask rim = widened(mask, width, height, thick + 1);
  constexpr std::array<std::uint8_t, 3> kLine = {255, 214, 92}, kRim = {12, 14, 18};
  for (std::size_t i = 0; i < count; ++i) {
    if (mask[i] != 0 || rim[i] == 0) continue;
    const auto& color = line[i] != 0 ? kLine : kRim;
    std::ranges::copy(color, rgba.begin() + std::ptrdiff_t(4 * i));
  }
}

}  // namespace gloam::view
