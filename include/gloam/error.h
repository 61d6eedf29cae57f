// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What everything here may say to whoever called it: errors, remarks, progress.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

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

/// How long work talks to whoever started it. All members may be left empty. Calls come from one thread at a time.
struct Progress {
  /// Called now and then with the part of the work that is done, 0 to 1, and what is being done ("bake: direct pass").
  std::function<void(double fraction, const std::string& what)> update;
  /// Asked often; true means: finish cleanly, keep what is done, throw Interrupted.
  std::function<bool()> should_stop;

  void report(double fraction, const std::string& what) const {
    if (update) update(fraction, what);
  }
  bool stopRequested() const { return should_stop && should_stop(); }
};

/// One-line remarks that a reader makes about what it mended or left out ("material 'glass': alphaMode BLEND is
/// drawn opaque"). Each is said once.
using Warnings = std::vector<std::string>;

}  // namespace gloam
