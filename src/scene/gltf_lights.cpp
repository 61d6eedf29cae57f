// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Cameras and lights (glTF 2.0 specification, section 3.10; KHR_lights_punctual; EXT_lights_image_based).
#include <fmt/format.h>
#include <gloam/sh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/limits.h"
#include "scene/gltf_parts.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

}  // namespace

void readCameras(GltfReading& reading) {
  const auto& cameras = reading.document.model.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string where = fmt::format("cameras[{}]", i);
    Camera camera;
    camera.name = cameras[i].name.empty() ? where : cameras[i].name;
    camera.perspective = cameras[i].type == "perspective";
    if (camera.perspective) {
      const auto& source = cameras[i].perspective;
      camera.vertical_fov_rad = static_cast<float>(source.yfov);
      camera.aspect = static_cast<float>(source.aspectRatio);
      camera.z_near = static_cast<float>(source.znear);
      if (source.zfar > 0.0) camera.z_far = static_cast<float>(source.zfar);
      if (source.zfar > 0.0 && source.zfar <= source.znear)
        reading.document.fail(where + ".perspective.zfar", "more than znear was expected");
    } else {
      const auto& source = cameras[i].orthographic;
      camera.half_height = static_cast<float>(std::abs(source.ymag));
      if (source.xmag == 0.0 || source.ymag == 0.0)
        reading.document.fail(where + ".orthographic", "xmag and ymag must not be 0");
      camera.aspect = static_cast<float>(std::abs(source.xmag / source.ymag));
      camera.z_near = static_cast<float>(source.znear);
      camera.z_far = static_cast<float>(source.zfar);
      if (!(source.zfar > source.znear))
        reading.document.fail(where + ".orthographic.zfar", "more than znear was expected");
    }
    reading.scene.cameras.push_back(std::move(camera));
  }
}

void readLights(GltfReading& reading) {
  const Json* extension = GltfDocument::extension(reading.document.json, "KHR_lights_punctual");
  if (!extension) return;
  const Json& lights = (*extension)["lights"];
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Json& source = lights[i];
    const std::string where = fmt::format("extensions.KHR_lights_punctual.lights[{}]", i);
    Light light;
    light.name = nameOf(source, fmt::format("light {}", i));
    const std::string type = source["type"];
    if (type != "directional" && type != "point" && type != "spot") {
      reading.document.warn(fmt::format("{}.type: '{}' is left out", where, oneLine(type)));
      reading.light_of.push_back(kNone);
      continue;
    }
    reading.light_of.push_back(static_cast<int>(reading.scene.lights.size()));
    light.type = type == "directional" ? Light::Type::kDirectional
                 : type == "spot"      ? Light::Type::kSpot
                                       : Light::Type::kPoint;
    const double intensity = source.value("intensity", 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const double color = source.contains("color") ? std::max(source["color"][c].get<double>(), 0.0) : 1.0;
      light.intensity[static_cast<int>(c)] = static_cast<float>(std::min(color * intensity, 1e30));
    }
    light.range = source.value("range", 0.0f);
    if (light.type == Light::Type::kSpot) {
      if (!source.contains("spot")) reading.document.fail(where + ".spot", "missing");
      constexpr float kRightAngle = std::numbers::pi_v<float> / 2.0f;
      light.outer_cone_rad =
          std::min(source["spot"].value("outerConeAngle", kRightAngle / 2.0f), kRightAngle);
      light.inner_cone_rad = source["spot"].value("innerConeAngle", 0.0f);
      if (light.outer_cone_rad <= 0.0f)
        reading.document.fail(where + ".spot.outerConeAngle", "more than 0 was expected");
      if (light.inner_cone_rad >= light.outer_cone_rad) light.inner_cone_rad = 0.999f * light.outer_cone_rad;
    }
    reading.scene.lights.push_back(std::move(light));
  }
}

void readImageLight(GltfReading& reading) {
  GltfDocument& document = reading.document;
  if (document.model.scenes.empty()) return;
  const std::size_t shown = static_cast<std::size_t>(std::max(document.model.defaultScene, 0));
  const Json* use = GltfDocument::extension(document.json["scenes"][shown], "EXT_lights_image_based");
  if (!use) return;
  const std::size_t index = (*use)["light"];
  const std::string where = fmt::format("extensions.EXT_lights_image_based.lights[{}]", index);
  const Json& light = (*GltfDocument::extension(document.json, "EXT_lights_image_based"))["lights"][index];

  sh::ShRgb radiance(3);
  const Json& coefficients = light["irradianceCoefficients"];
  const std::string field = where + ".irradianceCoefficients";
  if (!coefficients.is_array() || coefficients.size() != 9) document.fail(field, "9 triples were expected");
  for (std::size_t i = 0; i < 9; ++i) {
    if (!coefficients[i].is_array() || coefficients[i].size() != 3)
      document.fail(field, "9 triples were expected");
    for (std::size_t c = 0; c < 3; ++c) {
      const Json& value = coefficients[i][c];
      if (!value.is_number() || !(std::abs(value.get<double>()) < 1e30))
        document.fail(field, "9 triples of numbers were expected");
      const int band = i == 0 ? 0 : i < 4 ? 1 : 2;
      radiance[static_cast<int>(i)][static_cast<int>(c)] = value.get<float>() / sh::clampedCosineFactor(band);
    }
  }
  if (light.contains("rotation")) {
    const Json& q = light["rotation"];
    const glm::quat rotation(q[3].get<float>(), q[0].get<float>(), q[1].get<float>(), q[2].get<float>());
    if (glm::length(rotation) > 1e-6f)
      radiance = sh::rotate(glm::mat3_cast(glm::normalize(rotation)), radiance);
  }

  Environment& environment = reading.scene.environment;
  environment.name = "EXT_lights_image_based";
  environment.width = 64, environment.height = 32;  // ample for three bands
  environment.intensity = light.value("intensity", 1.0f);
  for (int row = 0; row < environment.height; ++row)
    for (int column = 0; column < environment.width; ++column) {
      const double u = (column + 0.5) / environment.width, v = 1.0 - (row + 0.5) / environment.height;
      const double azimuth = (2.0 * u - 1.0) * std::numbers::pi, elevation = (v - 0.5) * std::numbers::pi;
      const glm::vec3 direction(std::cos(elevation) * std::cos(azimuth), std::sin(elevation),
                                std::cos(elevation) * std::sin(azimuth));
      environment.radiance.push_back(glm::max(sh::valueAt(radiance, direction), glm::vec3(0.0f)));
    }
  document.warn(where + ": light comes from its irradiance coefficients; its specular pictures are left out");
}

}  // namespace gloam
