// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/sh.h>

#include <string>

namespace gloam::sh {

/// Throws Error unless the order is one that the room knows.
inline void checkOrder(int order) {
  if (order < 1 || order > kMaxOrder)
    throw Error("spherical harmonics",
                "order " + std::to_string(order) + ", expected 1 to " + std::to_string(kMaxOrder));
}

}  // namespace gloam::sh
