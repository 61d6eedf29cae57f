// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One-dimensional filters over rows of numbers, in blocks that stay in registers.
#pragma once

#include <cstddef>
#include <vector>

namespace gloam {

/// A filter that mirrors about its middle: half[0] there, half[k] at +k and, even, at -k too; odd, -half[k] at -k.
template <class Number>
struct Kernel {
  std::vector<Number> half;
  int radius() const { return int(half.size()) - 1; }
};

inline constexpr int kBlock = 16;
/// Rows are as long as whole blocks.
inline int roundedToBlocks(int width) {
  return (width + kBlock - 1) / kBlock * kBlock;
}

enum class Mirror { kEven, kOdd };

/// out[x] = sum over k of kernel(k) * rows[k][x], or += where kAdd, for x in [0, count), whole blocks. rows[k] is asked
/// for k from -radius to radius: rows of a picture, or one row that is shifted.
template <Mirror kMirror, bool kAdd = false, class Number, class Rows>
void convolve(const Kernel<Number>& kernel, const Rows& rows, int count, Number* out) {
  const int radius = kernel.radius();
  for (int x = 0; x < count; x += kBlock) {
    Number sum[kBlock];
    const Number* middle = rows(0) + x;
    for (int i = 0; i < kBlock; ++i) sum[i] = kernel.half[0] * middle[i];
    for (int k = 1; k <= radius; ++k) {
      const Number weight = kernel.half[std::size_t(k)];
      const Number *after = rows(k) + x, *before = rows(-k) + x;
      for (int i = 0; i < kBlock; ++i)
        sum[i] += weight * (kMirror == Mirror::kEven ? after[i] + before[i] : after[i] - before[i]);
    }
    for (int i = 0; i < kBlock; ++i) out[x + i] = kAdd ? out[x + i] + sum[i] : sum[i];
  }
}

/// A row, its filtered row: `row` may be read from -radius to count + radius.
template <Mirror kMirror, class Number>
void convolveAlong(const Kernel<Number>& kernel, const Number* row, int count, Number* out) {
  convolve<kMirror>(
      kernel, [row](int k) { return row + k; }, count, out);
}

}  // namespace gloam
