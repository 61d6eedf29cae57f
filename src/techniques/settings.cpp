// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options by name: parsed, checked, with messages that say what was expected.
#include <fmt/format.h>
#include <gloam/renderer.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gloam {

namespace {

template <class T>
T parseNumber(const Option& option, const std::string& text, const char* kind) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool in_range =
      double(value) >= option.minimum && double(value) <= option.maximum;  // false for not-a-number
  if (error != std::errc() || stop != end || !in_range)
    throw Error(fmt::format("option '{}'", option.name),
                fmt::format("'{}' is not {} from {} to {}", text, kind, option.minimum, option.maximum));
  return value;
}

bool parseFlag(const Option& option, const std::string& text) {
  for (const char* yes : {"on", "true", "yes", "1"}) {
    if (text == yes) return true;
  }
  for (const char* no : {"off", "false", "no", "0"}) {
    if (text == no) return false;
  }
  throw Error(fmt::format("option '{}'", option.name), fmt::format("'{}' is neither on nor off", text));
}

std::string parseChoice(const Option& option, const std::string& text) {
  const bool known = std::any_of(option.choices.begin(), option.choices.end(),
                                 [&](const char* choice) { return text == choice; });
  if (!known)
    throw Error(fmt::format("option '{}'", option.name),
                fmt::format("'{}' is not one of {}", text, fmt::join(option.choices, ", ")));
  return text;
}

OptionValue parse(const Option& option, const std::string& text) {
  if (std::holds_alternative<bool>(option.default_value)) return parseFlag(option, text);
  if (std::holds_alternative<int>(option.default_value))
    return parseNumber<int>(option, text, "a whole number");
  if (std::holds_alternative<float>(option.default_value))
    return parseNumber<float>(option, text, "a number");
  return parseChoice(option, text);
}

std::string textOf(const OptionValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "on" : "off";
  if (const int* number = std::get_if<int>(&value)) return fmt::format("{}", *number);
  if (const float* number = std::get_if<float>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

}  // namespace

Coverage coverageWith(const TechniqueInfo& info, const Settings& settings) {
  return info.covers_with ? info.covers_with(settings) : info.covers;
}

void Settings::set(const std::string& name, const std::string& text) {
  const auto option =
      std::find_if(options_.begin(), options_.end(), [&](const Option& o) { return name == o.name; });
  if (option == options_.end()) {
    std::string names;
    for (const Option& o : options_) names += (names.empty() ? "" : ", ") + std::string(o.name);
    throw Error("option '" + name + "'", "unknown; there are: " + (names.empty() ? "none" : names));
  }
  values_[name] = parse(*option, text);
}

const OptionValue& Settings::value(const char* name) const {
  if (const auto found = values_.find(name); found != values_.end()) return found->second;
  for (const Option& option : options_) {
    if (std::string(name) == option.name) return option.default_value;
  }
  throw Error(fmt::format("option '{}'", name), "is not among these settings");
}

bool Settings::flag(const char* name) const {
  return std::get<bool>(value(name));
}
int Settings::integer(const char* name) const {
  return std::get<int>(value(name));
}
float Settings::number(const char* name) const {
  return std::get<float>(value(name));
}
const std::string& Settings::choice(const char* name) const {
  return std::get<std::string>(value(name));
}

std::vector<std::pair<std::string, std::string>> Settings::list() const {
  std::vector<std::pair<std::string, std::string>> result;
  for (const Option& option : options_) result.emplace_back(option.name, textOf(value(option.name)));
  return result;
}

}  // namespace gloam
