// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rows of texels and lists of places by the host's vector units.
#pragma once

#include "techniques/splatting/splatting_host.h"

namespace gloam::splatting {

/// MS-3, level 1: a row of `to` from rows 2 row and 2 row + 1 of the picture. `scratch`: kPixelPlanes * 2 * to.stride * 2 floats.
inline constexpr int kPixelPlanes = 7;
void rangesOfPixels(const HostPlan& plan, const float* depth, const glm::uvec2* normals, int row,
                    std::vector<float>& scratch, HostLevel& to);
/// MS-3, from a level to the next.
void rangesOfTexels(const HostLevel& from, int row, HostLevel& to);

/// MS-5: what every place gets of all lights. `measures`: change, too; `merged`: error, too.
void gatherOnHost(std::span<const SplatLight> lights, int bound_kind, bool measures, bool merged,
                  HostPoints& points);

/// Which neighbours of a row's texels go on where these end.
void relateRow(const HostPlan& plan, int row, HostLevel& level);

}  // namespace gloam::splatting
