// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What of a frame a picture shows: its light, or one of the layers that it is made from.
#pragma once

#include <gloam/renderer.h>

#include <string>
#include <vector>

namespace gloam::cli {

/// A layer that render adds on request: ready for a display, as spheresPicture() makes it.
inline constexpr const char* kSpheresLayer = "spheres";
/// The same with the spheres drawn in as techniques take them.
inline constexpr const char* kShadowSpheresLayer = "shadow_spheres";
bool showsSpheres(const std::string& layer);

/// Layers that every frame has: "direct", "indirect", "normal", "depth", "albedo", "object", and those two. Other names are
/// images of a technique, which the renderer adds as RenderOptions::show.
const std::vector<std::string>& frameLayers();
bool isFrameLayer(const std::string& name);

/// Ready for a display (writePng encodes). Light (`layer` empty, "direct", "indirect", an image of a technique) is tone
/// mapped by `display`; an image of a technique that would be all but black is raised by whole stops before. Normals become
/// colours, depth grey from near (white) to far, objects get a colour each.
Image shownPicture(const LayeredImage& frame, const std::string& layer, const DisplayOptions& display);

/// The numbers themselves: the sum as R, G, B, A, or a layer as R, G, B.
Image lightOf(const LayeredImage& frame, const std::string& layer);

}  // namespace gloam::cli
