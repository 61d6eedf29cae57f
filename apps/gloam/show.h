// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What of a frame a picture shows: its light, or one of the layers that it is made from.
#pragma once

#include <gloam/renderer.h>

#include <string>
#include <vector>

namespace gloam::cli {

/// "direct", "indirect", "normal", "depth", "albedo", "object".
const std::vector<std::string>& shownLayers();

/// Ready for a display (writePng encodes). Light (`layer` empty, "direct", "indirect") is tone mapped by `display`;
/// normals become colours, depth grey from near (white) to far, objects get a colour each.
Image shownPicture(const LayeredImage& frame, const std::string& layer, const DisplayOptions& display);

/// The sum as R, G, B, A (or R, G, B where a frame has no alpha), or one layer of light.
Image lightOf(const LayeredImage& frame, const std::string& layer);

}  // namespace gloam::cli
