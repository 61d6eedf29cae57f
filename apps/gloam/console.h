// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How the command line talks: results on standard output; remarks, progress and errors on standard error.
#pragma once

#include <gloam/scene.h>

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace gloam::cli {

/// Whoever does not talk on a terminal takes remarks and progress elsewhere: those members are virtual.
class Console {
 public:
  virtual ~Console() = default;
  bool quiet = false;   ///< no remarks, no progress
  bool json = false;    ///< the result is one JSON value on standard output, nothing else there
  std::string command;  ///< as it was typed, quoted for a shell

  /// One line on standard error that a user may want to know ("no light: sky:mild"). Held back until release(), so that
  /// bad input is answered by its error alone. What was said once is not said again.
  virtual void remark(const std::string& line);
  /// Called when the input has proved good: shows what was held back, and from then on remarks at once.
  void release();
  /// All that a reader mended or left out, each with the file's name before it.
  void remarks(const std::string& place, const Warnings& warnings);
  /// A line of the result; standard output.
  void print(const std::string& line);

  /// Work that reports here: a bar on a terminal, a plain line every ten seconds in a log.
  virtual Progress progress();
  /// Takes the bar off the screen.
  virtual void endProgress();

 private:
  using Clock = std::chrono::steady_clock;
  void update(double fraction, const std::string& what);

  bool bar_shown_ = false, released_ = false;
  std::vector<std::string> held_;
  std::set<std::string> said_;
  Clock::time_point started_{}, shown_{};
  double first_fraction_ = 0.0, last_fraction_ = 2.0;
};

/// Ctrl-C and a polite kill ask the work to stop after what it is doing; a second one ends the program at once.
void catchInterrupts();
bool interrupted();

/// A word as a shell takes it, in quotes where it needs them.
std::string shellWord(const std::string& word);
/// Without line breaks and control characters: names from files may hold any.
std::string singleLine(std::string text);
/// "1 h 12 min", "3 min 20 s", "12 s", "0.4 s".
std::string durationText(double seconds);
/// "1.2 GiB", "34 MiB", "512 bytes".
std::string bytesText(double bytes);
/// "69,666".
std::string countText(std::size_t count);

}  // namespace gloam::cli
