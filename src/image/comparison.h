// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What all comparisons of two pictures begin with.
#pragma once

#include <gloam/image.h>

#include <vector>

namespace gloam {

/// Throws Error where the pictures differ in size or channels, hold nothing, or a colour is not finite ("pixel (3, 1) is
/// not finite in the reference").
void requireComparable(const Image& a, const Image& reference);
/// Throws Error where a mask does not fit to the picture, is not finite, or takes no pixel. An empty mask fits.
void requireMask(const Image& mask, const Image& reference);
inline bool takes(const Image& mask, std::size_t pixel) {
  return mask.empty() || mask.pixels[pixel] != 0.0f;
}
/// Throws Error for anything but 1 to 1000.
void requirePixelsPerDegree(double pixels_per_degree);

/// How many of the channels are colours: 3, or 1.
inline int colorChannels(const Image& image) {
  return image.channels >= 3 ? 3 : 1;
}

/// The same without automatic exposure: what it finds for the reference is in the stops.
DisplayOptions displayFor(const Image& reference, DisplayOptions display);

/// The mean of a map of one channel over the pixels that a mask takes.
double meanOf(const Image& map, const Image& mask);

}  // namespace gloam
