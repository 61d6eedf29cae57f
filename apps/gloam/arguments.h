// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options of one kind each, declared in one line: what is typed is checked, and what is wrong with it is said by option,
// value and what was expected. All throw Error.
#pragma once

#include <gloam/error.h>

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "console.h"

namespace gloam::cli {

struct Range {
  double minimum = -std::numeric_limits<double>::max();
  double maximum = std::numeric_limits<double>::max();
};

double parseNumber(const std::string& place, const std::string& text, Range range);
/// For what has to be more than nothing.
float parseAboveZero(const std::string& place, const std::string& text);
int parseInteger(const std::string& place, const std::string& text, Range range);
/// "x,y,z".
glm::vec3 parseVector(const std::string& place, const std::string& text);
/// "1024x768", or "512" for a square.
glm::ivec2 parseSize(const std::string& place, const std::string& text, int maximum);

// `kind` is what help shows for the value. Words of it in lower case, apart by |, complete as they are; FILE, FOLDER, SCENE,
// LIGHT and TECHNIQUE complete as files and names of that kind (completion.cpp).
CLI::Option* addText(CLI::App& app, const std::string& name, std::string& value, const std::string& kind,
                     const std::string& help);
/// The name of a file or the like; throws where it is empty.
CLI::Option* addName(CLI::App& app, const std::string& name, std::string& value, const std::string& kind,
                     const std::string& help);
/// -o, --output; throws where the name is empty.
CLI::Option* addOutput(CLI::App& app, std::string& value, const std::string& kind, const std::string& help);
CLI::Option* addNumber(CLI::App& app, const std::string& name, float& value, Range range,
                       const std::string& kind, const std::string& help);
CLI::Option* addInteger(CLI::App& app, const std::string& name, int& value, Range range,
                        const std::string& kind, const std::string& help);
CLI::Option* addChoice(CLI::App& app, const std::string& name, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help);
/// --quiet, and --json where the verb has a result for machines.
void addConsoleOptions(CLI::App& app, Console& console, bool json);

/// "a, b or c".
std::string listed(const std::vector<std::string>& names);
/// " (did you mean --fov?)", or nothing where no name is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names);
/// What the parser objects to, in one line that says which verb.
Error usageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace gloam::cli
