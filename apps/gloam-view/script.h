// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Input from a file, for tests and films: mouse, keys, drops, values, sizes, pictures (docs/viewer.md).
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "json.h"

namespace gloam::view {

class App;

class Script {
 public:
  /// Throws Error that names the file and the step.
  explicit Script(const std::string& file);
  /// Plays on, once a frame of the window. False when all is played. Throws Error for what a step cannot do, and for a wait
  /// that takes too long.
  bool play(App& app);
  /// Nothing to do but to wait for what runs: the window need not be drawn for it.
  bool waits() const;

 private:
  struct Step {
    std::string what;
    cli::Json value;
    std::string place;  ///< "steps.json: steps[3]"
  };
  void add(const cli::Json& steps, const std::string& place, int depth);
  void addOne(const cli::Json& step, const std::string& place, int depth);
  bool done(App& app, const Step& step);

  std::string file_;
  std::deque<Step> steps_;
  std::optional<double> waiting_since_;
  int waited_frames_ = 0;
};

}  // namespace gloam::view
