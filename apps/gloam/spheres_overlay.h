// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres drawn over the picture of what they stand for.
#pragma once

#include <gloam/renderer.h>
#include <gloam/spheres.h>

namespace gloam::cli {

/// The frame as `display` shows it, greyed, with the spheres as translucent shells of a colour each; surfaces in front of a
/// sphere hide it. Needs the frame's layer "depth". R, G, B in linear 0 to 1, as writePng takes it.
Image spheresPicture(const LayeredImage& frame, const std::vector<PosedSphere>& spheres,
                     const PosedCamera& camera, const DisplayOptions& display);

}  // namespace gloam::cli
