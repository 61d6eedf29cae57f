// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a verb of the command line is. A new one is a file with its Verb and a row in verbs.cpp; help, completion and
// the check of docs/cli.md follow from the options that it declares.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>
#include <string>

#include "console.h"

namespace gloam::cli {

inline constexpr int kDone = 0;
inline constexpr int kBoundExceeded = 1;  ///< also: work that was interrupted
inline constexpr int kBadInput = 2;

struct Verb {
  const char* name;
  const char* summary;
  const char* examples;  ///< lines of the form "gloam … | what it does"
  /// Declares the options of the verb. What it returns runs after they were parsed and gives the exit code.
  std::function<int()> (*declare)(CLI::App& app, Console& console);
};

/// The one table of verbs, in the order in which help shows them.
std::span<const Verb* const> verbs();
const Verb* findVerb(const std::string& name);

/// A parser named "gloam VERB" that holds the verb's options.
struct ParsedVerb {
  std::unique_ptr<CLI::App> app;
  std::function<int()> run;
};
ParsedVerb declareVerb(const Verb& verb, Console& console);

}  // namespace gloam::cli
