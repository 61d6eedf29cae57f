// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sky that our writer notes in the scene's extras, by name.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/limits.h"
#include "scene/gltf_parts.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

float numberOr(GltfReading& reading, const Json& object, const char* name, float otherwise, float least,
               float most, const std::string& where) {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  const double value = found->is_number() ? found->get<double>() : NAN;
  if (!(value >= least && value <= most)) {
    reading.document.fail(where + "." + name,
                          fmt::format("a number from {} to {} was expected", least, most));
  }
  return float(value);
}

}  // namespace

void readNamedSky(GltfReading& reading) {
  GltfDocument& document = reading.document;
  if (document.model.scenes.empty()) return;
  const std::size_t shown = std::size_t(std::max(document.model.defaultScene, 0));
  const Json& scene = document.json["scenes"][shown];
  const auto extras = scene.find("extras");
  if (extras == scene.end() || !extras->is_object() || !extras->contains("gloam_environment")) return;
  const Json& sky = (*extras)["gloam_environment"];
  const std::string where = fmt::format("scenes[{}].extras.gloam_environment", shown);
  if (!sky.is_object() || !sky.contains("name") || !sky["name"].is_string()) {
    document.fail(where + ".name", "the name of a sky was expected");
  }
  const std::string name = sky["name"];
  if (!name.starts_with("sky:")) document.fail(where + ".name", "'" + oneLine(name) + "' is no sky");
  try {
    reading.scene.environment = loadEnvironment(name);
  } catch (const Error& error) {
    document.fail(where + ".name", oneLine(error.what()));
  }
  Environment& environment = reading.scene.environment;
  environment.rotation_rad =
      numberOr(reading, sky, "rotation_rad", environment.rotation_rad, -1e3f, 1e3f, where);
  environment.intensity = numberOr(reading, sky, "intensity", environment.intensity, 0.0f, 1e9f, where);
}

}  // namespace gloam
