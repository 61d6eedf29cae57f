// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How long something kept in the cache took to make: a file of its own beside it, since nothing in what is made depends on
// the machine that made it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace gloam::cli {

struct BakeTime {
  std::optional<double> seconds;  ///< wall clock, of all of it
  std::string note;               ///< where that is not known: why
};
/// Of a kept bake.
BakeTime readBakeTime(const std::filesystem::path& bake);
/// Replaces what was there. Throws Error.
void writeBakeTime(const BakeTime& time, const std::filesystem::path& bake);

}  // namespace gloam::cli
