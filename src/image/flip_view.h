// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One picture as the eye of FLIP has it: blurred as far as the eye is, in a colour space where distances are seen
// distances, with its edges and points.
#pragma once

#include <gloam/image.h>

#include <array>
#include <vector>

#include "image/flip_filters.h"

namespace gloam {

/// How a picture's numbers become light of a display before it is looked at.
struct FlipLight {
  bool film = false;  ///< the film curve of HDR-FLIP at this factor; otherwise clamped to 0 to 1
  float factor = 1.0f;
};

/// What is seen in a row of pixels.
struct FlipRow {
  explicit FlipRow(int width);
  std::vector<float> lightness, hunt_a, hunt_b;  ///< L*a*b* with the Hunt effect
  std::vector<float> edge, point;                ///< how strong, at least 0
};

/// The rows [first, last) of a picture, made ready for row().
class FlipView {
 public:
  FlipView(const Image& image, const FlipFilters& filters, int first, int last);
  /// Filters along the rows of the band and as many about it as the filters reach.
  void look(const FlipLight& light);
  /// Filters across them: what is seen in row y.
  void row(int y, FlipRow& seen);

 private:
  /// Rows filtered along themselves.
  enum Plane { kAchromatic, kRedGreen, kSharp, kSoft, kGaussian, kSlope, kCurvature, kPlanes };
  float* at(int plane, int y);
  void load(int y, const FlipLight& light);
  void extendBorders();
  void colors(FlipRow& seen);

  const Image& image_;
  const FlipFilters& filters_;
  int first_, last_, stride_;
  std::array<std::vector<float>, kPlanes> planes_;
  /// A row with the filters' radius at both sides: Y, X - Y and Y - Z, fractions of white.
  std::array<std::vector<float>, 3> opponents_;
  /// A row filtered both ways: the opponents, or slopes and curvatures along x and y.
  std::array<std::vector<float>, 3> blurred_;
  std::array<std::vector<float>, 2> feature_;
};

}  // namespace gloam
