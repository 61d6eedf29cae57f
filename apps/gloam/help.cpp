// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "help.h"

#include <fmt/core.h>

#include <sstream>

namespace gloam::cli {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kIndent = 32;

/// `left`, then `text` from column kIndent on, broken between words.
std::string twoColumns(const std::string& left, const std::string& text) {
  std::string out = left, word;
  std::size_t column = left.size();
  const auto newLine = [&] { out += '\n', out.append(kIndent, ' '), column = kIndent; };
  if (left.size() + 2 > kIndent) {
    newLine();
  } else {
    out.append(kIndent - column, ' '), column = kIndent;
  }
  std::istringstream words(text);
  while (words >> word) {
    if (column > kIndent && column + 1 + word.size() > kColumns) newLine();
    if (column > kIndent) out += ' ', ++column;
    out += word, column += word.size();
  }
  return out + '\n';
}

std::string namesOf(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return CLI::detail::join(names, ", ");
}

std::string optionLine(const CLI::Option& option) {
  std::string left = "  " + namesOf(option);
  if (!option.get_positional() && option.get_type_size() != 0) left += " " + option.get_type_name();
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += fmt::format(" [{}]", option.get_default_str());
  return twoColumns(left, text);
}

std::string examples(const char* lines) {
  std::string out, line;
  std::istringstream in(lines);
  while (std::getline(in, line)) {
    const std::size_t bar = line.find(" | ");
    out += fmt::format("  {}\n", line.substr(0, bar));
    if (bar != std::string::npos) out += fmt::format("      {}\n", line.substr(bar + 3));
  }
  return out;
}

}  // namespace

std::string overallHelp() {
  std::string out =
      "gloam " GLOAM_VERSION ": real-time soft global illumination\n\n  gloam VERB [options]\n\nVerbs\n";
  for (const Verb* verb : verbs()) out += fmt::format("  {:<14}{}\n", verb->name, verb->summary);
  out += "\n`gloam VERB --help` shows options and examples; `gloam --version` the version. To begin with:\n";
  out += examples(
      "gloam render builtin:cornell -o cornell.png\n"
      "gloam bake bunny.obj -o bunny.glb\n"
      "gloam render bunny.glb --env probe.exr -o bunny.png\n");
  out += "\nExit codes: 0 done; 1 a bound was exceeded or the work was interrupted; 2 bad input or usage.";
  return out;
}

std::string verbHelp(const CLI::App& app, const Verb& verb) {
  std::string usage = app.get_name(), positionals;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true);
    usage += option->get_required() ? " " + name : fmt::format(" [{}]", name);
    positionals += optionLine(*option);
  }
  std::string out = fmt::format("{}: {}\n\n  {} [options]\n", app.get_name(), verb.summary, usage);
  if (!positionals.empty()) out += "\n" + positionals;
  for (const std::string& group : app.get_groups()) {
    std::string lines;
    for (const CLI::Option* option : app.get_options()) {
      if (option->nonpositional() && option->get_group() == group) lines += optionLine(*option);
    }
    if (!lines.empty()) out += fmt::format("\n{}\n{}", group, lines);
  }
  return out + "\nExamples\n" + examples(verb.examples);
}

}  // namespace gloam::cli
