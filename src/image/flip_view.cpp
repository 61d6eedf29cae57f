// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Andersson et al. 2020, section 4.1: opponent space YyCxCz, contrast sensitivity, clamping to the colours of a display,
// L*a*b* with Hunt's adjustment (colours count less in the dark); section 4.2: feature detection on Yy.
// Ours: YyCxCz is Y, X - Y and Y - Z as fractions of white, up to factors and an offset that filters of unit sum hand
// through; those are left out on both sides.
#include "image/flip_view.h"

#include <algorithm>
#include <cmath>

#include "image/cie_lab.h"
#include "image/flip.h"

namespace gloam {
namespace {

float clamped(float value, float greatest) {
  const float positive = value > 0.0f ? value : 0.0f;
  return positive < greatest ? positive : greatest;
}

// Beyond 1e6 the film curve is flat, and its squares would overflow.
void show(const FlipLight& light, float* values, int count) {
  if (!light.film) {
    for (int i = 0; i < count; ++i) values[i] = clamped(values[i], 1.0f);
    return;
  }
  for (int i = 0; i < count; ++i) values[i] = flipToneCurve(clamped(values[i] * light.factor, 1e6f));
}

}  // namespace

FlipRow::FlipRow(int width) {
  for (std::vector<float>* values : {&lightness, &hunt_a, &hunt_b, &edge, &point})
    values->resize(std::size_t(roundedToBlocks(width)));
}

FlipView::FlipView(const Image& image, const FlipFilters& filters, int first, int last)
    : image_(image),
      filters_(filters),
      first_(first - filters.radius),
      last_(last + filters.radius),
      stride_(roundedToBlocks(image.width)) {
  for (auto& plane : planes_) plane.resize(std::size_t(last_ - first_) * std::size_t(stride_));
  for (auto& values : opponents_) values.resize(std::size_t(stride_ + 2 * filters.radius));
  for (auto& values : blurred_) values.resize(std::size_t(stride_));
  for (auto& values : feature_) values.resize(std::size_t(stride_));
}

float* FlipView::at(int plane, int y) {
  return &planes_[std::size_t(plane)][std::size_t(y - first_) * std::size_t(stride_)];
}

void FlipView::load(int y, const FlipLight& light) {
  static const ColorMatrix kXyz = relativeXyzFromRec709();
  const ColorMatrix xyz = kXyz;
  const int width = image_.width, channels = image_.channels;
  const float* pixels = image_.at(0, std::clamp(y, 0, image_.height - 1));
  float* planes[3];
  for (std::size_t c = 0; c < 3; ++c) planes[c] = opponents_[c].data() + filters_.radius;
  for (int c = 0; c < 3; ++c) {
    const float* channel = pixels + (channels >= 3 ? c : 0);
    for (int x = 0; x < width; ++x) planes[c][x] = channel[x * channels];
    show(light, planes[c], width);
  }
  for (int x = 0; x < width; ++x) {
    const float r = planes[0][x], g = planes[1][x], b = planes[2][x];
    const float fx = xyz.m[0][0] * r + xyz.m[0][1] * g + xyz.m[0][2] * b;
    const float fy = xyz.m[1][0] * r + xyz.m[1][1] * g + xyz.m[1][2] * b;
    const float fz = xyz.m[2][0] * r + xyz.m[2][1] * g + xyz.m[2][2] * b;
    planes[0][x] = fy, planes[1][x] = fx - fy, planes[2][x] = fy - fz;
  }
  extendBorders();
}

// Beyond its border a picture goes on as at its border.
void FlipView::extendBorders() {
  for (auto& values : opponents_) {
    const auto begin = values.begin() + filters_.radius, end = begin + image_.width;
    std::fill(values.begin(), begin, *begin);
    std::fill(end, values.end(), *(end - 1));
  }
}

void FlipView::look(const FlipLight& light) {
  for (int y = first_; y < last_; ++y) {
    load(y, light);
    const float* luminance = opponents_[0].data() + filters_.radius;
    const float* red_green = opponents_[1].data() + filters_.radius;
    const float* blue_yellow = opponents_[2].data() + filters_.radius;
    convolveAlong<Mirror::kEven>(filters_.achromatic, luminance, stride_, at(kAchromatic, y));
    convolveAlong<Mirror::kEven>(filters_.red_green, red_green, stride_, at(kRedGreen, y));
    convolveAlong<Mirror::kEven>(filters_.blue_yellow_sharp, blue_yellow, stride_, at(kSharp, y));
    convolveAlong<Mirror::kEven>(filters_.blue_yellow_soft, blue_yellow, stride_, at(kSoft, y));
    convolveAlong<Mirror::kEven>(filters_.gaussian, luminance, stride_, at(kGaussian, y));
    convolveAlong<Mirror::kOdd>(filters_.slope, luminance, stride_, at(kSlope, y));
    convolveAlong<Mirror::kEven>(filters_.curvature, luminance, stride_, at(kCurvature, y));
  }
}

void FlipView::row(int y, FlipRow& seen) {
  const auto rows = [&](Plane plane) {
    return [this, plane, y](int k) -> const float* { return at(plane, y + k); };
  };
  convolve<Mirror::kEven>(filters_.achromatic, rows(kAchromatic), stride_, blurred_[0].data());
  convolve<Mirror::kEven>(filters_.red_green, rows(kRedGreen), stride_, blurred_[1].data());
  convolve<Mirror::kEven>(filters_.blue_yellow_sharp, rows(kSharp), stride_, blurred_[2].data());
  convolve<Mirror::kEven, true>(filters_.blue_yellow_soft, rows(kSoft), stride_, blurred_[2].data());
  colors(seen);

  const auto strength = [this](std::vector<float>& out) {
    const float *along = feature_[0].data(), *across = feature_[1].data();
    float* values = out.data();
    for (int x = 0; x < stride_; ++x) values[x] = std::sqrt(along[x] * along[x] + across[x] * across[x]);
  };
  convolve<Mirror::kEven>(filters_.gaussian, rows(kSlope), stride_, feature_[0].data());
  convolve<Mirror::kOdd>(filters_.slope, rows(kGaussian), stride_, feature_[1].data());
  strength(seen.edge);
  convolve<Mirror::kEven>(filters_.gaussian, rows(kCurvature), stride_, feature_[0].data());
  convolve<Mirror::kEven>(filters_.curvature, rows(kGaussian), stride_, feature_[1].data());
  strength(seen.point);
}

void FlipView::colors(FlipRow& seen) {
  static const ColorMatrix kXyz = relativeXyzFromRec709(), kRgb = relativeXyzFromRec709(true);
  const ColorMatrix xyz = kXyz, rgb = kRgb;
  const float *luminance = blurred_[0].data(), *red_green = blurred_[1].data(), *yellow = blurred_[2].data();
  float *lightness = seen.lightness.data(), *hunt_a = seen.hunt_a.data(), *hunt_b = seen.hunt_b.data();
  for (int begin = 0; begin < stride_; begin += kBlock) {
    float fraction[3 * kBlock], curve[3 * kBlock];  // X, Y and Z of a block
    for (int i = 0; i < kBlock; ++i) {
      const float sy = luminance[begin + i], sx = sy + red_green[begin + i], sz = sy - yellow[begin + i];
      const float r = clamped(rgb.m[0][0] * sx + rgb.m[0][1] * sy + rgb.m[0][2] * sz, 1.0f);
      const float g = clamped(rgb.m[1][0] * sx + rgb.m[1][1] * sy + rgb.m[1][2] * sz, 1.0f);
      const float b = clamped(rgb.m[2][0] * sx + rgb.m[2][1] * sy + rgb.m[2][2] * sz, 1.0f);
      fraction[i] = xyz.m[0][0] * r + xyz.m[0][1] * g + xyz.m[0][2] * b;
      fraction[kBlock + i] = xyz.m[1][0] * r + xyz.m[1][1] * g + xyz.m[1][2] * b;
      fraction[2 * kBlock + i] = xyz.m[2][0] * r + xyz.m[2][1] * g + xyz.m[2][2] * b;
    }
    for (int i = 0; i < 3 * kBlock; ++i) curve[i] = labCurve(fraction[i]);
    for (int i = 0; i < kBlock; ++i) {
      const float light = 116.0f * curve[kBlock + i] - 16.0f;
      lightness[begin + i] = light;
      hunt_a[begin + i] = 0.01f * light * 500.0f * (curve[i] - curve[kBlock + i]);
      hunt_b[begin + i] = 0.01f * light * 200.0f * (curve[kBlock + i] - curve[2 * kBlock + i]);
    }
  }
}

}  // namespace gloam
