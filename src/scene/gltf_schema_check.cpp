// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The walk over a glTF file's JSON that holds it against the table in gltf_schema.cpp.
#include <fmt/format.h>
#include <gloam/error.h>

#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "image/limits.h"
#include "scene/gltf_schema.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// A value for a message: short, and never more than it must be.
std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_string()) return '"' + oneLine(value.get_ref<const std::string&>().substr(0, 50)) + '"';
  return value.dump();
}

class SchemaWalk {
 public:
  SchemaWalk(Json& root, const std::string& place) : place_(place) {
    for (const ObjectSchema& object : gltfSchema()) objects_[object.name] = object.fields;
    if (!root.is_object()) throw Error(place_, "a JSON object was expected, found " + shown(root));
    for (const Field& field : objects_["gltf"])
      if (field.kind == Kind::kObjects) lengths_[field.name] = lengthOf(root, field.name);
    lengths_["lights"] = lengthOfExtension(root, "KHR_lights_punctual");
    lengths_["imageLights"] = lengthOfExtension(root, "EXT_lights_image_based");
    checkObject(root, "gltf", "");
  }

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& expected, const Json& found) const {
    throw Error(place_, fmt::format("{}: {} was expected, found {}", path, expected, shown(found)));
  }

  static std::size_t lengthOf(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_array() ? found->size() : 0;
  }
  static std::size_t lengthOfExtension(const Json& root, const char* extension) {
    const auto all = root.find("extensions");
    if (all == root.end() || !all->is_object()) return 0;
    const auto found = all->find(extension);
    return found != all->end() && found->is_object() ? lengthOf(*found, "lights") : 0;
  }

  void checkObject(Json& object, const char* type, const std::string& path) {
    if (!object.is_object()) fail(path, "an object", object);
    const std::span<const Field> fields = objects_.at(type);
    for (auto member = object.begin(); member != object.end();) {
      bool known = false;
      for (const Field& field : fields) known = known || member.key() == field.name;
      member = known ? std::next(member) : object.erase(member);
    }
    for (const Field& field : fields) {
      const std::string field_path = path.empty() ? field.name : path + "." + field.name;
      const auto found = object.find(field.name);
      if (found != object.end())
        check(*found, field, field_path);
      else if (field.required)
        throw Error(place_, field_path + ": missing");
    }
  }

  template <typename Each>
  void forEach(Json& array, const std::string& path, Each each) {
    if (!array.is_array()) fail(path, "an array", array);
    for (std::size_t i = 0; i < array.size(); ++i) each(array[i], fmt::format("{}[{}]", path, i));
  }
  template <typename Each>
  void forEachMember(Json& object, const std::string& path, Each each) {
    if (!object.is_object()) fail(path, "an object", object);
    for (auto member = object.begin(); member != object.end(); ++member)
      each(member.value(), path + "." + oneLine(member.key()).substr(0, 60));
  }

  /// 3.0 is a whole number in JSON Schema's eyes; 1e300 is none that we could use.
  void checkWhole(Json& value, double least, double most, const std::string& what, const std::string& path) {
    if (value.is_number_float() && std::abs(value.get<double>()) < 9.1e15 &&
        value.get<double>() == std::trunc(value.get<double>()))
      value = static_cast<std::int64_t>(value.get<double>());
    if (!value.is_number_integer()) fail(path, what, value);
    const double number = value.get<double>();
    if (number < least || number > most) fail(path, what, value);
  }

  void checkIndex(Json& value, const Field& field, const std::string& path) {
    const std::size_t length = lengths_.at(field.detail);
    const std::string what = length ? fmt::format("an index into {} (0 to {})", field.detail, length - 1)
                                    : fmt::format("an index into {} (of which there are none)", field.detail);
    checkWhole(value, 0.0, static_cast<double>(length) - 1.0, what, path);
  }

  void checkCount(Json& value, const Field& field, const std::string& path) {
    const double most = field.least == 0 && field.most == 0 ? 9007199254740992.0 : field.most;
    checkWhole(value, field.least, most, fmt::format("a whole number from {} to {:.0f}", field.least, most),
               path);
  }

  void checkNumber(const Json& value, double least, double most, const std::string& path) {
    if (least == 0 && most == 0) least = -kUnbounded, most = kUnbounded;
    if (!value.is_number()) fail(path, "a number", value);
    const double number = value.get<double>();
    if (!(number >= least && number <= most))
      fail(path, fmt::format("a number from {:g} to {:g}", least, most), value);
  }

  void checkNumbers(const Json& value, const Field& field, const std::string& path) {
    const auto wanted = static_cast<std::size_t>(field.least);
    if (!value.is_array() || (wanted != 0 && value.size() != wanted))
      fail(path, wanted ? fmt::format("an array of {} numbers", wanted) : "an array of numbers", value);
    for (std::size_t i = 0; i < value.size(); ++i)
      checkNumber(value[i], 0, 0, fmt::format("{}[{}]", path, i));
  }

  void checkChoice(const Json& value, const Field& field, const std::string& path) {
    if (value.is_string())
      for (const std::string_view word : words(field.detail))
        if (value.get_ref<const std::string&>() == word) return;
    fail(path, fmt::format("one of {}", field.detail), value);
  }

  void checkCode(Json& value, const Field& field, const std::string& path) {
    checkWhole(value, -kLargestInt, kLargestInt, fmt::format("one of {}", field.detail), path);
    for (const std::string_view word : words(field.detail))
      if (std::to_string(value.get<std::int64_t>()) == word) return;
    fail(path, fmt::format("one of {}", field.detail), value);
  }

  void check(Json& value, const Field& field, const std::string& path) {
    const auto index = [&](Json& v, const std::string& p) { checkIndex(v, field, p); };
    const auto count = [&](Json& v, const std::string& p) { checkCount(v, field, p); };
    const auto object = [&](Json& v, const std::string& p) { checkObject(v, field.detail, p); };
    const auto name = [&](Json& v, const std::string& p) {
      if (!v.is_string()) fail(p, "a string", v);
    };
    const auto index_map = [&](Json& v, const std::string& p) { forEachMember(v, p, index); };
    switch (field.kind) {
      case Kind::kString:
        return name(value, path);
      case Kind::kBool:
        if (!value.is_boolean()) fail(path, "true or false", value);
        return;
      case Kind::kNumber:
        return checkNumber(value, field.least, field.most, path);
      case Kind::kCount:
        return checkCount(value, field, path);
      case Kind::kIndex:
        return checkIndex(value, field, path);
      case Kind::kNumbers:
        return checkNumbers(value, field, path);
      case Kind::kIndices:
        return forEach(value, path, index);
      case Kind::kNames:
        return forEach(value, path, name);
      case Kind::kChoice:
        return checkChoice(value, field, path);
      case Kind::kCode:
        return checkCode(value, field, path);
      case Kind::kObject:
        return checkObject(value, field.detail, path);
      case Kind::kObjects:
        return forEach(value, path, object);
      case Kind::kIndexMap:
        return index_map(value, path);
      case Kind::kIndexMaps:
        return forEach(value, path, index_map);
      case Kind::kCountMap:
        return forEachMember(value, path, count);
      case Kind::kAny:
        return;
    }
  }

  const std::string& place_;
  std::map<std::string_view, std::span<const Field>> objects_;
  std::map<std::string_view, std::size_t> lengths_;
};

}  // namespace

void checkAgainstSchema(Json& root, const std::string& place) {
  SchemaWalk(root, place);
}

}  // namespace gloam
