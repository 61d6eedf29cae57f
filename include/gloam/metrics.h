// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How far a picture is from its reference (REF-2), on linear values of any range. All functions take two pictures of one
// size and channel count and throw Error otherwise, or where a value is not finite; alpha (the channel after Y or after R,
// G, B) is not compared. A mask is a picture of one channel and the same size: pixels where it is 0 do not count; an empty
// one takes all.
#pragma once

#include <gloam/image.h>

namespace gloam {

struct MetricOptions {
  Image mask;
  /// For PSNR and SSIM: what counts as white. 0: the largest value of the reference, or 1 where none is above 0.
  double peak = 0.0;
  /// For FLIP: how many pixels stand for a degree of the eye. 67 is a 0.7 m wide 4K screen seen from 0.7 m, the authors'
  /// default.
  double pixels_per_degree = 67.0206;
  /// For LDR-FLIP: how both become light of a display. Automatic exposure is found for the reference and holds for both.
  DisplayOptions display{.tone_map = ToneMap::kAces, .exposure_stops = 0.0f, .auto_exposure = true};
};

/// All measures at once. Sums are in double precision. FLIP and SSIM see all of both pictures; a mask says whose errors
/// are averaged.
struct Metrics {
  std::size_t pixels = 0;       ///< that were compared
  double max_difference = 0.0;  ///< max |a - b| over pixels and colour channels
  double rmse = 0.0;            ///< sqrt(mean (a - b)^2) over pixels and colour channels
  double relative_rmse = 0.0;   ///< sqrt(relative_squared_error)
  double relative_squared_error =
      0.0;            ///< ||a - b||^2 / ||b||^2 as the papers print it; infinite for a black reference
  double psnr = 0.0;  ///< 10 log10(peak^2 / mse) in dB; infinite for equal pictures
  double ssim = 0.0;  ///< mean structural similarity of luminance (Wang et al. 2004), 1 for equal pictures
  double flip = 0.0;  ///< mean HDR-FLIP (Andersson et al. 2021), 0 to 1
  double ldr_flip =
      0.0;  ///< mean LDR-FLIP (Andersson et al. 2020) of both as a display shows them, tone-mapped alike
  double mean_signed_error = 0.0;      ///< mean (a - b): energy gained (positive) or lost
  double relative_signed_error = 0.0;  ///< the same over the mean of the reference
};
Metrics measure(const Image& a, const Image& reference, const MetricOptions& options = {},
                const Progress& progress = {});

// The single measures, where one is enough.
double maxDifference(const Image& a, const Image& reference);
double rmse(const Image& a, const Image& reference);
double relativeSquaredError(const Image& a, const Image& reference);
double psnr(const Image& a, const Image& reference, double peak = 0.0);
double meanSignedError(const Image& a, const Image& reference);

// ---- Difference pictures ----------------------------------------------------------------------------------------------

// Of the two pictures as a display shows them: linear 0 to 1 after `display`, encoded as sRGB. Automatic exposure is found
// for the reference and holds for both. The result is R, G, B linear as writePng takes it.
/// factor |a - b|, as papers print differences, with factor 2: black where equal.
Image absoluteDifferencePicture(const Image& a, const Image& reference, double factor,
                                const DisplayOptions& display);
/// 1/2 + factor (a - b) / 2: grey where equal, lighter where a is too bright.
Image differencePicture(const Image& a, const Image& reference, double factor, const DisplayOptions& display);
/// |a - b| summed over channels relative to the reference's mean (summed alike; 1 where that is not above 0), by a
/// perceptually even colour map (black 0, light at `top`): R, G, B linear as writePng takes it.
Image falseColor(const Image& a, const Image& reference, double top = 1.0);
/// Error 0 to 1 of each pixel, one channel.
Image flipMap(const Image& a, const Image& reference, double pixels_per_degree = 67.0206,
              const Progress& progress = {});
Image ldrFlipMap(const Image& a_display, const Image& reference_display, double pixels_per_degree = 67.0206,
                 const Progress& progress = {});
/// A map of 0 to 1 in the colours in which FLIP is printed: R, G, B linear as writePng takes it.
Image magma(const Image& map);

}  // namespace gloam
