// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "verb.h"

namespace gloam::cli {

/// What `gloam` alone prints.
std::string overallHelp();
/// What `gloam VERB --help` prints: use, options by group, examples. At most 100 columns.
std::string verbHelp(const CLI::App& app, const Verb& verb);

}  // namespace gloam::cli
