// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "display_choice.h"

#include <image/tonemap.h>

#include "show.h"

namespace gloam::cli {

void addDisplayOptions(CLI::App& app, DisplayChoice& choice) {
  const auto setExposure = [&choice](const std::string& text) {
    choice.auto_exposure = text == "auto";
    try {
      choice.exposure_stops = text == "auto" ? 0.0f : float(parseNumber("--exposure", text, {-50.0, 50.0}));
    } catch (const Error& error) {
      throw Error(std::string(error.what()) + ", or auto");
    }
  };
  app.add_option_function<std::string>("--exposure", setExposure,
                                       "stops (factor 2^STOPS), or found in the first frame")
      ->type_name("STOPS|auto")
      ->default_str("0")
      ->group("Output");
  addChoice(app, "--tone-map", choice.tone_map, {"none", "aces"},
            "curve for PNG and video; EXR and HDR stay linear")
      ->default_str("aces")
      ->group("Output");
  app.add_flag("--background,!--no-background", choice.background,
               "draw the light behind the scene, or leave it clear [on]")
      ->group("Output");
}

DisplayOptions displayOf(const DisplayChoice& choice) {
  DisplayOptions display;
  display.tone_map = choice.tone_map == "none" ? ToneMap::kNone : ToneMap::kAces;
  display.exposure_stops = choice.exposure_stops;
  display.auto_exposure = choice.auto_exposure;
  return display;
}

void holdExposure(DisplayOptions& display, const LayeredImage& frame) {
  if (!display.auto_exposure) return;
  display.exposure_stops += autoExposureStops(meanLog2Luminance(lightOf(frame, "")));
  display.auto_exposure = false;
}

}  // namespace gloam::cli
