// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "arguments.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <numeric>

namespace gloam::cli {
namespace {

/// The whole text as a number, or nothing. Not-a-number and infinity are no numbers to ask for.
template <class Number>
bool parseWhole(std::string_view text, Number& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc{} && end == text.data() + text.size() && std::isfinite(double(value));
}

std::string rangeText(Range range) {
  constexpr double kHuge = 1e30;
  if (range.minimum > -kHuge && range.maximum < kHuge) {
    return fmt::format(" from {} to {}", range.minimum, range.maximum);
  }
  if (range.minimum > -kHuge) return fmt::format(" of at least {}", range.minimum);
  if (range.maximum < kHuge) return fmt::format(" of at most {}", range.maximum);
  return "";
}

template <class Number>
Number parseInRange(const std::string& place, const std::string& text, Range range, const char* what) {
  Number value{};
  if (!parseWhole(text, value) || double(value) < range.minimum || double(value) > range.maximum) {
    throw Error(place, fmt::format("'{}': expected {}{}", text, what, rangeText(range)));
  }
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

double parseNumber(const std::string& place, const std::string& text, Range range) {
  return parseInRange<double>(place, text, range, "a number");
}

float parseAboveZero(const std::string& place, const std::string& text) {
  float value = 0.0f;
  if (!parseWhole(text, value) || !(value > 0.0f) || !std::isfinite(value)) {
    throw Error(place, fmt::format("'{}': expected a number above 0", text));
  }
  return value;
}

int parseInteger(const std::string& place, const std::string& text, Range range) {
  return parseInRange<int>(place, text, range, "a whole number");
}

glm::vec3 parseVector(const std::string& place, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  glm::vec3 vector{};
  bool good = parts.size() == 3;
  for (int i = 0; good && i < 3; ++i) good = parseWhole(parts[std::size_t(i)], vector[i]);
  if (!good) throw Error(place, fmt::format("'{}': expected three numbers x,y,z", text));
  return vector;
}

glm::ivec2 parseSize(const std::string& place, const std::string& text, int maximum) {
  const std::vector<std::string> parts = split(text, 'x');
  glm::ivec2 size{};
  bool good = (parts.size() == 1 || parts.size() == 2) && parseWhole(parts.front(), size.x) &&
              parseWhole(parts.back(), size.y);
  good = good && size.x >= 1 && size.y >= 1 && size.x <= maximum && size.y <= maximum;
  if (!good) {
    throw Error(place, fmt::format("'{}': expected WIDTHxHEIGHT, each from 1 to {}", text, maximum));
  }
  return size;
}

CLI::Option* addText(CLI::App& app, const std::string& name, std::string& value, const std::string& kind,
                     const std::string& help) {
  return app.add_option(name, value, help)->type_name(kind);
}

CLI::Option* addName(CLI::App& app, const std::string& name, std::string& value, const std::string& kind,
                     const std::string& help) {
  const auto set = [&value, place = name.substr(name.rfind(',') + 1)](const std::string& text) {
    if (text.empty()) throw Error(place, "the name is empty");
    value = text;
  };
  return app.add_option_function<std::string>(name, set, help)->type_name(kind);
}

CLI::Option* addOutput(CLI::App& app, std::string& value, const std::string& kind, const std::string& help) {
  return addName(app, "-o,--output", value, kind, help)->group("Output");
}

CLI::Option* addNumber(CLI::App& app, const std::string& name, float& value, Range range,
                       const std::string& kind, const std::string& help) {
  const auto parse = [&value, range, name](const std::string& text) {
    value = float(parseNumber(name, text, range));
  };
  return app.add_option_function<std::string>(name, parse, help)->type_name(kind);
}

CLI::Option* addInteger(CLI::App& app, const std::string& name, int& value, Range range,
                        const std::string& kind, const std::string& help) {
  const auto parse = [&value, range, name](const std::string& text) {
    value = parseInteger(name, text, range);
  };
  return app.add_option_function<std::string>(name, parse, help)->type_name(kind);
}

CLI::Option* addChoice(CLI::App& app, const std::string& name, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help) {
  const auto parse = [&value, choices, name](const std::string& text) {
    if (std::ranges::find(choices, text) == choices.end()) {
      throw Error(name, fmt::format("'{}'{}: expected {}", text, didYouMean(text, choices), listed(choices)));
    }
    value = text;
  };
  return app.add_option_function<std::string>(name, parse, help)
      ->type_name(fmt::format("{}", CLI::detail::join(choices, "|")));
}

void addConsoleOptions(CLI::App& app, Console& console, bool json) {
  app.add_flag("--quiet", console.quiet, "only errors: no remarks, no progress")->group("Output");
  if (json) app.add_flag("--json", console.json, "print the result as JSON")->group("Output");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& names) {
  const std::string* nearest = nullptr;
  std::size_t least =
      (word.size() + 1) / 3 + 1;  // of two or three letters one may be wrong: "zsh" is no "bash"
  for (const std::string& name : names) {
    const std::size_t distance = editDistance(word, name);
    if (distance < least) least = distance, nearest = &name;
  }
  return nearest == nullptr ? "" : fmt::format(" (did you mean {}?)", *nearest);
}

Error usageError(const CLI::App& app, const CLI::ParseError& error) {
  const std::string text = error.what();
  const std::string verb = app.get_name().substr(app.get_name().find(' ') + 1);  // of "gloam render"
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> extras = app.remaining();
    const std::string extra = extras.empty() ? "?" : extras.front();
    if (!extra.starts_with('-')) return {verb, fmt::format("unexpected argument '{}'", extra)};
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const std::string bare = extra.substr(0, extra.find('='));
    return {verb, fmt::format("no option {}{}", bare, didYouMean(bare, names))};
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const std::string what = text.substr(0, text.find(' '));
    return {verb, fmt::format("{} is missing; {} --help shows examples", what, app.get_name())};
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    return {verb, fmt::format("{} needs a value", text.substr(0, text.find(':')))};
  }
  return {verb, text};
}

}  // namespace gloam::cli
