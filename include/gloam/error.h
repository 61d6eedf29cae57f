// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace gloam {

/// Input or usage that cannot be served: a file, a field, an option. The message is one line that names the place and
/// says what was expected ("scene.glb: accessors[3].count: 12 elements do not fit into bufferView 1 (96 bytes)").
/// The command line prints it and exits with 2.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  /// `place` is a file, or a file and a field ("probe.exr: channel G").
  Error(const std::string& place, const std::string& message) : std::runtime_error(place + ": " + message) {}
};

/// Work that was asked to stop (Ctrl-C) and did so cleanly; finished parts are kept. The command line exits with 1.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace gloam
