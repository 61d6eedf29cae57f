// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "json_file.h"

#include <fmt/core.h>
#include <gloam/error.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace gloam::cli {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

/// "line 3, column 7" of the byte at which a reader stopped (1 is the first).
std::string placeIn(const std::string& text, std::size_t byte) {
  const std::string before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const std::size_t line_start = before.rfind('\n') == std::string::npos ? 0 : before.rfind('\n') + 1;
  return fmt::format("line {}, column {}", 1 + std::ranges::count(before, '\n'),
                     before.size() - line_start + 1);
}

}  // namespace

Json readJsonFile(const std::string& file, int most_depth, const std::string& expected) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw Error(file, fmt::format("is a folder; expected {}", expected));
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file, "cannot be read");
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
  if (text.size() > kMaxBytes) throw Error(file, fmt::format("is larger than 1 MiB; expected {}", expected));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw Error(file, fmt::format("is empty; expected {}", expected));
  // A nesting of a million brackets would exhaust the stack of a recursive reader.
  const auto depth_check = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > most_depth) throw Error(file, fmt::format("nests too deeply; expected {}", expected));
    return true;
  };
  try {
    return Json::parse(text, depth_check);
  } catch (const Json::parse_error& problem) {
    throw Error(file,
                fmt::format("{}: no JSON from here on; expected {}", placeIn(text, problem.byte), expected));
  } catch (const Json::exception&) {  // a number beyond all floats
    throw Error(file, fmt::format("holds a number that is too large; expected {}", expected));
  }
}

}  // namespace gloam::cli
