// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Names with values: "preetham?elevation=30&turbidity=3", as built-in scenes and skies are called.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace gloam {

class NamedValues {
 public:
  /// Splits the text; `prefix` ("sky:") is only for messages. Throws Error where a value is no finite number or a key
  /// stands twice.
  NamedValues(const std::string& prefix, const std::string& text);

  /// The same of values that are known; `place` is for messages.
  NamedValues(std::string place, std::string name, std::map<std::string, double> values)
      : place_(std::move(place)), name_(std::move(name)), values_(std::move(values)) {}

  const std::string& name() const { return name_; }
  bool has(const std::string& key) const { return values_.contains(key); }
  const std::string& place() const { return place_; }
  /// The value of a key, or the default. Throws Error where it lies outside the range.
  double take(const std::string& key, double default_value, double minimum, double maximum);
  /// Throws Error that lists the keys taken so far where another one was given.
  void finish() const;

 private:
  std::string place_, name_;
  std::map<std::string, double> values_;
  std::vector<std::string> known_;
};

}  // namespace gloam
