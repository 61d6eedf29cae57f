// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The pre-pass: a table of every member of glTF 2.0 that this reader looks at, and a walk that holds a file against it.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace gloam {

enum class Kind : std::uint8_t {
  kString,
  kBool,
  kNumber,    // finite as a float, within least..most
  kCount,     // whole number within least..most
  kIndex,     // whole number below the length of the root array `detail`
  kNumbers,   // array of `least` numbers, of any length if 0
  kIndices,   // array of kIndex
  kNames,     // array of strings
  kChoice,    // one of the words in `detail`, separated by spaces
  kCode,      // one of the whole numbers in `detail`
  kObject,    // described under `detail`
  kObjects,   // array of them
  kIndexMap,  // any name -> kIndex
  kIndexMaps,
  kCountMap,  // any name -> kCount
  kAny,       // kept as it is; whoever uses it checks it
};

inline constexpr double kUnbounded = 3.4e38;  // what a float holds
inline constexpr double kLargestInt = 2147483647.0;

struct Field {
  const char* name;
  Kind kind;
  const char* detail = "";
  bool required = false;
  double least = 0.0, most = 0.0;  // of kCount and kNumber; both 0: 0..2^53, or any number
};

struct ObjectSchema {
  const char* name;
  std::span<const Field> fields;
};

/// All objects that the table describes; "gltf" is the root.
std::span<const ObjectSchema> gltfSchema();

/// Holds the root object against the table: types, ranges, required members, every index. Members that the table does not
/// know are removed; whole numbers written as 3.0 become 3. Throws Error(place, "path: what was expected, what is there").
void checkAgainstSchema(nlohmann::json& root, const std::string& place);

}  // namespace gloam
