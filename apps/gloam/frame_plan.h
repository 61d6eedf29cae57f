// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which frames to draw: one, a turntable, an animation, or both at once.
#pragma once

#include <optional>
#include <vector>

#include "arguments.h"

namespace gloam::cli {

struct MotionChoice {
  int orbit_frames = 0;  ///< 0: the camera stands
  struct Interval {
    float from_s, to_s;
  };
  std::optional<Interval> animate;
  float frames_per_second = 30.0f;
  float turn_sky_deg = 0.0f;  ///< over all frames
  bool moves() const { return orbit_frames > 0 || animate.has_value(); }
};
void addMotionOptions(CLI::App& app, MotionChoice& choice);
/// --turn-sky, for verbs whose light may change from frame to frame.
void addSkyMotion(CLI::App& app, MotionChoice& choice);

struct PlannedFrame {
  float time_s;
  float orbit_rad;
  float sky_rad = 0.0f;  ///< how far the environment has turned
};
/// One frame at `time_s`; --orbit N: N frames, a full turn; --animate A:B: (B - A) * fps frames from A on, the end left
/// out so that a cycle closes; both: N frames that spread over A to B while the camera turns once. Throws Error above
/// 100,000 frames.
std::vector<PlannedFrame> planFrames(const MotionChoice& choice, float time_s);

}  // namespace gloam::cli
