// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// JSON that people write: settings, presets, scripts of the viewer.
#pragma once

#include <string>

#include "json.h"

namespace gloam::cli {

/// At most 1 MiB, nested at most `most_depth` deep. `expected` says what such a file holds ("an object of options, such as …"). Throws
/// Error that names the file, the line and column from which it is no JSON, and what was expected.
Json readJsonFile(const std::string& file, int most_depth, const std::string& expected);

}  // namespace gloam::cli
