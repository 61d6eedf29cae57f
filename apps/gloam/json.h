// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/core.h>

#include <cmath>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace gloam::cli {

/// Keeps the order in which keys were added. What is not a finite number becomes null.
using Json = nlohmann::ordered_json;

/// 0.1f as 0.1, not as 0.10000000149011612.
inline Json shortest(float value) {
  return std::isfinite(value) ? Json(std::stod(fmt::format("{}", value))) : Json();
}
inline Json shortest(const glm::vec3& v) {
  return {shortest(v.x), shortest(v.y), shortest(v.z)};
}

/// Indented; bytes that are not UTF-8 (names from files) are replaced.
inline std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gloam::cli
