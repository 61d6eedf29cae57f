// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums over coefficients, a point a lane (see prt_halves_simd.h).
#if defined(GLOAM_PRT_SUMS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOAM_PRT_SUMS_SIMD_H
#undef GLOAM_PRT_SUMS_SIMD_H
#else
#define GLOAM_PRT_SUMS_SIMD_H
#endif
#include "gpu/format.h"
#include "techniques/prt/prt_halves_simd.h"
#include "techniques/prt/prt_relight_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vectors that are summed together: three colours of each fill the registers of most instruction sets.
constexpr std::size_t kColumns = std::min<std::size_t>(4, kBlockVertices / kLanes);
constexpr std::size_t kMost = 36;

/// One instance's coefficients in the order in which words meet them.
struct Light {
  float flat[3 * kMost + 2];   // r, g, b of each; then 0
  float pairs[3 * kMost + 6];  // r, r, g, g, b, b of two each: for halves that have no colour
  std::uint32_t first = kUnbaked;
  void set(std::span<const glm::vec3> lights, std::uint32_t from, std::size_t n) {
    if (first == from) return;
    first = from;
    std::fill(std::begin(flat), std::end(flat), 0.0f);
    std::fill(std::begin(pairs), std::end(pairs), 0.0f);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        flat[3 * i + c] = lights[from + i][int(c)];
        pairs[6 * (i / 2) + 2 * c + i % 2] = flat[3 * i + c];
      }
    }
  }
};

/// Sums of a block's vertices, a colour each row.
struct Sums {
  HWY_ALIGN float of[3][kBlockVertices];
};

HWY_INLINE V bothOf(const float* pair) {
  double bits;
  std::memcpy(&bits, pair, sizeof(bits));
  return hn::BitCast(D(), hn::Set(hn::Repartition<double, D>(), bits));
}

/// Columns from `first` on of three sums.
struct Columns {
  V r[kColumns], g[kColumns], b[kColumns];
  HWY_INLINE Columns() {
    for (std::size_t k = 0; k < kColumns; ++k) r[k] = g[k] = b[k] = hn::Zero(D());
  }
};

/// Floats; colored: rows of r, g and b in turn, else one row for all three.
template <bool colored>
HWY_INLINE void addFloats(const float* values, std::size_t n, const float* light, Sums& sums) {
  const D d;
  constexpr std::size_t kStep = colored ? 3 : 1;
  for (std::size_t first = 0; first < kBlockVertices; first += kColumns * kLanes) {
    Columns sum;
    const float* row = values + first;
    for (std::size_t i = 0; i < n; ++i, row += kStep * kBlockVertices) {
      const V r = hn::Set(d, light[3 * i]), g = hn::Set(d, light[3 * i + 1]),
              b = hn::Set(d, light[3 * i + 2]);
      for (std::size_t k = 0; k < kColumns; ++k) {
        const float* at = row + k * kLanes;
        const V red = hn::LoadU(d, at);
        const V green = colored ? hn::LoadU(d, at + kBlockVertices) : red;
        const V blue = colored ? hn::LoadU(d, at + 2 * kBlockVertices) : red;
        sum.r[k] = hn::MulAdd(red, r, sum.r[k]);
        sum.g[k] = hn::MulAdd(green, g, sum.g[k]);
        sum.b[k] = hn::MulAdd(blue, b, sum.b[k]);
      }
    }
    for (std::size_t k = 0; k < kColumns; ++k) {
      hn::StoreU(sum.r[k], d, sums.of[0] + first + k * kLanes);
      hn::StoreU(sum.g[k], d, sums.of[1] + first + k * kLanes);
      hn::StoreU(sum.b[k], d, sums.of[2] + first + k * kLanes);
    }
  }
}

#if HWY_TARGET == HWY_SCALAR
/// Halves, one by one: machines without any vectors that Highway knows.
template <bool colored>
HWY_INLINE void addHalves(const std::uint32_t* words, std::size_t n, const Light& light, Sums& sums) {
  for (std::size_t v = 0; v < kBlockVertices; ++v) {
    float sum[3] = {0.0f, 0.0f, 0.0f};
    for (std::size_t j = 0; j < (colored ? 3 * n : n); ++j) {
      const std::uint32_t word = words[j / 2 * kBlockVertices + v];
      const float x = gpu::floatFromHalf(static_cast<std::uint16_t>(j % 2 == 0 ? word : word >> 16));
      for (std::size_t c = 0; c < 3; ++c)
        if (!colored || j % 3 == c) sum[c] += x * light.flat[colored ? j : 3 * j + c];
    }
    for (std::size_t c = 0; c < 3; ++c) sums.of[c][v] = sum[c];
  }
}
#else
HWY_INLINE V halves(const std::uint32_t* words) {
  const D16 d16;
  return hn::PromoteTo(D(), hn::LoadU(d16, reinterpret_cast<const hwy::float16_t*>(words)));
}

/// Halves. A vector holds both halves of kLanes / 2 vertices' words, so that columns are as many vertices narrower. Colored words
/// are r g, b r, g b in turn: three sums whose halves are different colours.
template <bool colored>
HWY_INLINE void addHalves(const std::uint32_t* words, std::size_t n, const Light& light, Sums& sums) {
  const D d;
  constexpr std::size_t kWords = kLanes / 2;  // of a vector
  const std::size_t rows = (n + 1) / 2;
  for (std::size_t first = 0; first < kBlockVertices; first += kColumns * kWords) {
    Columns sum;
    const std::uint32_t* row = words + first;
    for (std::size_t i = 0; i < rows; ++i, row += (colored ? 3 : 1) * kBlockVertices) {
      // Of an odd number the last coefficient's colours are two words: the third is not there.
      const bool whole = 2 * i + 1 < n;
      const float* pair = colored ? light.flat + 6 * i : light.pairs + 6 * i;
      const V one = bothOf(pair), two = bothOf(pair + 2);
      const V three = !colored || whole ? bothOf(pair + 4) : hn::Zero(d);
      for (std::size_t k = 0; k < kColumns; ++k) {
        const std::uint32_t* at = row + k * kWords;
        const V x = halves(at), y = colored ? halves(at + kBlockVertices) : x;
        sum.r[k] = hn::MulAdd(x, one, sum.r[k]);
        sum.g[k] = hn::MulAdd(y, two, sum.g[k]);
        if (colored && !whole) continue;
        sum.b[k] = hn::MulAdd(colored ? halves(at + 2 * kBlockVertices) : x, three, sum.b[k]);
      }
    }
    for (std::size_t k = 0; k < kColumns; k += 2) {
      const auto even = [&](const V* v) HWY_ATTR { return hn::ConcatEven(d, v[k + 1], v[k]); };
      const auto odd = [&](const V* v) HWY_ATTR { return hn::ConcatOdd(d, v[k + 1], v[k]); };
      const std::size_t to = first + k * kWords;
      if (colored) {
        hn::StoreU(hn::Add(even(sum.r), odd(sum.g)), d, sums.of[0] + to);
        hn::StoreU(hn::Add(odd(sum.r), even(sum.b)), d, sums.of[1] + to);
        hn::StoreU(hn::Add(even(sum.g), odd(sum.b)), d, sums.of[2] + to);
      } else {
        hn::StoreU(hn::Add(even(sum.r), odd(sum.r)), d, sums.of[0] + to);
        hn::StoreU(hn::Add(even(sum.g), odd(sum.g)), d, sums.of[1] + to);
        hn::StoreU(hn::Add(even(sum.b), odd(sum.b)), d, sums.of[2] + to);
      }
    }
  }
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#endif
