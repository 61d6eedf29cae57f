// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lights as a person writes them (docs/lights.md): NAME?key=value&key=time:value,time:value.
#include <fmt/core.h>
#include <fmt/format.h>
#include <gloam/lights.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/environment.h"
#include "scene/sky.h"

namespace gloam {
namespace {

constexpr float kDegree = 3.14159265f / 180.0f;
constexpr std::size_t kMostLights = 4096, kMostKeys = 1000;
const char* const kNames = "disc, constant, gradient, sky:NAME, probe:FILE";

/// Ascending times; linear between them, held before and after.
struct Keyed {
  std::vector<std::pair<double, double>> keys;  // seconds, value
  double at(double time_s) const {
    const auto after = std::ranges::upper_bound(keys, time_s, {}, &std::pair<double, double>::first);
    if (after == keys.begin()) return keys.front().second;
    if (after == keys.end()) return keys.back().second;
    const auto& [t0, v0] = *(after - 1);
    const auto& [t1, v1] = *after;
    return v0 + (v1 - v0) * (time_s - t0) / (t1 - t0);
  }
};

double numberOf(std::string_view text, const std::string& place, std::string_view key) {
  double number = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(number))
    throw Error(place, fmt::format("{}: '{}' is not a number, or time:number,time:number …", key, text));
  return number;
}

Keyed keyedOf(std::string_view text, const std::string& place, std::string_view key) {
  if (text.find(':') == std::string_view::npos) return {{{0.0, numberOf(text, place, key)}}};
  Keyed keyed;
  while (true) {
    const std::string_view pair = text.substr(0, text.find(','));
    const std::size_t colon = pair.find(':');
    if (colon == std::string_view::npos)
      throw Error(place, fmt::format("{}: '{}' is not time:number", key, pair));
    const double time_s = numberOf(pair.substr(0, colon), place, key);
    if (!keyed.keys.empty() && time_s <= keyed.keys.back().first)
      throw Error(place,
                  fmt::format("{}: times must ascend; {} follows {}", key, time_s, keyed.keys.back().first));
    keyed.keys.emplace_back(time_s, numberOf(pair.substr(colon + 1), place, key));
    if (keyed.keys.size() > kMostKeys)
      throw Error(place, fmt::format("{}: more than {} keys", key, kMostKeys));
    if (pair.size() == text.size()) return keyed;
    text.remove_prefix(pair.size() + 1);
  }
}

std::map<std::string, Keyed> valuesOf(std::string_view text, const std::string& place) {
  std::map<std::string, Keyed> values;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string_view::npos)
      throw Error(place, fmt::format("'{}' is not key=value", pair));
    const std::string key(pair.substr(0, equals));
    if (!values.emplace(key, keyedOf(pair.substr(equals + 1), place, key)).second)
      throw Error(place, fmt::format("{} is given twice", key));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
  }
  return values;
}

glm::vec3 takeColor(NamedValues& values, const std::string& prefix, const glm::vec3& default_value) {
  return {values.take(prefix + "red", double(default_value.r), 0, 1e6),
          values.take(prefix + "green", double(default_value.g), 0, 1e6),
          values.take(prefix + "blue", double(default_value.b), 0, 1e6)};
}

DistantLight disc(NamedValues& values) {
  DistantLight light{.kind = DistantLight::Kind::kDisc};
  const auto elevation = float(values.take("elevation", 45, -90, 90));
  light.direction = glm::normalize(skyDirection(elevation, float(values.take("azimuth", 0, -36000, 36000))));
  light.radius_rad = kDegree * float(values.take("radius", 5, 0.05, 180));
  const bool by_radiance = values.has("radiance");
  if (by_radiance && values.has("irradiance"))
    throw Error(values.place(), "radiance and irradiance exclude each other");
  const auto radiance = float(values.take("radiance", 1, 0, 1e9));
  const auto irradiance = float(values.take("irradiance", 1, 0, 1e9));
  const glm::vec3 color = takeColor(values, "", glm::vec3(1.0f));
  light.radiance =
      color * (by_radiance ? glm::vec3(radiance) : discRadiance(glm::vec3(irradiance), light.radius_rad));
  return light;
}

DistantLight constant(NamedValues& values) {
  DistantLight light{.kind = DistantLight::Kind::kConstant};
  light.radiance = float(values.take("radiance", 1, 0, 1e9)) * takeColor(values, "", glm::vec3(1.0f));
  return light;
}

// The colours of sky:gradient, unless others are given.
DistantLight gradient(NamedValues& values) {
  DistantLight light{.kind = DistantLight::Kind::kGradient};
  const auto radiance = float(values.take("radiance", 1, 0, 1e9));
  light.zenith = radiance * takeColor(values, "zenith_", {0.25f, 0.45f, 0.95f});
  light.horizon = radiance * takeColor(values, "horizon_", {0.95f, 0.95f, 0.9f});
  light.nadir = radiance * takeColor(values, "nadir_", {0.28f, 0.24f, 0.2f});
  return light;
}

DistantLight turned(DistantLight light, NamedValues& values) {
  light.rotation_rad = kDegree * float(values.take("rotation", 0, -36000, 36000));
  light.intensity = float(values.take("intensity", 1, 0, 1e6));
  return light;
}

/// Its function, and its discs as lights of their own; the ground is what all of them send down.
std::vector<DistantLight> skyLights(NamedValues& values) {
  const SkyParts parts = skyParts(values);
  std::vector<DistantLight> lights;
  const float c = std::cos(parts.rotation_rad), s = std::sin(parts.rotation_rad);
  glm::vec3 ground(0.0f);
  for (const SkyDisc& disc : parts.discs) {
    DistantLight light{.kind = DistantLight::Kind::kDisc, .radius_rad = disc.half_angle_rad};
    light.direction = {c * disc.axis.x + s * disc.axis.z, disc.axis.y, c * disc.axis.z - s * disc.axis.x};
    light.radiance = parts.intensity * discRadiance(disc.irradiance, disc.half_angle_rad);
    ground += disc.irradiance * std::max(0.0f, disc.axis.y);
    lights.push_back(light);
  }
  DistantLight sky{.kind = DistantLight::Kind::kFunction, .function = parts.radiance};
  sky.rotation_rad = parts.rotation_rad;
  sky.intensity = parts.intensity;
  if (parts.ground_albedo) {
    // Irradiance of level ground: the cosine has no coefficients of odd bands past 1, so that five bands of the half that is
    // above would err; it is integrated as it stands.
    const auto above = [&](const glm::vec3& d) {
      return d.y > 0.0f ? parts.radiance(d) * d.y : glm::vec3(0.0f);
    };
    const DistantLight falling{.kind = DistantLight::Kind::kFunction, .function = above};
    ground += projectLight(falling, 1)[0] * std::sqrt(4.0f * 180.0f * kDegree);
    const glm::vec3 radiance = *parts.ground_albedo * ground / (180.0f * kDegree);
    sky.function = [radiance, upper = parts.radiance](const glm::vec3& d) {
      return d.y < 0.0f ? radiance : upper(d);
    };
  }
  lights.push_back(std::move(sky));
  return lights;
}

}  // namespace

struct AnimatedLights::Light {
  std::string text, name;
  std::map<std::string, Keyed> values;
  std::shared_ptr<const Environment> map;  // of a probe
  std::shared_ptr<const sh::ShRgb> map_sh;
  std::vector<DistantLight> fixed;  // where nothing moves

  bool moves() const {
    return std::ranges::any_of(values, [](const auto& value) { return value.second.keys.size() > 1; });
  }
  std::vector<DistantLight> at(double time_s) const {
    std::map<std::string, double> now;
    for (const auto& [key, keyed] : values) now.emplace(key, keyed.at(time_s));
    NamedValues values_now(text, name, std::move(now));
    std::vector<DistantLight> lights;
    if (name == "disc") {
      lights = {disc(values_now)};
    } else if (name == "constant") {
      lights = {constant(values_now)};
    } else if (name == "gradient") {
      lights = {gradient(values_now)};
    } else if (map) {
      lights = {turned({.kind = DistantLight::Kind::kMap, .map = map, .known_sh = map_sh}, values_now)};
    } else {
      return skyLights(values_now);
    }
    values_now.finish();
    return lights;
  }
};

namespace {

std::shared_ptr<const AnimatedLights::Light> parseLight(const std::string& text) {
  auto light = std::make_shared<AnimatedLights::Light>();
  light->text = text;
  const std::size_t question = text.rfind('?');
  light->name = text.substr(0, question);
  if (question != std::string::npos)
    light->values = valuesOf(std::string_view(text).substr(question + 1), text);
  if (light->name.starts_with("sky:")) {
    light->name = light->name.substr(4);
  } else if (light->name.starts_with("probe:")) {
    light->map = std::make_shared<const Environment>(loadEnvironment(light->name.substr(6)));
    light->map_sh = std::make_shared<const sh::ShRgb>(projectEnvironment(*light->map, sh::kMaxOrder));
  } else if (light->name != "disc" && light->name != "constant" && light->name != "gradient") {
    throw Error(text, fmt::format("no such light; there are {}, and .json files with lists of them", kNames));
  }
  // Between two keys a value lies between theirs: what is good at all keys is good everywhere.
  std::vector<double> times = {0.0};
  for (const auto& [key, keyed] : light->values) {
    for (const auto& [time_s, value] : keyed.keys) times.push_back(time_s);
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  for (const double time_s : times) light->at(time_s);
  if (light->moves()) return light;
  light->fixed = light->at(0.0);
  for (DistantLight& fixed : light->fixed) {
    if (fixed.kind != DistantLight::Kind::kFunction) continue;
    DistantLight plain = fixed;
    plain.rotation_rad = 0.0f;
    plain.intensity = 1.0f;
    fixed.known_sh = std::make_shared<const sh::ShRgb>(projectLight(plain, sh::kMaxOrder));
  }
  return light;
}

std::vector<std::string> textsOfFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path, "cannot be read");
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  const auto isText = [](const nlohmann::json& value) { return value.is_string(); };
  constexpr const char* kExpected = "a JSON list of lights was expected, such as [\"disc?elevation=30\"]";
  if (!json.is_array()) throw Error(path, kExpected);
  const auto other = std::ranges::find_if_not(json, isText);
  if (other != json.end())
    throw Error(path, fmt::format("entry {} is {} {}: {}", other - json.begin(),
                                  other->is_array() || other->is_object() ? "an" : "a", other->type_name(),
                                  kExpected));
  return json.get<std::vector<std::string>>();
}

}  // namespace

AnimatedLights AnimatedLights::parse(std::span<const std::string> texts) {
  AnimatedLights lights;
  const auto add = [&](const std::string& text) {
    if (lights.lights_.size() == kMostLights)
      throw Error(text, fmt::format("more than {} lights", kMostLights));
    lights.lights_.push_back(parseLight(text));
  };
  for (const std::string& text : texts) {
    if (!text.ends_with(".json")) {
      add(text);
      continue;
    }
    for (const std::string& line : textsOfFile(text)) add(line);
  }
  return lights;
}

std::vector<DistantLight> AnimatedLights::at(float time_s) const {
  std::vector<DistantLight> all;
  for (const auto& light : lights_) {
    const std::vector<DistantLight> now = light->moves() ? light->at(double(time_s)) : light->fixed;
    all.insert(all.end(), now.begin(), now.end());
  }
  return all;
}

bool AnimatedLights::moves() const {
  return std::ranges::any_of(lights_, [](const auto& light) { return light->moves(); });
}

std::string AnimatedLights::text() const {
  std::vector<std::string> texts;
  for (const auto& light : lights_) texts.push_back(light->text);
  return fmt::format("{}", fmt::join(texts, " + "));
}

}  // namespace gloam
