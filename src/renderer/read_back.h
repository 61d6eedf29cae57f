// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From images on the device to layers in memory.
#pragma once

#include <gloam/image.h>

#include "frame/shade.h"
#include "gpu/frame_graph.h"

namespace gloam {

/// The layers that docs/images.md names, "direct" and "indirect" where `parts` is true. Waits for the device.
LayeredImage readLayers(const frame::FrameImages& images, bool parts);

/// Any image of the frame as R, G, B of the picture's size (nearest pixel), for eyes: numbers as they are,
/// one channel grey, integers as colours of their own, depth buffers as they are. Throws Error that lists the
/// names.
Image readShown(const gpu::FrameGraph& graph, const std::string& name, int width, int height);

/// Names that readShown takes.
std::vector<std::string> shownNames(const gpu::FrameGraph& graph);

}  // namespace gloam
