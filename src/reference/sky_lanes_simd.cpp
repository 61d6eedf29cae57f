// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sphere is cut into cells between the centres of four texels, in each of which the light is bilinear, and into the
// blocks of sky_blocks.cpp. Two random numbers choose a block, what is left of them a place in it.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/sky_lanes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include "reference/lanes_simd.h"
#include "reference/sky_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::reference {
namespace HWY_NAMESPACE {

HWY_INLINE VU gather(const std::vector<std::uint32_t>& from, VI index) {
  return hn::GatherIndex(DU(), from.data(), index);
}
HWY_INLINE VI asInt(VU v) {
  return hn::BitCast(DI(), v);
}
// Of numbers of any size, to a float's precision.
HWY_INLINE V asFloat(VU v) {
  const V high = toFloat(asInt(hn::ShiftRight<16>(v))), low = toFloat(asInt(hn::And(v, allBits(0xffffu))));
  return hn::MulAdd(high, all(65536.0f), low);
}
HWY_INLINE VI clampInt(VI v, int most) {
  return hn::Min(hn::Max(v, hn::Zero(DI())), hn::Set(DI(), most));
}

// ---- Directions -----------------------------------------------------------------------------------------------------

struct Choice {
  VI index;
  V rest;
};
struct Range {
  VI low, high;
};
// Two neighbours of a table.
HWY_INLINE Range pairOf(const std::vector<std::uint16_t>& table, VI index) {
  const auto* base = reinterpret_cast<const std::uint32_t*>(table.data());
  const VU both = hn::GatherOffset(DU(), base, hn::Add(index, index));
  return {asInt(hn::And(both, allBits(0xffffu))), asInt(hn::ShiftRight<16>(both))};
}

// Distribution::choose in tables that begin at `base` and `first_base`, by halves. `number` is below the largest.
HWY_INLINE Choice chooseFrom(const std::vector<std::uint32_t>& starts, VI base,
                             const std::vector<std::uint16_t>& first, VI first_base, int shift, VU number) {
  const DI di;
  const VI one = hn::Set(di, 1);
  auto [low, high] = pairOf(first, hn::Add(first_base, asInt(hn::ShiftRightSame(number, shift))));
  low = hn::Add(base, low);
  high = hn::Add(base, high);
  while (!hn::AllFalse(di, hn::Lt(low, high))) {
    const VI middle = hn::ShiftRight<1>(hn::Add(hn::Add(low, high), one));
    const auto beyond = hn::RebindMask(di, hn::Gt(gather(starts, middle), number));
    low = hn::IfThenElse(beyond, low, middle);
    high = hn::IfThenElse(beyond, hn::Sub(middle, one), high);
  }
  const VU start = gather(starts, low), next = gather(starts, hn::Add(low, one));
  const V rest = hn::Div(asFloat(hn::Sub(number, start)), asFloat(hn::Sub(next, start)));
  return {hn::Sub(low, base), hn::Min(rest, all(0x1.fffffep-1f))};
}

struct Chosen {
  VI block;
  V x, y;  // what is left of the numbers
};
HWY_INLINE Chosen chosenBy(const SkyTable& sky, const Numbers& n) {
  const DI di;
  const VU most = allBits(0xfffffffeu);
  const Choice row = chooseFrom(sky.row_starts, hn::Zero(di), sky.row_first, hn::Zero(di), sky.row_shift,
                                hn::Min(n.y, most));
  const VI first = hn::GatherIndex(di, sky.row_blocks.data(), row.index);
  const VI first_part = hn::Mul(row.index, hn::Set(di, (1 << (32 - sky.block_shift)) + 1));
  const Choice block = chooseFrom(sky.block_starts, hn::Add(first, row.index), sky.block_first, first_part,
                                  sky.block_shift, hn::Min(n.x, most));
  return {hn::Add(first, block.index), block.rest, row.rest};
}

// Where between 0 and 1 a density that goes linearly from a to b has the share u below it.
HWY_INLINE V sampleLinear(V a, V b, V u) {
  const V sum = hn::Add(a, b), root = hn::Sqrt(mix(hn::Mul(a, a), hn::Mul(b, b), u));
  return hn::Min(hn::Div(hn::Mul(u, sum), hn::Max(hn::Add(a, root), all(1e-30f))), all(1.0f));
}

struct Blocks {
  V x, y, across, down, densities[4];
  V densityAt(V right, V lower) const {
    return mix(mix(densities[0], densities[1], right), mix(densities[2], densities[3], right), lower);
  }
};
// Row by row and turned in registers: quicker than eight gathers.
HWY_INLINE Blocks blocksAt(const SkyTable& sky, VI index) {
  const hn::CappedTag<float, 4> four;
  alignas(64) float low[kLanes][4], high[kLanes][4];
  alignas(64) std::int32_t indices[kLanes];
  hn::Store(index, DI(), indices);
  for (std::size_t i = 0; i < hn::Lanes(D()); ++i) {
    const float* from = &sky.blocks[std::size_t(indices[i])].x;
    for (std::size_t k = 0; k < 4; k += hn::Lanes(four)) {
      hn::StoreU(hn::LoadU(four, from + k), four, low[i] + k);
      hn::StoreU(hn::LoadU(four, from + 4 + k), four, high[i] + k);
    }
  }
  const Columns first = columns(low, 0), second = columns(high, 0);
  return {first.a, first.b, first.c, first.d, {second.a, second.b, second.c, second.d}};
}

void chooseKernel(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& from,
                  SkyPlaces& places, LaneVectors& directions) {
  const D d;
  const V half = all(0.5f), x_scale = all(1.0f / float(sky.width)), y_scale = all(0.5f / float(sky.height));
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const Chosen chosen = chosenBy(sky, numbers(scramble, load(from, i)));
    const Blocks block = blocksAt(sky, chosen.block);
    const auto& [upper_left, upper_right, lower_left, lower_right] = block.densities;
    const V down = sampleLinear(hn::Add(upper_left, upper_right), hn::Add(lower_left, lower_right), chosen.y);
    const V right =
        sampleLinear(mix(upper_left, lower_left, down), mix(upper_right, lower_right, down), chosen.x);
    const V x = hn::MulAdd(right, block.across, block.x);
    const V y = hn::MulAdd(down, block.down, block.y);
    const VI cell_x = clampInt(toInt(x), sky.width - 1), cell_y = clampInt(toInt(y), sky.height);
    const Circle elevation = circle(hn::NegMulAdd(hn::Sub(y, half), y_scale, all(0.25f)));
    const Circle azimuth = circle(hn::MulSub(hn::Sub(x, half), x_scale, half));
    const V up = hn::Max(elevation.cosine, zero());
    const V local_x = hn::Mul(up, azimuth.cosine), local_z = hn::Mul(up, azimuth.sine);
    const V cosine = all(sky.cos_rotation), sine = all(sky.sin_rotation);
    store(cell_x, places.cell_x, i);
    store(cell_y, places.cell_y, i);
    store(hn::Sub(x, toFloat(cell_x)), places.x, i);
    store(hn::Sub(y, toFloat(cell_y)), places.y, i);
    store(block.densityAt(right, down), places.density, i);
    store(up, places.cos_elevation, i);
    store(V3{hn::MulAdd(cosine, local_x, hn::Mul(sine, local_z)), elevation.sine,
             hn::NegMulAdd(sine, local_x, hn::Mul(cosine, local_z))},
          directions, i);
  }
}

// Down the quadtree under a tile.
HWY_INLINE VI blockAt(const SkyTable& sky, VI cell_x, VI cell_y) {
  const DI di;
  const VI one = hn::Set(di, 1);
  int bit = sky.tile_bits;
  const VI row = hn::Mul(hn::ShiftRightSame(cell_y, bit), hn::Set(di, sky.tiles_across));
  const VI tile = hn::Add(row, hn::ShiftRightSame(cell_x, bit));
  VI entry = hn::GatherIndex(di, sky.tiles.data(), tile);
  for (auto inner = hn::Lt(entry, hn::Zero(di)); !hn::AllFalse(di, inner);
       inner = hn::Lt(entry, hn::Zero(di))) {
    --bit;
    const VI right = hn::And(hn::ShiftRightSame(cell_x, bit), one);
    const VI down = hn::And(hn::ShiftRightSame(cell_y, bit), one);
    const VI child = hn::Add(hn::Not(entry), hn::Add(hn::Add(down, down), right));
    entry =
        hn::IfThenElse(inner, hn::GatherIndex(di, sky.nodes.data(), hn::IfThenElseZero(inner, child)), entry);
  }
  return entry;
}

void findKernel(const SkyTable& sky, const LaneVectors& directions, SkyPlaces& places) {
  const V one = all(1.0f), width = all(float(sky.width)), height = all(float(sky.height)), half = all(0.5f);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V3 to = load(directions, i);
    const V cos_elevation = hn::Sqrt(hn::MulAdd(to.x, to.x, hn::Mul(to.z, to.z)));
    V round = hn::Add(turns(to.z, to.x), all(sky.turned));  // 0 to 1 is once round
    round = hn::Add(round, hn::IfThenElseZero(hn::Lt(round, zero()), one));
    round = hn::Sub(round, hn::IfThenElseZero(hn::Ge(round, one), one));
    V x = hn::MulAdd(round, width, half);
    x = hn::Sub(x, hn::IfThenElseZero(hn::Ge(x, width), width));
    const V up = turns(to.y, cos_elevation);
    const V y = hn::Min(hn::Max(hn::MulAdd(hn::NegMulAdd(all(2.0f), up, half), height, half), half),
                        hn::Add(height, half));
    const VI cell_x = clampInt(toInt(x), sky.width - 1), cell_y = clampInt(toInt(y), sky.height);
    store(cell_x, places.cell_x, i);
    store(cell_y, places.cell_y, i);
    store(hn::Sub(x, toFloat(cell_x)), places.x, i);
    store(hn::Sub(y, toFloat(cell_y)), places.y, i);
    const Blocks block = blocksAt(sky, blockAt(sky, cell_x, cell_y));
    const V right = hn::Div(hn::Sub(x, block.x), hn::Max(block.across, all(1e-6f)));
    const V down = hn::Div(hn::Sub(y, block.y), hn::Max(block.down, all(1e-6f)));
    store(block.densityAt(clampUnit(right), clampUnit(down)), places.density, i);
    store(cos_elevation, places.cos_elevation, i);
  }
}

// ---- Light ----------------------------------------------------------------------------------------------------------

void densityKernel(const SkyPlaces& places, LaneFloats& pdf) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D()))
    store(hn::Div(load(places.density, i), hn::Max(load(places.cos_elevation, i), all(1e-6f))), pdf, i);
}

// SkyTexel's unpacked().
HWY_INLINE V3 unpackedTexels(VU low, VU high) {
  const VU of_color = allBits(0x3ffffu);
  const VU green = hn::Or(hn::ShiftRight<18>(low), hn::ShiftLeft<14>(hn::And(high, allBits(15u))));
  const V unit = hn::BitCast(D(), hn::ShiftLeft<23>(hn::ShiftRight<22>(high)));
  return mul(V3{toFloat(asInt(hn::And(low, of_color))), toFloat(asInt(green)),
                toFloat(asInt(hn::And(hn::ShiftRight<4>(high), of_color)))},
             unit);
}

void radianceKernel(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, LaneVectors& radiance) {
  alignas(64) std::uint32_t left[kLanes][4] = {}, right[kLanes][4] = {};
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const auto cell =
        std::size_t(places.cell_y.at[i]) * std::size_t(sky.width + 1) + std::size_t(places.cell_x.at[i]);
    const SkyTexel* texels = &sky.texels[2 * cell];
    std::memcpy(left[i], texels, 16);
    std::memcpy(right[i], texels + 2, 16);
  }
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    VU a, b, c, d;
    const V x = load(places.x, i), y = load(places.y, i);
    hn::LoadInterleaved4(DU(), left[i], a, b, c, d);
    const V3 upper = unpackedTexels(a, b), before = mulAdd(sub(unpackedTexels(c, d), upper), y, upper);
    hn::LoadInterleaved4(DU(), right[i], a, b, c, d);
    const V3 other = unpackedTexels(a, b), after = mulAdd(sub(unpackedTexels(c, d), other), y, other);
    store(mulAdd(sub(after, before), x, before), radiance, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::reference
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::reference {
HWY_EXPORT(chooseKernel);
HWY_EXPORT(findKernel);
HWY_EXPORT(densityKernel);
HWY_EXPORT(radianceKernel);

void chooseIn(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& numbers,
              SkyPlaces& places, LaneVectors& directions) {
  HWY_DYNAMIC_DISPATCH(chooseKernel)(sky, scramble, numbers, places, directions);
}
void placesOf(const SkyTable& sky, const LaneVectors& directions, SkyPlaces& places) {
  HWY_DYNAMIC_DISPATCH(findKernel)(sky, directions, places);
}
void densitiesOf(const SkyPlaces& places, LaneFloats& pdf) {
  HWY_DYNAMIC_DISPATCH(densityKernel)(places, pdf);
}
void radianceOf(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, LaneVectors& radiance) {
  HWY_DYNAMIC_DISPATCH(radianceKernel)(sky, places, mask, radiance);
}

}  // namespace gloam::reference
#endif
