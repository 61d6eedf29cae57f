// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// --only, --direct, --indirect: a part of the light.
#pragma once

#include <gloam/scene.h>

#include "arguments.h"

namespace gloam::cli {

struct LightParts {
  std::vector<std::string> only;          ///< sources by name; empty: all
  bool direct = false, indirect = false;  ///< neither: both
};
void addLightParts(CLI::App& app, LightParts& parts);
Coverage coverageOf(const LightParts& parts);

}  // namespace gloam::cli
