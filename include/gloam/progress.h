// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace gloam {

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
