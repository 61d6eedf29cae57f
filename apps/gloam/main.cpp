// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The command line: finds the verb, parses its options, turns whatever goes wrong into one line and an exit code
// (0 done; 1 a bound was exceeded or the work was interrupted; 2 bad input or usage).
#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "arguments.h"
#include "help.h"
#include "verb.h"

namespace gloam::cli {

ParsedVerb declareVerb(const Verb& verb, Console& console) {
  auto app = std::make_unique<CLI::App>(verb.summary, fmt::format("gloam {}", verb.name));
  app->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app->set_help_flag("-h,--help", "show this");
  app->formatter_fn([&verb](const CLI::App* shown, const std::string&, CLI::AppFormatMode) {
    return verbHelp(*shown, verb);
  });
  auto run = verb.declare(*app, console);
  return {std::move(app), std::move(run)};
}

namespace {

/// CLI11 would take the next word for the value.
void refuseEmptyValues(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
      throw Error(argument.substr(0, argument.size() - 1), "expected a value after '='");
  }
}

int runVerb(const Verb& verb, std::vector<std::string> arguments, Console& console) {
  ParsedVerb parsed = declareVerb(verb, console);
  refuseEmptyValues(arguments);
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
  try {
    parsed.app->parse(std::move(arguments));
  } catch (const CLI::CallForHelp&) {
    console.print(parsed.app->help());
    return kDone;
  } catch (const CLI::ParseError& error) {
    throw usageError(*parsed.app, error);
  }
  catchInterrupts();
  return parsed.run();
}

int dispatch(const std::vector<std::string>& arguments, Console& console) {
  console.command = "gloam";
  for (const std::string& argument : arguments) console.command += " " + shellWord(argument);
  const std::string first = arguments.empty() ? "--help" : arguments.front();
  if (first == "--help" || first == "-h") {
    console.print(overallHelp());
    return kDone;
  }
  if (first == "--version") {
    console.print("gloam " GLOAM_VERSION);
    return kDone;
  }
  if (arguments.size() > 1) {  // a verb of two words; a file of the second's name is ./spheres
    if (const Verb* verb = findVerb(first + " " + arguments[1])) {
      return runVerb(*verb, {arguments.begin() + 2, arguments.end()}, console);
    }
  }
  const Verb* verb = findVerb(first);
  if (verb == nullptr) {
    std::vector<std::string> names;
    for (const Verb* known : verbs()) names.emplace_back(known->name);
    throw Error(fmt::format("no verb '{}'{}; expected {}", first, didYouMean(first, names), listed(names)));
  }
  return runVerb(*verb, {arguments.begin() + 1, arguments.end()}, console);
}

int fail(Console& console, const std::string& message, int code) {
  console.endProgress();
  fmt::print(stderr, "gloam: {}\n", singleLine(message));
  return code;
}

// What was printed but did not arrive (a full disk behind a redirection) is no success.
void flushOutput() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw Error("standard output", std::strerror(errno));
  }
}

int guarded(const std::vector<std::string>& arguments) {
  Console console;
  try {
    const int code = dispatch(arguments, console);
    console.release();
    console.endProgress();
    flushOutput();
    return code;
  } catch (const Interrupted& stopped) {
    console.release();
    return fail(console, stopped.what(), kBoundExceeded);
  } catch (const Error& error) {
    return fail(console, error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return fail(console, "out of memory", kBadInput);
  } catch (const std::exception& error) {
    return fail(console, fmt::format("unexpected error: {}", error.what()), kBadInput);
  }
}

}  // namespace
}  // namespace gloam::cli

int main(int argc, char** argv) {
  return gloam::cli::guarded({argv + 1, argv + argc});
}
