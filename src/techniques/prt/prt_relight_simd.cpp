// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// E_p = M_p . L' of Sloan, Kautz, Snyder 2002, a vertex a lane. A block is read once, from its first byte to its last; sums of
// 16 or more vertices stay in registers meanwhile. Halves are widened in pairs as they stand in their words, each of a pair
// times its own coefficient, and pairs are added at the end.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_relight_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "gpu/format.h"
#include "techniques/prt/prt_relight_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kBlockVertices / 2>;
using D16 = hn::Rebind<hwy::float16_t, D>;
using V = hn::Vec<D>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
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

template <bool colored>
HWY_INLINE void add(const ChunkInMemory& chunk, std::uint32_t block, const Light& light, Sums& sums) {
  const auto n = static_cast<std::size_t>(chunk.coefficients);
  const std::size_t values = colored ? 3 * n : n;
  const std::uint32_t* words = (colored ? chunk.indirect : chunk.direct) +
                               block * (chunk.half_float ? (values + 1) / 2 : values) * kBlockVertices;
  if (chunk.half_float)
    addHalves<colored>(words, n, light, sums);
  else
    addFloats<colored>(reinterpret_cast<const float*>(words), n, light.flat, sums);
}

/// `both`: what is there already is held to 0 or more and added to, held alike (bothParts of prt_ringing.glsl).
HWY_INLINE void put(const Sums& direct, const Sums& indirect, bool has_indirect, bool both,
                    std::span<VertexLight> to) {
  for (std::size_t v = 0; v < to.size(); ++v) {
    const glm::vec3 d(direct.of[0][v], direct.of[1][v], direct.of[2][v]);
    glm::vec3 i(0.0f);
    if (has_indirect) i = {indirect.of[0][v], indirect.of[1][v], indirect.of[2][v]};
    if (both)
      to[v] = {glm::max(to[v].direct, glm::vec3(0.0f)) + glm::max(d, glm::vec3(0.0f)),
               glm::max(to[v].indirect, glm::vec3(0.0f)) + glm::max(i, glm::vec3(0.0f))};
    else
      to[v] = {d, i};
  }
}

void relightBlocks(const ChunkInMemory& chunk, std::size_t begin, std::size_t end,
                   std::span<const glm::vec3> lights, std::uint32_t first_peak, bool in_parts,
                   std::span<VertexLight> vertex_light) {
  const auto n = static_cast<std::size_t>(chunk.coefficients);
  const bool has_indirect = chunk.indirect != nullptr;
  Light light, peak;
  Sums direct, indirect;
  for (std::size_t at = begin; at < end; ++at) {
    const VertexBlock& block = chunk.blocks[at];
    const std::span<VertexLight> to = vertex_light.subspan(block.output_, block.count);
    light.set(lights, block.light, n);
    add<false>(chunk, block.transfer, light, direct);
    if (has_indirect) add<true>(chunk, block.transfer, light, indirect);
    put(direct, indirect, has_indirect, false, to);
    if (!in_parts) continue;
    peak.set(lights, first_peak + block.light, n);
    add<false>(chunk, block.transfer, peak, direct);
    if (has_indirect) add<true>(chunk, block.transfer, peak, indirect);
    put(direct, indirect, has_indirect, true, to);
  }
}

/// Points that are multiplied together: as many as a block has vertices.
constexpr std::size_t kTile = kBlockVertices;
constexpr std::size_t kMostBands = 121, kMostRowWords = 3 * kMost / 2;

/// Rows of `points` numbers each: a tile's of them, side by side. What lies beyond the last point is 0.
template <class T>
HWY_INLINE void fetch(const T* from, std::size_t stride, std::size_t rows, std::size_t count, T* to) {
  for (std::size_t row = 0; row < rows; ++row, from += stride, to += kTile) {
    std::memcpy(to, from, count * sizeof(T));
    if (count < kTile) std::fill(to + count, to + kTile, T(0));
  }
}

/// Pairs of rows of sums as halves, a word each point.
HWY_INLINE void putHalves(const float* low, const float* high, std::size_t count, std::size_t stride,
                          std::uint32_t* to) {
  const D d;
  const D16 d16;
  HWY_ALIGN hwy::float16_t halves[2][kTile];
  for (std::size_t v = 0; v < kTile; v += kLanes) {
    hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, low + v)), d16, halves[0] + v);
    hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, high + v)), d16, halves[1] + v);
  }
  std::uint16_t bits[2][kTile];
  std::memcpy(bits, halves, sizeof(bits));
  for (std::size_t v = 0; v < count; ++v) to[v * stride] = bits[0][v] | std::uint32_t(bits[1][v]) << 16;
}

void multiplyTiles(const GridInMemory& grid, std::size_t begin, std::size_t end,
                   std::span<const glm::vec3> lights, std::uint32_t* fields) {
  const auto columns = std::size_t(grid.light_order * grid.light_order);
  const auto rows = std::size_t(grid.field_order * grid.field_order);
  const auto bands = std::size_t(grid.light_order + grid.field_order - 1);
  const std::size_t kept = bands * bands, row_words = (columns + 1) / 2 * 3;
  const std::size_t words = grid.thrown ? 3 : 2, stride = rows * words;
  static const float none[kTile] = {};
  HWY_ALIGN float visibility[kMostBands * kTile];
  HWY_ALIGN std::uint32_t thrown[kMostRowWords * kTile];
  Light light;
  light.set(lights, 0, columns);
  Sums direct, indirect;
  for (std::size_t tile = begin; tile < end; ++tile) {
    const std::size_t point = tile * kTile, count = std::min(kTile, grid.points - point);
    fetch(grid.visibility + point, grid.points, kept, count, visibility);
    for (std::size_t row = 0; row < grid.row_count; ++row) {
      const std::size_t i = grid.first_row + row;
      addFloats<false>(visibility, kept, &lights[columns + i * kept].x, direct);
      std::uint32_t* to = fields + point * stride + i * words;
      putHalves(direct.of[0], direct.of[1], count, stride, to);
      if (!grid.thrown) {
        putHalves(direct.of[2], none, count, stride, to + 1);
        continue;
      }
      fetch(grid.thrown + row * row_words * grid.points + point, grid.points, row_words, count, thrown);
      addHalves<true>(thrown, columns, light, indirect);
      putHalves(direct.of[2], indirect.of[0], count, stride, to + 1);
      putHalves(indirect.of[1], indirect.of[2], count, stride, to + 2);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(relightBlocks);
HWY_EXPORT(multiplyTiles);

void relight(const ChunkInMemory& chunk, std::span<const glm::vec3> lights, std::uint32_t first_peak,
             bool in_parts, std::span<VertexLight> vertex_light) {
  constexpr std::size_t kTogether = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk.blocks.size(), kTogether),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(relightBlocks)
                      (chunk, range.begin(), range.end(), lights, first_peak, in_parts, vertex_light);
                    });
}

void multiplyGrid(const GridInMemory& grid, std::span<const glm::vec3> lights, std::uint32_t* fields) {
  const std::size_t tiles = (grid.points + kBlockVertices - 1) / kBlockVertices;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles, 4),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(multiplyTiles)(grid, range.begin(), range.end(), lights, fields);
                    });
}

}  // namespace gloam::prt
#endif
