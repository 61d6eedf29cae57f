// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/bake.h>

#include <string>

namespace gloam::cli {

/// 32 hexadecimal digits that change with anything in the scene (its environment, which no bake sees, left out), with any
/// option of a bake that changes its result, and with the version of gloam. Names the bakes that are kept.
std::string bakeKey(const Scene& scene, const BakeOptions& options);

}  // namespace gloam::cli
