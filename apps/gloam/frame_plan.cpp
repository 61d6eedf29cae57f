// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame_plan.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

namespace gloam::cli {
namespace {

constexpr int kMaxFrames = 100000;

MotionChoice::Interval parseInterval(const std::string& text) {
  const Range range{0.0, 1e6};
  try {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const auto from = float(parseNumber("", text.substr(0, colon), range));
    const auto to = float(parseNumber("", text.substr(std::min(colon + 1, text.size())), range));
    if (to > from) return {from, to};
  } catch (const Error&) {
  }
  throw Error("--animate", fmt::format("'{}': expected seconds FROM:TO, such as 0:4", text));
}

}  // namespace

void addMotionOptions(CLI::App& app, MotionChoice& choice) {
  addInteger(app, "--orbit", choice.orbit_frames, {1, kMaxFrames}, "N",
             "a turntable of N frames: the camera goes once round the scene")
      ->group("Motion");
  const auto setInterval = [&choice](const std::string& text) { choice.animate = parseInterval(text); };
  app.add_option_function<std::string>("--animate", setInterval, "frames from one second to another")
      ->type_name("FROM:TO")
      ->group("Motion");
  addNumber(app, "--fps", choice.frames_per_second, {0.1, 1000.0}, "F", "frames a second")
      ->default_str("30")
      ->group("Motion");
}

void addSkyMotion(CLI::App& app, MotionChoice& choice) {
  addNumber(app, "--turn-sky", choice.turn_sky_deg, {-36000.0, 36000.0}, "DEGREES",
            "the environment turns by that much over the frames, about the vertical")
      ->default_str("0")
      ->group("Motion");
}

std::vector<PlannedFrame> planFrames(const MotionChoice& choice, float time_s) {
  double count = std::max(choice.orbit_frames, 1);
  if (choice.animate && choice.orbit_frames == 0) {
    const double length_s = double(choice.animate->to_s) - double(choice.animate->from_s);
    count = std::max(1.0, std::round(length_s * double(choice.frames_per_second)));
    if (count > kMaxFrames) {
      throw Error("--animate", fmt::format("{:.0f} frames; expected at most {}", count, kMaxFrames));
    }
  }
  std::vector<PlannedFrame> frames;
  for (int i = 0; i < int(count); ++i) {
    const double part = double(i) / count;
    PlannedFrame frame{time_s, 0.0f};
    if (choice.orbit_frames > 0) frame.orbit_rad = float(2.0 * std::numbers::pi * part);
    frame.sky_rad = float(part * double(choice.turn_sky_deg) * std::numbers::pi / 180.0);
    if (choice.animate) {
      const double step_s = choice.orbit_frames > 0
                                ? part * (double(choice.animate->to_s) - double(choice.animate->from_s))
                                : double(i) / double(choice.frames_per_second);
      frame.time_s = float(double(choice.animate->from_s) + step_s);
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace gloam::cli
