// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/image.h>

#include <string>

namespace gloam::cli {

/// One channel: 1 where a picture shows a surface, by its layer "object", else by alpha above 0; 0 where its layer "seen" says that
/// the surface itself shines (light that is the same in every picture of it), unless all do. Throws Error(place, …) where neither tells.
Image surfaceMask(const LayeredImage& picture, const std::string& place);

}  // namespace gloam::cli
