// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The selection, seen: a bright line with a dark rim round what was picked.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <vector>

namespace gloam::view {

/// Of each instance (by its node), whether it is that node's or stands below it.
std::vector<bool> instancesBelow(const Scene& scene, const std::vector<int>& instance_nodes, int node);

/// Draws the line into a picture of 8 bits (RGBA). `ids`: of the object that a pixel shows, 0 for none, else one more than its
/// index into `chosen`. Nothing where they are not as many as pixels.
void drawOutline(std::vector<std::uint8_t>& rgba, int width, int height,
                 const std::vector<std::uint32_t>& ids, const std::vector<bool>& chosen);

}  // namespace gloam::view
