// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/named_values.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <gloam/error.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gloam {

NamedValues::NamedValues(const std::string& prefix, const std::string& text) : place_(prefix + text) {
  const std::size_t question = text.find('?');
  name_ = text.substr(0, question);
  if (question == std::string::npos) return;
  std::size_t begin = question + 1;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('&', begin), text.size());
    const std::string pair = text.substr(begin, end - begin);
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw Error(place_, fmt::format("'{}' is not key=value", pair));
    }
    const std::string key = pair.substr(0, equals), value = pair.substr(equals + 1);
    double number = 0.0;
    const auto [rest, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || rest != value.data() + value.size() || !std::isfinite(number)) {
      throw Error(place_, fmt::format("{}: '{}' is not a number", key, value));
    }
    if (!values_.emplace(key, number).second) throw Error(place_, fmt::format("{} is given twice", key));
    begin = end + 1;
  }
}

double NamedValues::take(const std::string& key, double default_value, double minimum, double maximum) {
  known_.push_back(key);
  const auto found = values_.find(key);
  if (found == values_.end()) return default_value;
  if (found->second < minimum || found->second > maximum) {
    throw Error(place_, fmt::format("{}: {} is outside {} to {}", key, found->second, minimum, maximum));
  }
  return found->second;
}

void NamedValues::finish() const {
  for (const auto& [key, value] : values_) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    throw Error(place_, fmt::format("unknown key '{}'; there are {}", key, fmt::join(known_, ", ")));
  }
}

}  // namespace gloam
