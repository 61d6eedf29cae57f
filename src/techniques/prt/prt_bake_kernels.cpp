// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 5: shadow rays and the SH projection of what they find (PRT-1, PRT-3).
#include "techniques/prt/prt_bake_kernels.h"

#include <cstring>
#include <memory>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_bake_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Code below is compiled once an instruction set. It calls no inline function of the standard library and of other headers
// beyond Highway's: the linker keeps one copy of each, which might then be one that an older machine cannot run.
HWY_BEFORE_NAMESPACE();
namespace gloam::prt::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kTileSize>;
using Vector = hn::Vec<Floats>;

// Bits of a mask, lane 0 lowest.
HWY_INLINE std::uint32_t bitsOf(Floats d, hn::Mask<Floats> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((1u << hn::Lanes(d)) - 1u);
}

struct Normal {
  Vector x, y, z;
  HWY_INLINE Normal(Floats d, const float* n, std::size_t stride = 1)
      : x(hn::Set(d, n[0])), y(hn::Set(d, n[stride])), z(hn::Set(d, n[2 * stride])) {}
  HWY_INLINE Vector dot(Vector dx, Vector dy, Vector dz) const {
    return hn::MulAdd(z, dz, hn::MulAdd(y, dy, hn::Mul(x, dx)));
  }
  // Cosines of the directions that stand at s, s + 16, s + 32 (x, y, z).
  HWY_INLINE Vector cosines(Floats d, const float* s) const {
    return dot(hn::Load(d, s), hn::Load(d, s + kTileSize), hn::Load(d, s + 2 * kTileSize));
  }
};

// Calls visit(tile) for every tile with a part above the horizon: its axis is at most its half-angle below.
template <class Visit>
HWY_INLINE void forTilesAbove(const TableView& tables, const Normal& n, const Visit& visit) {
  const Floats d;
  const std::size_t stride = tables.cone_stride;
  for (std::size_t t = 0; t < tables.tiles; t += hn::Lanes(d)) {
    const float* cone = tables.cones + t;
    const Vector height =
        n.dot(hn::Load(d, cone), hn::Load(d, cone + stride), hn::Load(d, cone + 2 * stride));
    std::uint32_t above = bitsOf(d, hn::Gt(hn::Add(height, hn::Load(d, cone + 3 * stride)), hn::Zero(d)));
    for (; above != 0; above &= above - 1) {
      const std::size_t tile = t + hwy::Num0BitsBelowLS1Bit_Nonzero32(above);
      if (tile < tables.tiles) visit(tile);
    }
  }
}

// blocked is zero before; packet has its origin.
std::size_t TraceBlocked(const trace::Tracer& tracer, const TableView& tables, const float* normal,
                         const float* turn, trace::RayPacket& packet, std::uint16_t* blocked) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d);
  const Normal n(d, normal);
  const Vector infinite = hn::Set(d, __builtin_inff());
  // Rows of the rotation, whose columns stand one after the other.
  const Normal to_x(d, turn, 3), to_y(d, turn + 1, 3), to_z(d, turn + 2, 3);
  trace::LaneMask mask;
  std::size_t rays = 0;
  forTilesAbove(tables, n, [&](std::size_t tile) HWY_ATTR {
    const float* s = tables.directions + tile * 3 * kTileSize;
    std::uint32_t above = 0;
    for (std::size_t k = 0; k < kTileSize; k += lanes) {
      const Vector x = hn::Load(d, s + k);
      const Vector y = hn::Load(d, s + kTileSize + k);
      const Vector z = hn::Load(d, s + 2 * kTileSize + k);
      const auto is_above = hn::Gt(n.dot(x, y, z), hn::Zero(d));
      hn::Store(to_x.dot(x, y, z), d, packet.direction_x + k);
      hn::Store(to_y.dot(x, y, z), d, packet.direction_y + k);
      hn::Store(to_z.dot(x, y, z), d, packet.direction_z + k);
      hn::Store(infinite, d, packet.t_far + k);
      hn::Store(hn::BitCast(di, hn::VecFromMask(d, is_above)), di, mask.lane + k);
      above |= bitsOf(d, is_above) << k;
    }
    if (above == 0) return;
    rays += hwy::PopCount(above);
    tracer.occluded(packet, mask, true);
    std::uint32_t found = 0;
    for (std::size_t k = 0; k < kTileSize; k += lanes) {
      found |= bitsOf(d, hn::Lt(hn::Load(d, packet.t_far + k), hn::Zero(d))) << k;
    }
    blocked[tile] = static_cast<std::uint16_t>(found & above);
  });
  return rays;
}

std::size_t TilesAbove(const TableView& tables, const float* normal, std::int32_t* tiles,
                       std::uint16_t* above) {
  const Floats d;
  const Normal n(d, normal);
  std::size_t count = 0;
  forTilesAbove(tables, n, [&](std::size_t tile) HWY_ATTR {
    const float* s = tables.directions + tile * 3 * kTileSize;
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kTileSize; k += hn::Lanes(d)) {
      bits |= bitsOf(d, hn::Gt(n.cosines(d, s + k), hn::Zero(d))) << k;
    }
    if (bits == 0) return;
    tiles[count] = static_cast<std::int32_t>(tile);
    above[count++] = static_cast<std::uint16_t>(bits);
  });
  return count;
}

// max(0, n.s) of the blocked directions of a tile, 0 for the others.
void BlockedCosines(const TableView& tables, const float* normal, const std::uint16_t* blocked,
                    const std::int32_t* active, std::size_t active_count, std::size_t weight_stride,
                    float* weights) {
  const Floats d;
  const Normal n(d, normal);
  for (std::size_t a = 0; a < active_count; ++a) {
    const std::size_t tile = static_cast<std::size_t>(active[a]);
    const float* s = tables.directions + tile * 3 * kTileSize;
    float* w = weights + a * weight_stride;
    const std::uint32_t bits = blocked[tile];
    for (std::size_t k = 0; k < kTileSize; k += hn::Lanes(d)) {
      const std::uint32_t here = bits >> k;
      std::uint8_t bytes[8] = {};
      std::memcpy(bytes, &here, sizeof here);
      const auto is_blocked = hn::LoadMaskBits(d, bytes);
      hn::Store(hn::IfThenElseZero(is_blocked, hn::Max(n.cosines(d, s + k), hn::Zero(d))), d, w + k);
    }
  }
}

// The products of kCount basis functions with the weights of four points, summed over all active tiles.
template <int kCount>
HWY_INLINE void accumulate(const TableView& tables, const std::int32_t* active, std::size_t active_count,
                           const float* weights, std::size_t first, float* const sums[kProjectedTogether]) {
  const Floats d;
  Vector acc[kProjectedTogether][kCount];
  for (int p = 0; p < kProjectedTogether; ++p) {
    for (int i = 0; i < kCount; ++i) acc[p][i] = hn::Zero(d);
  }
  for (std::size_t a = 0; a < active_count; ++a) {
    const std::size_t tile = static_cast<std::size_t>(active[a]);
    const float* basis = tables.basis + (tile * tables.coefficients + first) * kTileSize;
    const float* w = weights + a * kProjectedTogether * kTileSize;
    for (std::size_t k = 0; k < kTileSize; k += hn::Lanes(d)) {
      Vector y[kCount];
      for (int i = 0; i < kCount; ++i) y[i] = hn::Load(d, basis + i * kTileSize + k);
      for (int p = 0; p < kProjectedTogether; ++p) {
        const Vector weight = hn::Load(d, w + p * kTileSize + k);
        for (int i = 0; i < kCount; ++i) acc[p][i] = hn::MulAdd(weight, y[i], acc[p][i]);
      }
    }
  }
  alignas(64) float lane[kTileSize];
  for (int p = 0; p < kProjectedTogether; ++p) {
    for (int i = 0; i < kCount; ++i) {
      hn::Store(acc[p][i], d, lane);
      double sum = 0.0;
      for (std::size_t k = 0; k < hn::Lanes(d); ++k) sum += static_cast<double>(lane[k]);
      sums[p][first + static_cast<std::size_t>(i)] = static_cast<float>(sum);
    }
  }
}

void Accumulate(const TableView& tables, const std::int32_t* active, std::size_t active_count,
                const float* weights, float* const sums[kProjectedTogether]) {
  std::size_t i = 0;
  for (; i + 3 <= tables.coefficients; i += 3) accumulate<3>(tables, active, active_count, weights, i, sums);
  for (; i < tables.coefficients; ++i) accumulate<1>(tables, active, active_count, weights, i, sums);
}

// One hit: the mean of three rows, in registers.
struct Corners {
  const float* row[3];
  float share[3];
};

HWY_INLINE Corners cornersOf(const GatheredHit& hit, const float* rows, std::size_t stride) {
  const float u = static_cast<float>(hit.share[0]) * (1.0f / kHitSteps),
              v = static_cast<float>(hit.share[1]) * (1.0f / kHitSteps);
  return {{rows + hit.point[0] * stride, rows + hit.point[1] * stride, rows + hit.point[2] * stride},
          {1.0f - u - v, u, v}};
}

HWY_INLINE Vector mixAt(Floats d, const Corners& c, std::size_t at) {
  Vector mix = hn::Mul(hn::Set(d, c.share[0]), hn::LoadU(d, c.row[0] + at));
  mix = hn::MulAdd(hn::Set(d, c.share[1]), hn::LoadU(d, c.row[1] + at), mix);
  return hn::MulAdd(hn::Set(d, c.share[2]), hn::LoadU(d, c.row[2] + at), mix);
}

// sum: [color][sum_stride], zero before, whole vectors. What lies beyond the coefficients is not read by the caller.
void GatherHits(const GatherSources& sources, std::size_t coefficients, std::size_t stride,
                const GatheredHit* hits, std::size_t hit_count, float* sum, std::size_t sum_stride) {
  const Floats d;
  constexpr std::size_t kAhead = 4;
  for (std::size_t h = 0; h < hit_count; ++h) {
    if (h + kAhead < hit_count) {
      const GatheredHit& next = hits[h + kAhead];
      const GatherSource& source = sources.by_mirrors[next.mirrors];
      const std::size_t row = source.grey ? coefficients : 3 * stride;
      if (source.rows != nullptr) {
        for (std::size_t at = 0; at < row; at += 16) {
          for (std::size_t k = 0; k < 3; ++k) __builtin_prefetch(source.rows + next.point[k] * row + at);
        }
      }
    }
    const GatheredHit& hit = hits[h];
    const GatherSource& source = sources.by_mirrors[hit.mirrors];
    if (source.rows == nullptr) continue;
    const Corners c = cornersOf(hit, source.rows, source.grey ? coefficients : 3 * stride);
    const Vector red = hn::Set(d, static_cast<float>(hit.weight[0])),
                 green = hn::Set(d, static_cast<float>(hit.weight[1])),
                 blue = hn::Set(d, static_cast<float>(hit.weight[2]));
    const std::size_t green_at = source.grey ? 0 : stride, blue_at = 2 * green_at;
    for (std::size_t i = 0; i < coefficients; i += hn::Lanes(d)) {
      float* r = sum + i;
      float* g = r + sum_stride;
      float* b = g + sum_stride;
      const Vector mix = mixAt(d, c, i);
      hn::Store(hn::MulAdd(red, mix, hn::Load(d, r)), d, r);
      hn::Store(hn::MulAdd(green, source.grey ? mix : mixAt(d, c, green_at + i), hn::Load(d, g)), d, g);
      hn::Store(hn::MulAdd(blue, source.grey ? mix : mixAt(d, c, blue_at + i), hn::Load(d, b)), d, b);
    }
  }
}

const char* KernelTarget() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace gloam::prt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(TraceBlocked);
HWY_EXPORT(TilesAbove);
HWY_EXPORT(BlockedCosines);
HWY_EXPORT(Accumulate);
HWY_EXPORT(GatherHits);
HWY_EXPORT(KernelTarget);

std::size_t traceBlocked(const trace::Tracer& tracer, const DirectionTables& tables,
                         const DirectionBatch& batch, const glm::vec3& origin, const glm::vec3& normal,
                         const glm::mat3& turn, std::uint16_t* blocked) {
  trace::RayPacket packet;
  packet.setOrigin(origin);
  blocked += batch.first;
  std::memset(blocked, 0, std::size_t(batch.end - batch.first) * sizeof *blocked);
  return HWY_DYNAMIC_DISPATCH(TraceBlocked)(tracer, tables.view(batch), &normal.x, &turn[0].x, packet,
                                            blocked);
}

int tilesAbove(const DirectionTables& tables, const glm::vec3& normal, std::int32_t* tiles,
               std::uint16_t* above) {
  return int(HWY_DYNAMIC_DISPATCH(TilesAbove)(tables.view(tables.batches[0]), &normal.x, tiles, above));
}

void projectBlocked(const DirectionTables& tables, const DirectionBatch& batch,
                    const glm::vec3 normals[kProjectedTogether],
                    const std::uint16_t* const blocked[kProjectedTogether],
                    float* const sums[kProjectedTogether]) {
  thread_local std::vector<std::int32_t> active;
  thread_local hwy::AlignedFreeUniquePtr<float[]> weights;
  thread_local std::size_t capacity = 0;
  constexpr std::size_t kStride = std::size_t(kProjectedTogether) * kTileSize;
  const std::uint16_t* of_batch[kProjectedTogether];
  for (std::size_t p = 0; p < kProjectedTogether; ++p) of_batch[p] = blocked[p] + batch.first;
  active.clear();
  for (int t = 0; t < batch.end - batch.first; ++t) {
    if (of_batch[0][t] | of_batch[1][t] | of_batch[2][t] | of_batch[3][t]) active.push_back(t);
  }
  if (capacity < active.size()) {
    capacity = std::size_t(tables.tiles);
    weights = hwy::AllocateAligned<float>(capacity * kStride);
    if (!weights) throw std::bad_alloc();
  }
  const TableView view = tables.view(batch);
  for (std::size_t p = 0; p < kProjectedTogether; ++p) {
    HWY_DYNAMIC_DISPATCH(BlockedCosines)
    (view, &normals[p].x, of_batch[p], active.data(), active.size(), kStride, weights.get() + p * kTileSize);
  }
  HWY_DYNAMIC_DISPATCH(Accumulate)(view, active.data(), active.size(), weights.get(), sums);
}

void gatherHits(const GatherSources& sources, int coefficients, std::span<const GatheredHit> hits,
                float scale, float* row) {
  constexpr std::size_t kWidth = 48;  // 36 coefficients in whole vectors of up to 16
  alignas(64) float sum[3][kWidth] = {};
  const std::size_t stride = rowStride(coefficients);
  HWY_DYNAMIC_DISPATCH(GatherHits)
  (sources, std::size_t(coefficients), stride, hits.data(), hits.size(), sum[0], kWidth);
  for (std::size_t color = 0; color < 3; ++color) {
    for (std::size_t i = 0; i < std::size_t(coefficients); ++i)
      row[color * stride + i] += scale * sum[color][i];
  }
}

const char* kernelTarget() {
  return HWY_DYNAMIC_DISPATCH(KernelTarget)();
}

}  // namespace gloam::prt
#endif
