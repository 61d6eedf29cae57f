// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the objects of our own glTF extensions are read with.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf_accessors.h"
#include "scene/half_float.h"

namespace gloam {

/// Members of the extension's object, each checked as it is taken.
class ExtensionReader {
 public:
  ExtensionReader(GltfAccessors& accessors, const nlohmann::json& json, const std::string& where)
      : accessors_(accessors), document_(accessors.document()), json_(json), where_(where) {
    if (!json.is_object()) document_.fail(where, "an object was expected");
  }

  int integer(const char* name, int least, int most) const { return whole(member(name), name, least, most); }

  std::string word(const char* name) const {
    const nlohmann::json& value = member(name);
    if (!value.is_string()) fail(name, fmt::format("{} is not a string", shortText(value)));
    return value.get<std::string>();
  }

  /// "format": whether numbers are stored as halves.
  bool halfFloat() const {
    const std::string format = word("format");
    if (format != "float" && format != "half") fail("format", "neither \"float\" nor \"half\"");
    return format == "half";
  }

  /// An array of three.
  glm::ivec3 integers(const char* name, int least, int most) const {
    const nlohmann::json& array = triple(name);
    return {whole(array[0], name, least, most), whole(array[1], name, least, most),
            whole(array[2], name, least, most)};
  }
  glm::vec3 vector(const char* name, double least = -1e12, double most = 1e12) const {
    const nlohmann::json& array = triple(name);
    glm::vec3 v;
    for (int c = 0; c < 3; ++c) {
      const nlohmann::json& value = array[std::size_t(c)];
      if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= most))
        fail(name, fmt::format("{} is not a number from {} to {}", shortText(value), least, most));
      v[c] = value.get<float>();
    }
    return v;
  }

  float number(const char* name, float least, float most) const {
    const nlohmann::json& value = member(name);
    if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= most)) {
      fail(name, fmt::format("{} is not a number from {} to {}", shortText(value), least, most));
    }
    return value.get<float>();
  }

  bool has(const char* name) const { return json_.contains(name); }

  /// `most`: what none exceeds in magnitude; transfer is far below what halves hold.
  std::vector<float> numbers(const char* name, std::size_t count, bool half_float,
                             float most = kMostHalf) const {
    const int index = accessor(name);
    const AccessorView view = accessors_.view(index);
    constexpr int kUnsignedShort = 5123, kFloat = 5126;
    const int type = half_float ? kUnsignedShort : kFloat;
    if (view.component_type != type || view.components != 1 || view.normalized) {
      fail(name, fmt::format("accessors[{}] must be SCALAR of component type {}", index, type));
    }
    if (view.count != count) {
      fail(name, fmt::format("accessors[{}] has {} elements, {} were expected", index, view.count, count));
    }
    document_.budget.charge(count, sizeof(float), where_ + "." + name);
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = half_float ? floatFromHalf(std::uint16_t(view.integer(i, 0))) : view.number(i, 0);
      if (!std::isfinite(values[i]))
        fail(name, fmt::format("element {} of accessors[{}] is not finite", i, index));
      if (std::abs(values[i]) > most)
        fail(name,
             fmt::format("element {} of accessors[{}] is {:g}; {:g} is the most", i, index, values[i], most));
    }
    return values;
  }

  /// So many floats more that reading this takes.
  void charge(const char* name, std::size_t count) const {
    document_.budget.charge(count, sizeof(float), where_ + "." + name);
  }

  /// Whole numbers of 8 or 16 bits, each below `limit`.
  std::vector<std::uint16_t> indices(const char* name, std::size_t count, int limit) const {
    constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123;
    const int index = accessor(name);
    const AccessorView view = accessors_.view(index);
    const bool known = view.component_type == kUnsignedByte || view.component_type == kUnsignedShort;
    if (!known || view.components != 1 || view.normalized)
      fail(name, fmt::format("accessors[{}] must be SCALAR of component type {} or {}", index, kUnsignedByte,
                             kUnsignedShort));
    if (view.count != count)
      fail(name, fmt::format("accessors[{}] has {} elements, {} were expected", index, view.count, count));
    document_.budget.charge(count, sizeof(std::uint16_t), where_ + "." + name);
    std::vector<std::uint16_t> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = int(view.integer(i, 0));
      if (value >= limit)
        fail(name, fmt::format("element {} of accessors[{}] is {}; there are {}", i, index, value, limit));
      values[i] = std::uint16_t(value);
    }
    return values;
  }

  [[noreturn]] void fail(const char* name, const std::string& message) const {
    document_.fail(where_ + "." + name, message);
  }

 private:
  const nlohmann::json& member(const char* name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) fail(name, "missing");
    return *found;
  }
  const nlohmann::json& triple(const char* name) const {
    const nlohmann::json& array = member(name);
    if (!array.is_array() || array.size() != 3) fail(name, "three numbers were expected");
    return array;
  }
  int whole(const nlohmann::json& value, const char* name, int least, int most) const {
    if (!value.is_number_integer() || value < least || value > most)
      fail(name, fmt::format("{} is not a whole number from {} to {}", shortText(value), least, most));
    return value.get<int>();
  }
  int accessor(const char* name) const {
    const std::size_t accessors = document_.array("accessors").size();
    if (accessors == 0) fail(name, "the file has no accessors");
    return integer(name, 0, int(std::min<std::size_t>(accessors, 0x7fffffffu)) - 1);
  }
  static std::string shortText(const nlohmann::json& value) {
    return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace).substr(0, 40);
  }

  GltfAccessors& accessors_;
  GltfDocument& document_;
  const nlohmann::json& json_;
  const std::string& where_;
};

}  // namespace gloam
