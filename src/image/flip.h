// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// FLIP, the difference that a person sees who flips between two pictures. LDR: Andersson, Nilsson, Akenine-Moeller,
// Oskarsson, Astroem, Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images". HDR: Andersson, Nilsson,
// Shirley, Akenine-Moeller 2021, "Visualizing Errors in Rendered High Dynamic Range Images". Pictures are comparable
// (comparison.h); maps have one channel, 0 to 1.
#pragma once

#include <gloam/image.h>

#include <cmath>

#include "image/bands.h"

namespace gloam {

/// Of pictures as a display shows them: linear 0 to 1, what lies outside is clamped.
Image ldrFlip(const Image& a, const Image& reference, double pixels_per_degree, const WorkStage& stage);
/// Of radiance of any range: at each pixel the greatest LDR-FLIP over exposures that suit the reference.
Image hdrFlip(const Image& a, const Image& reference, double pixels_per_degree, const WorkStage& stage);

/// Exposures in stops, evenly from the one that keeps the reference's brightest pixel from burning out to the one that
/// does so for its median pixel.
struct FlipExposures {
  double start = 0.0, stop = 0.0;
  int count = 1;
  double at(int i) const { return count == 1 ? start : std::lerp(start, stop, double(i) / (count - 1)); }
};
FlipExposures flipExposures(const Image& reference);

/// The film curve of HDR-FLIP, linear 0 to 1 from exposed radiance of 0 to 1e6: Narkowicz 2015, "ACES Filmic Tone
/// Mapping Curve", with his factor 0.6 for exposure.
inline float flipToneCurve(float radiance) {
  const float x = 0.6f * radiance;
  const float mapped = (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
  return mapped < 1.0f ? mapped : 1.0f;
}

}  // namespace gloam
