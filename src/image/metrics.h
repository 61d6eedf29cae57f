// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How far a picture is from its reference (REF-2), on linear values of any range. All functions take two
// pictures of one size and channel count and throw Error otherwise, or where a value is not finite; alpha
// (the channel after Y or after R, G, B) is not compared.
#pragma once

#include <gloam/image.h>

namespace gloam {

/// max |a - b| over pixels and colour channels.
double maxDifference(const Image& a, const Image& reference);

/// sqrt(mean (a - b)^2) over pixels and colour channels.
double rmse(const Image& a, const Image& reference);

/// ||a - b||^2 / ||b||^2 as the papers print it; b is the reference. 0 for two black pictures, infinite for a
/// black reference alone.
double relativeSquaredError(const Image& a, const Image& reference);

/// 10 log10(peak^2 / mse) in dB; infinite for equal pictures. `peak` 0 takes the largest value of the
/// reference.
double psnr(const Image& a, const Image& reference, double peak = 0.0);

/// mean (a - b): energy gained (positive) or lost.
double meanSignedError(const Image& a, const Image& reference);

}  // namespace gloam
