// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "settings_file.h"

#include <fmt/core.h>

#include <algorithm>

#include "json_file.h"

namespace gloam::cli {
namespace {

constexpr int kMostDepth = 8;
constexpr const char* kExpected = "an object of options, such as {\"exposure\": 0.5}";

Json readSettings(const std::string& file) {
  Json json = readJsonFile(file, kMostDepth, kExpected);
  if (!json.is_object()) throw Error(file, fmt::format("expected {}", kExpected));
  return json;
}

std::string valueText(const std::string& place, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  throw Error(place, "expected a string, a number, true or false");
}

/// A list where the option may stand several times.
std::vector<std::string> valueTexts(const std::string& place, const Json& value, bool several) {
  if (!several || !value.is_array()) return {valueText(place, value)};
  std::vector<std::string> texts;
  for (const Json& one : value) texts.push_back(valueText(place, one));
  return texts;
}

/// The scene stands without a name of its own.
CLI::Option* optionOf(CLI::App& app, const std::string& name) {
  if (name == "settings" || name == "help") return nullptr;
  return app.get_option_no_throw(name == "scene" ? "SCENE" : "--" + name);
}

void setOption(CLI::App& app, const std::string& file, const std::string& key, const Json& value) {
  std::string name = key;
  if (key.find('.') == std::string::npos) std::replace(name.begin(), name.end(), '_', '-');
  const std::string place = fmt::format("{}: {}", file, key);
  CLI::Option* option = optionOf(app, name);
  if (option == nullptr) throw Error(place, fmt::format("{} has no such option", app.get_name()));
  if (option->count() > 0) return;
  const std::vector<std::string> texts = valueTexts(place, value, option->get_items_expected_max() > 1);
  if (texts.empty()) return;
  try {
    for (const std::string& text : texts) option->add_result(text);
    option->run_callback();
  } catch (const Error& error) {
    throw Error(file, error.what());
  } catch (const CLI::ParseError&) {
    const bool flag = option->get_expected_min() == 0;
    throw Error(place, fmt::format("'{}': expected {}", texts.front(),
                                   flag ? "true or false" : option->get_type_name()));
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
