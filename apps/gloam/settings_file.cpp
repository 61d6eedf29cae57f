// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "settings_file.h"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "json.h"

namespace gloam::cli {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

Json readSettings(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw Error(file, "is a folder; expected a JSON file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file, "cannot be read");
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
  if (text.size() > kMaxBytes) throw Error(file, "is larger than 1 MiB: no settings file");
  // A nesting of a million brackets would exhaust the stack of a recursive reader; settings are two levels deep.
  const auto depth_check = [&file](int depth, Json::parse_event_t, Json&) {
    if (depth > 8)
      throw Error(file, "nests too deeply; expected options, and objects of a technique's options");
    return true;
  };
  try {
    Json json = Json::parse(text, depth_check);
    if (!json.is_object()) throw Error(file, "expected a JSON object of options");
    return json;
  } catch (const Json::exception& problem) {
    throw Error(file, problem.what());
  }
}

std::string valueText(const std::string& place, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  throw Error(place, "expected a string, a number, true or false");
}

void setOption(CLI::App& app, const std::string& file, const std::string& key, const Json& value) {
  std::string name = key;
  if (key.find('.') == std::string::npos) std::replace(name.begin(), name.end(), '_', '-');
  const std::string place = fmt::format("{}: {}", file, key);
  CLI::Option* option = name == "settings" || name == "help" ? nullptr : app.get_option_no_throw("--" + name);
  if (option == nullptr) throw Error(place, fmt::format("{} has no such option", app.get_name()));
  if (option->count() > 0) return;
  const std::string text = valueText(place, value);
  try {
    option->add_result(text);
    option->run_callback();
  } catch (const Error& error) {
    throw Error(file, error.what());
  } catch (const CLI::ParseError& error) {
    throw Error(place, error.what());
  }
}

}  // namespace

void addSettingsFile(CLI::App& app) {
  const auto read = [&app](const std::string& file) {
    const Json settings = readSettings(file);
    for (const auto& [key, value] : settings.items()) {
      if (!value.is_object()) {
        setOption(app, file, key, value);
        continue;
      }
      for (const auto& [name, inner] : value.items()) setOption(app, file, key + "." + name, inner);
    }
  };
  app.add_option_function<std::string>("--settings", read, "options from a JSON file; the command line wins")
      ->type_name("FILE");
}

}  // namespace gloam::cli
