// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/image.h>

#include <optional>
#include <string>

namespace gloam::cli {

/// One channel: 1 where a picture shows a surface, by its layer "object", else by alpha above 0; 0 where its layer "seen" says that
/// the surface itself shines (light that is the same in every picture of it), unless all do. Throws Error(place, …) where neither tells.
Image surfaceMask(const LayeredImage& picture, const std::string& place);

/// The relative RMSE within the mask that is to be expected of chance alone, where `variance` is the mean of the light's R, G and B
/// over all pixels (the attribute gloam.variance of a reference). Nothing where that light is black.
std::optional<double> relativeNoise(double variance, const Image& light, const Image& mask);

}  // namespace gloam::cli
