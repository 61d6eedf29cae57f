// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options of every verb that shows light as a picture.
#pragma once

#include <gloam/image.h>

#include <string>

#include "arguments.h"

namespace gloam::cli {

struct DisplayChoice {
  float exposure_stops = 0.0f;
  bool auto_exposure = false;
  std::string tone_map = "aces";
  bool background = true;
};
void addDisplayOptions(CLI::App& app, DisplayChoice& choice);
DisplayOptions displayOf(const DisplayChoice& choice);

/// Automatic exposure is found on the first frame and held, so that a video does not pulse.
void holdExposure(DisplayOptions& display, const LayeredImage& frame);

}  // namespace gloam::cli
