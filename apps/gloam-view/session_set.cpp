// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Names and values of scripts: those of presets, and what a window has besides.
#include <fmt/core.h>

#include <functional>
#include <map>

#include "arguments.h"
#include "session.h"

namespace gloam::view {
namespace {

using Setter = std::function<void(Session&, const std::string& name, const std::string& value)>;

bool flagOf(const std::string& name, const std::string& value) {
  if (value != "true" && value != "false")
    throw Error(name, fmt::format("'{}': expected true or false", value));
  return value == "true";
}

float numberOf(const std::string& name, const std::string& value, double low, double high) {
  return float(cli::parseNumber(name, value, {low, high}));
}

void setExposure(Session& s, const std::string& name, const std::string& value) {
  s.state.display.auto_exposure = value == "auto";
  s.state.display.exposure_stops = value == "auto" ? 0.0f : numberOf(name, value, -50.0, 50.0);
}

void setToneMap(Session& s, const std::string& name, const std::string& value) {
  if (value != "aces" && value != "none")
    throw Error(name, fmt::format("'{}': expected none or aces", value));
  s.state.display.tone_map = value == "aces" ? ToneMap::kAces : ToneMap::kNone;
}

void setSplitBy(Session& s, const std::string& name, const std::string& value) {
  if (value == "none") return s.setSplit(Split::kNone);
  if (value == "reference") return s.setSplit(Split::kReference);
  if (value != "technique") {
    throw Error(name, fmt::format("'{}': expected none, technique or reference", value));
  }
  s.setSplit(Split::kTechnique);
}

const std::map<std::string, Setter>& setters() {
  using S = Session;
  using T = const std::string;
  static const std::map<std::string, Setter> kSetters = {
      {"exposure", setExposure},
      {"tone_map", setToneMap},
      {"split", setSplitBy},
      {"technique", [](S& s, T&, T& v) { s.pick(kLeft, v); }},
      {"right", [](S& s, T&, T& v) { s.pick(kRight, v); }},
      {"scene", [](S& s, T&, T& v) { s.open(v); }},
      {"env", [](S& s, T&, T& v) { s.openEnvironment(v); }},
      {"env_rotation", [](S& s, T& n, T& v) { s.state.env_rotation_deg = numberOf(n, v, -36000, 36000); }},
      {"env_intensity", [](S& s, T& n, T& v) { s.state.env_intensity = numberOf(n, v, 0, 1e6); }},
      {"background", [](S& s, T& n, T& v) { s.state.background = flagOf(n, v); }},
      {"show", [](S& s, T&, T& v) { s.setShow(v); }},
      {"time", [](S& s, T& n, T& v) { s.setTime(numberOf(n, v, 0, 1e6)); }},
      {"play", [](S& s, T& n, T& v) { s.play(flagOf(n, v)); }},
      {"scale", [](S& s, T& n, T& v) { s.resolution.fixed = v == "auto" ? 0.0f : numberOf(n, v, 0.05, 1); }},
      {"divider", [](S& s, T& n, T& v) { s.divider = numberOf(n, v, 0, 1); }},
      {"fov", [](S& s, T& n, T& v) { s.camera.setFov(glm::radians(numberOf(n, v, 1, 170))); }},
      {"ortho", [](S& s, T& n, T& v) { s.camera.setOrtho(numberOf(n, v, 1e-6, 1e9)); }},
      {"eye", [](S& s, T& n, T& v) { s.camera.setTarget(cli::parseVector(n, v), s.camera.target()); }},
      {"target", [](S& s, T& n, T& v) { s.camera.setTarget(s.camera.eye(), cli::parseVector(n, v)); }},
      {"reference_samples",
       [](S& s, T& n, T& v) {
         s.reference_choice.samples = cli::parseInteger(n, v, {1, 1 << 20});
       }},
      {"reference_bounces", [](S& s, T& n, T& v) {
         s.reference_choice.bounces = cli::parseInteger(n, v, {0, 64});
       }}};
  return kSetters;
}

}  // namespace

void Session::set(const std::string& name, const std::string& value) {
  if (const auto setter = setters().find(name); setter != setters().end()) {
    setter->second(*this, name, value);
    changed();
    return;
  }
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos) {
    const std::string whose = name.substr(0, dot), option = name.substr(dot + 1);
    for (const Side side : {kLeft, kRight}) {
      if (whose == wanted[side].info->name || (side == kRight && whose == "right"))
        return setOption(side, option, value);
    }
    throw Error(name, fmt::format("{} is not the technique that is shown", whose));
  }
  std::vector<std::string> names;
  for (const auto& [known, unused] : setters()) names.push_back(known);
  throw Error(name, fmt::format("nothing is called so; expected {} or TECHNIQUE.OPTION", cli::listed(names)));
}

}  // namespace gloam::view
