// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_RADIANCE_FILTER_SHARED_H
#define GLOAM_RADIANCE_FILTER_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(radiance_filter)

/// What a pixel keeps of one part of the light (all of it, or direct and indirect apart): halves, four a texel, layer after layer
/// of an image. Field: RGB of nine coefficients (RF-3), then the weight. Lobes (classical): irradiance, gloss, 0, the weight.
GLOAM_SHARED_CONST int kFieldLayers = 7;
GLOAM_SHARED_CONST int kLobeLayers = 2;

/// The sharpest Phong lobe that is shaded from a field: three bands carry 8.4 of a mirror's 9 / (4 pi) there. Sharper ones differ
/// by less than 7 % at the peak, and ring.
GLOAM_SHARED_CONST float kSharpestLobe = 20.0f;

/// Cosine between geometric normals beyond which pixels are not averaged: what arrives ends at the plane of a surface, and beyond a
/// crease that is another plane. Shading normals are not looked at.
GLOAM_SHARED_CONST float kCrease = 0.5f;

/// Taps a side of the filter, at most. Up to half as many find another pixel of the same set where one is not of the surface:
/// bits of a word.
GLOAM_SHARED_CONST int kMostTaps = 32;
GLOAM_SHARED_CONST int kMostTapsReplaced = 16;

/// Pixels by which the middle of a window must be off its pixel for light to be carried back along its slope; what stands for a window
/// that is not full; how many times as steep as further on light may be there without being taken for the edge of a shadow; and the
/// least that is left of it.
GLOAM_SHARED_CONST float kLeastShift = 0.25f;
GLOAM_SHARED_CONST float kNoShift = 1e9f;
GLOAM_SHARED_CONST float kSteepest = 3.0f;
GLOAM_SHARED_CONST float kLeastLeft = 0.65f;

GLOAM_SHARED_CONST uint kEverySet = 0xffffffffu;

/// Pixel (x, y) uses set x mod sets_x + sets_x (y mod sets_y) (RF-2). Points of one set stand together: place tile_width y' + x'
/// of set s is pixel (sets_x x' + s mod sets_x, sets_y y' + s / sets_x), tile_width tile_height points a set.
struct Interleaving {
  uint width;
  uint height;
  uint sets_x;
  uint sets_y;
  uint tile_width;
  uint tile_height;
  uint only_set;  // brute force: all pixels use this one, sets_x = sets_y = 1; else kEverySet
  float offset;   // metres, at least, at which rays leave a surface
  float bound;    // times the bound of a virtual light on a lit surface
};
GLOAM_SHARED_SIZE(Interleaving, 36)

/// What the gather is told.
struct GatherParams {
  Interleaving interleaving;
  uvec2 host_values;  // an address: four halves a pixel, layers of rows; more than one binding takes
};
GLOAM_SHARED_SIZE(GatherParams, 44)

/// Where a pixel's window ends (RF-4).
struct FilterLimits {
  uint width;
  uint height;
  float tolerance;      // distance from the tangent plane, in footprints of a pixel
  uint axis;            // two passes: 0 across, 1 down
  float normal_cosine;  // of shading normals; classical filter with its normal test
};

GLOAM_SHARED_END
#endif
