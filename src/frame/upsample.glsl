// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8 (Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007): how well a coarse receiver stands for a pixel, by which bilinear
// weights are multiplied: max(0, N_p.N_i)^32 / (eps + |z_p - z_i|). Differs from the paper: z_p is the depth that the pixel's own
// plane has where the receiver stands. So all receivers on a slanted surface count, not the nearest alone, which shows as bands.
#ifndef GLOAM_FRAME_UPSAMPLE_GLSL
#define GLOAM_FRAME_UPSAMPLE_GLSL

#include "frame/frame_shared.h"

/// Relative to the pixel's own depth: differences below it count alike.
const float kDepthTolerance = 2e-3;
/// Sums of weights below this mean that no receiver fits.
const float kPoorFit = 0.05;
/// Where pixels can be found otherwise: below the first sum that alone counts, from the second on these weights alone. Between,
/// both are blended, so that nothing switches as edges go by.
const float kScratchFit = 0.4, kGoodFit = 0.6;
const float kLeastBilinear = 1e-3;

/// A number that changes evenly over the picture of a plane: depth along the axis where rays are parallel, else its inverse. 0 for
/// background (depth 0).
float evenDepth(FrameView view, float along) {
  return view.depth_range > 0.0 ? along : along > 0.0 ? 1.0 / along : 0.0;
}

/// A surface through a pixel, as flat as it is there.
struct PixelPlane {
  float depth;      // even
  vec2 change;      // of that by a pixel to the right and down
  float tolerance;  // of even depth
};
PixelPlane pixelPlane(FrameView view, ivec2 pixel, float along, vec3 geometric) {
  bool parallel = view.depth_range > 0.0;
  float depth = evenDepth(view, along);
  vec2 middle = vec2(pixel) + 0.5;
  vec3 ray = parallel ? view.forward : view.corner + middle.x * view.step_x + middle.y * view.step_y;
  float here = dot(geometric, ray);
  float scale = (parallel ? -1.0 : depth) / (abs(here) < 1e-4 ? 1e-4 : here);
  return PixelPlane(depth, scale * vec2(dot(geometric, view.step_x), dot(geometric, view.step_y)),
                    kDepthTolerance * (parallel ? along : depth));
}

/// 0 to 1. `receiver`: normal, and its even depth, 0 for background; it stands that many pixels away.
float receiverFitness(vec4 receiver, vec3 normal, PixelPlane plane, vec2 pixels) {
  float c = max(0.0, dot(normal, receiver.xyz));
  float c2 = c * c, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8;
  float off = abs(plane.depth + dot(plane.change, pixels) - receiver.w);
  return receiver.w <= 0.0 ? 0.0 : c16 * c16 * plane.tolerance / (plane.tolerance + off);
}

/// Where a pixel lies among receivers, which stand at the middle pixels of their blocks (frame_receivers).
vec2 receiverPlace(ivec2 pixel, uint divisor) {
  return (vec2(pixel) - float(divisor / 2u)) / float(divisor);
}

#endif
