// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-7, the coverage oracle: how far a proxy's influence reaches, in multiples of its radius.
#pragma once

#include <gloam/sh.h>

#include "techniques/proxies/proxies_shared.h"

namespace gloam::proxies {

/// Expansion factors eta; a proxy farther than eta times its radius counts for nothing.
struct Reach {
  float shadow = 15.0f, indirect = 10.0f;
};

/// For any light (order 4 and 3): what is left out is at most about 4/256 of the brightest shade a proxy.
inline constexpr Reach kFixedReach;

/// The least reach at which one proxy alone, anywhere above a receiver however turned, changes its shade by at most
/// `tolerance` of the brightest unshadowed one, in any channel; never more than the fixed ones.
Reach reachOf(const ProxyLight& light, float tolerance = 2.0f / 256.0f);

/// Contributions fade from 0 to 1 over four entries of the log table around 1 / eta: between these coordinates.
struct Fade {
  float from = -2.0f, to = -1.0f;  ///< nothing fades
};
Fade fadeOf(float reach);

}  // namespace gloam::proxies
