// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gloam::view {

/// The name itself where no file has it, else the first free one of "gloam_2.png", "gloam_3.png" …
std::string freeName(const std::string& wanted);
/// A file's whole path, so that it is found from anywhere; what is built in (builtin:cornell, sky:noon, none) as it is.
std::string wholeName(const std::string& name);

}  // namespace gloam::view
