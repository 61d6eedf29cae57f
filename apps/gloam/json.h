// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace gloam::cli {

/// Keeps the order in which keys were added. What is not a finite number becomes null.
using Json = nlohmann::ordered_json;

/// Indented; bytes that are not UTF-8 (names from files) are replaced.
inline std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gloam::cli
