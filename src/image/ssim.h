// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/image.h>

#include "image/bands.h"

namespace gloam {

/// Structural similarity of luminance at each pixel, one channel: 1 where equal, -1 at least. `peak` counts as white.
/// Both pictures are comparable (comparison.h).
Image ssimMap(const Image& a, const Image& reference, double peak, const WorkStage& stage);

}  // namespace gloam
