// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Andersson et al. 2020: colour difference (section 4.1.3, HyAB of Abasi, Amani Tehran, Fairchild 2019, and its
// redistribution over 0 to 1 with q_c = 0.7, p_c = 0.4, p_t = 0.95), feature difference (section 4.2, q_f = 1/2: a square root), and
// both together (section 4.3): dE = dE_c^(1 - dE_f). Andersson et al. 2021: the greatest over exposures.
#include "image/flip.h"

#include <gloam/metrics.h>

#include <algorithm>
#include <cmath>

#include "image/cie_lab.h"
#include "image/comparison.h"
#include "image/flip_view.h"

namespace gloam {
namespace {

constexpr int kBandRows = 64;
constexpr float kColorPower = 0.7f, kKneePart = 0.4f, kKneeValue = 0.95f;

float hyab(float lightness, float a, float b) {
  return std::abs(lightness) + std::sqrt(a * a + b * b);
}

/// The greatest difference that colours of a display have: green against blue.
float greatestColorDifference() {
  const ColorMatrix xyz = relativeXyzFromRec709();
  float hunt[2][3];
  for (int i = 0; i < 2; ++i) {
    const int primary = i + 1;
    const float fx = labCurve(xyz.m[0][primary]), fy = labCurve(xyz.m[1][primary]),
                fz = labCurve(xyz.m[2][primary]);
    hunt[i][0] = 116.0f * fy - 16.0f;
    hunt[i][1] = 0.01f * hunt[i][0] * 500.0f * (fx - fy);
    hunt[i][2] = 0.01f * hunt[i][0] * 200.0f * (fy - fz);
  }
  return std::pow(hyab(hunt[0][0] - hunt[1][0], hunt[0][1] - hunt[1][1], hunt[0][2] - hunt[1][2]),
                  kColorPower);
}

/// Large differences are as bad as one another: the upper part of the range shares what the lower leaves of 1.
float redistributed(float difference, float greatest) {
  const float power = std::pow(difference, kColorPower), knee = kKneePart * greatest;
  if (power < knee) return kKneeValue / knee * power;
  return std::min(1.0f, kKneeValue + (power - knee) / (greatest - knee) * (1.0f - kKneeValue));
}

float featureDifference(float edge, float point) {
  const float greater = std::max(std::abs(edge), std::abs(point));
  return std::min(1.0f, std::sqrt(greater * 0.70710678f));
}

/// Raises `map` to what is seen between two rows.
void compareRows(const FlipRow& a, const FlipRow& b, float greatest, int width, float* map) {
  for (std::size_t x = 0; x < std::size_t(width); ++x) {
    const float color =
        hyab(a.lightness[x] - b.lightness[x], a.hunt_a[x] - b.hunt_a[x], a.hunt_b[x] - b.hunt_b[x]);
    if (color == 0.0f) continue;
    const float feature = featureDifference(a.edge[x] - b.edge[x], a.point[x] - b.point[x]);
    map[x] = std::max(map[x], std::pow(redistributed(color, greatest), 1.0f - feature));
  }
}

Image greatestOver(const Image& a, const Image& reference, const std::vector<FlipLight>& lights,
                   double pixels_per_degree, const WorkStage& stage) {
  const FlipFilters filters = flipFilters(pixels_per_degree);
  const float greatest = greatestColorDifference();
  Image map(a.width, a.height, 1);
  forEachBand(a.height, kBandRows, stage, [&](int first, int last) {
    FlipView view_a(a, filters, first, last), view_b(reference, filters, first, last);
    FlipRow seen_a(a.width), seen_b(a.width);
    for (const FlipLight& light : lights) {
      view_a.look(light);
      view_b.look(light);
      for (int y = first; y < last; ++y) {
        view_a.row(y, seen_a);
        view_b.row(y, seen_b);
        compareRows(seen_a, seen_b, greatest, a.width, map.at(0, y));
      }
    }
  });
  return map;
}

}  // namespace

Image ldrFlip(const Image& a, const Image& reference, double pixels_per_degree, const WorkStage& stage) {
  return greatestOver(a, reference, {FlipLight{}}, pixels_per_degree, stage);
}

Image hdrFlip(const Image& a, const Image& reference, double pixels_per_degree, const WorkStage& stage) {
  const FlipExposures exposures = flipExposures(reference);
  std::vector<FlipLight> lights;
  for (int i = 0; i < exposures.count; ++i) lights.push_back({true, float(std::exp2(exposures.at(i)))});
  return greatestOver(a, reference, lights, pixels_per_degree, stage);
}

Image flipMap(const Image& a, const Image& reference, double pixels_per_degree, const Progress& progress) {
  requireComparable(a, reference);
  requirePixelsPerDegree(pixels_per_degree);
  return hdrFlip(a, reference, pixels_per_degree, {progress, 0.0, 1.0, "HDR-FLIP"});
}

Image ldrFlipMap(const Image& a_display, const Image& reference_display, double pixels_per_degree,
                 const Progress& progress) {
  requireComparable(a_display, reference_display);
  requirePixelsPerDegree(pixels_per_degree);
  return ldrFlip(a_display, reference_display, pixels_per_degree, {progress, 0.0, 1.0, "LDR-FLIP"});
}

}  // namespace gloam
