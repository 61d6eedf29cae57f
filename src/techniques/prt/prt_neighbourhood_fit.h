// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the points of a neighbourhood's grid hold, so that interpolation between them is right in the mean.
#pragma once

#include "techniques/prt/prt_neighbourhood_state.h"

namespace gloam::prt {

/// Points in the object take the mean of the known ones among their 26 neighbours, nearer ones counting more, ring by ring.
void fillInside(NeighbourhoodState& state);

/// Visibility at all points such that interpolation errs least, squared and summed over the samples in all cells outside the
/// object. What samples say nothing of stays as it was.
void fitVisibility(NeighbourhoodState& state);

/// What is thrown is traced at the points alone: each is moved by a twelfth of the second difference along each axis, by which
/// interpolation between a parabola's own values lies beside it in the mean. So what is blocked and what is thrown in its place
/// stay in balance.
void fitThrown(NeighbourhoodState& state);

}  // namespace gloam::prt
