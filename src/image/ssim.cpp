// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Wang, Bovik, Sheikh, Simoncelli 2004, "Image quality assessment: from error visibility to structural similarity",
// equation 13 with K1 = 0.01, K2 = 0.03 and the Gaussian window of section III-C: 11 x 11, sigma 1.5, unit sum.
// Ours: luminance is linear and of any range, in double precision so that variances of bright pictures do not cancel;
// at the border the window is cut and what is left of it normalised, so that every pixel has a value. (The paper's own
// program crops 5 pixels all around: a mask of the inner pixels gives its number.)
#include "image/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/convolution.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

constexpr int kRadius = 5, kBandRows = 64;
constexpr double kSigma = 1.5, kK1 = 0.01, kK2 = 0.03;

using Row = std::vector<double>;
/// Window means of a, b, a^2, b^2 and ab.
enum Moment { kA, kB, kAA, kBB, kAB, kMoments };

Kernel<double> window() {
  Kernel<double> kernel;
  for (int k = 0; k <= kRadius; ++k) kernel.half.push_back(std::exp(-0.5 * k * k / (kSigma * kSigma)));
  return kernel;
}

/// Sums of the window's weights inside [0, size) about each place.
Row weightSums(const Kernel<double>& kernel, int size, int rounded) {
  Row sums(std::size_t(rounded), 1.0);
  for (int x = 0; x < size; ++x) {
    double sum = 0.0;
    for (int k = -kRadius; k <= kRadius; ++k)
      if (x + k >= 0 && x + k < size) sum += kernel.half[std::size_t(std::abs(k))];
    sums[std::size_t(x)] = sum;
  }
  return sums;
}

double luminanceAt(const Image& image, int x, int y) {
  const float* pixel = image.at(x, y);
  if (image.channels < 3) return double(pixel[0]);
  return 0.2126 * double(pixel[0]) + 0.7152 * double(pixel[1]) + 0.0722 * double(pixel[2]);
}

/// The moments of the rows of a band and kRadius rows about it, filtered along the rows; zero outside the picture.
class Band {
 public:
  Band(const Image& a, const Image& b, const Kernel<double>& kernel, int first, int last)
      : first_(first - kRadius), stride_(roundedToBlocks(a.width)) {
    const int rows = last - first + 2 * kRadius;
    for (Row& plane : planes_) plane.assign(std::size_t(rows) * std::size_t(stride_), 0.0);
    std::array<Row, kMoments> row;
    for (Row& values : row) values.assign(std::size_t(stride_ + 2 * kRadius), 0.0);
    for (int y = std::max(0, first_); y < std::min(a.height, last + kRadius); ++y) {
      for (int x = 0; x < a.width; ++x) {
        const double va = luminanceAt(a, x, y), vb = luminanceAt(b, x, y);
        const std::size_t to = std::size_t(x + kRadius);
        row[kA][to] = va, row[kB][to] = vb;
        row[kAA][to] = va * va, row[kBB][to] = vb * vb, row[kAB][to] = va * vb;
      }
      for (int m = 0; m < kMoments; ++m)
        convolveAlong<Mirror::kEven>(kernel, row[std::size_t(m)].data() + kRadius, stride_, at(m, y));
    }
  }

  double* at(int moment, int y) {
    return &planes_[std::size_t(moment)][std::size_t(y - first_) * std::size_t(stride_)];
  }
  int stride() const { return stride_; }

 private:
  int first_, stride_;
  std::array<Row, kMoments> planes_;
};

}  // namespace

Image ssimMap(const Image& a, const Image& reference, double peak, const WorkStage& stage) {
  const Kernel<double> kernel = window();
  const Row along = weightSums(kernel, a.width, roundedToBlocks(a.width));
  const Row across = weightSums(kernel, a.height, a.height);
  const double c1 = (kK1 * peak) * (kK1 * peak), c2 = (kK2 * peak) * (kK2 * peak);
  Image map(a.width, a.height, 1);
  forEachBand(a.height, kBandRows, stage, [&](int first, int last) {
    Band band(a, reference, kernel, first, last);
    std::array<Row, kMoments> m;
    for (Row& values : m) values.resize(std::size_t(band.stride()));
    for (int y = first; y < last; ++y) {
      for (int i = 0; i < kMoments; ++i)
        convolve<Mirror::kEven>(
            kernel, [&](int k) -> const double* { return band.at(i, y + k); }, band.stride(),
            m[std::size_t(i)].data());
      for (std::size_t x = 0; x < std::size_t(a.width); ++x) {
        const double scale = 1.0 / (along[x] * across[std::size_t(y)]);
        const double mean_a = m[kA][x] * scale, mean_b = m[kB][x] * scale;
        const double variance_a = std::max(0.0, m[kAA][x] * scale - mean_a * mean_a);
        const double variance_b = std::max(0.0, m[kBB][x] * scale - mean_b * mean_b);
        const double covariance = m[kAB][x] * scale - mean_a * mean_b;
        map.at(int(x), y)[0] =
            float((2.0 * mean_a * mean_b + c1) * (2.0 * covariance + c2) /
                  ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2)));
      }
    }
  });
  return map;
}

}  // namespace gloam
