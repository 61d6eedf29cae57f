// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sphere is cut into cells between the centres of four texels, in each of which the light is bilinear. A cell is chosen
// by its mean times its solid angle, a place within it by the bilinear function itself: so the density follows the light,
// but for the change of the cosine within a row. The half cells at the poles are constant upward and are sampled by solid
// angle. The density is importance / total / cos(elevation) times a factor of the row.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/sky_lanes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/cache_control.h>
// clang-format on
#include <bit>

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

// ---- Cells ----------------------------------------------------------------------------------------------------------

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
HWY_INLINE Choice chooseIn(const std::vector<std::uint32_t>& starts, VI base,
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

struct Columns {
  VI row, base, first_base;
  V rest;
  VU number;
};
HWY_INLINE Columns rowOf(const SkyTable& sky, const Sampler::Scramble& scramble, VU place) {
  const DI di;
  const VU most = allBits(0xfffffffeu);
  const Numbers n = numbers(scramble, place);
  const Choice row =
      chooseIn(sky.row_starts, hn::Zero(di), sky.row_first, hn::Zero(di), sky.row_shift, hn::Min(n.y, most));
  return {row.index, hn::Mul(row.index, hn::Set(di, sky.width + 1)),
          hn::Mul(row.index, hn::Set(di, (1 << (32 - sky.cell_shift)) + 1)), row.rest, hn::Min(n.x, most)};
}

void cellsKernel(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& places,
                 SkyPlaces& cells) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Columns row = rowOf(sky, scramble, load(places, i));
    const Choice column =
        chooseIn(sky.cell_starts, row.base, sky.cell_first, row.first_base, sky.cell_shift, row.number);
    store(column.index, cells.cell_x, i);
    store(row.row, cells.cell_y, i);
    store(column.rest, cells.x, i);
    store(row.rest, cells.y, i);
  }
}

// ---- Directions -----------------------------------------------------------------------------------------------------

// Where between 0 and 1 a density that goes linearly from a to b has the share u below it.
HWY_INLINE V sampleLinear(V a, V b, V u) {
  const V sum = hn::Add(a, b), root = hn::Sqrt(mix(hn::Mul(a, a), hn::Mul(b, b), u));
  const V place = hn::Min(hn::Div(hn::Mul(u, sum), hn::Add(a, root)), all(1.0f));
  return hn::IfThenElse(hn::Gt(sum, zero()), place, u);
}

HWY_INLINE M isPole(const SkyTable& sky, VI cell_y) {
  const DI di;
  return hn::RebindMask(D(), hn::Or(hn::Eq(cell_y, hn::Zero(di)), hn::Eq(cell_y, hn::Set(di, sky.height))));
}

struct Elevation {
  V y, sine, cosine;
};
HWY_INLINE Elevation atPole(VI cell_y, V y, const Elevation& elsewhere, M pole, float polar_height) {
  const V top = hn::IfThenElse(hn::RebindMask(D(), hn::Eq(cell_y, hn::Zero(DI()))), all(1.0f), all(-1.0f));
  const V share = hn::IfThenElse(hn::Gt(top, zero()), y, hn::Sub(all(1.0f), y));
  const V below = hn::Mul(all(polar_height), share);  // 1 - |sine|
  const V cosine = hn::Sqrt(hn::Mul(below, hn::Sub(all(2.0f), below)));
  return {hn::IfThenElse(pole, all(0.5f), elsewhere.y),  // the same all over
          hn::IfThenElse(pole, hn::Mul(top, hn::Sub(all(1.0f), below)), elsewhere.sine),
          hn::IfThenElse(pole, cosine, elsewhere.cosine)};
}

void placeKernel(const SkyTable& sky, SkyPlaces& places, LaneVectors& directions) {
  const D d;
  const DI di;
  const float* importance = &sky.texels[0].w;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const VI cell_x = load(places.cell_x, i), cell_y = load(places.cell_y, i);
    const VI texel = hn::ShiftLeft<3>(hn::Add(hn::Mul(cell_y, hn::Set(di, sky.width + 1)), cell_x));
    const V upper_left = hn::GatherIndex(d, importance, texel);
    const V upper_right = hn::GatherIndex(d, importance + 8, texel);
    const V lower_left = hn::GatherIndex(d, importance + 4, texel);
    const V lower_right = hn::GatherIndex(d, importance + 12, texel);
    Elevation at;
    at.y =
        sampleLinear(hn::Add(upper_left, upper_right), hn::Add(lower_left, lower_right), load(places.y, i));
    const V down = hn::Mul(hn::Add(toFloat(cell_y), hn::Sub(at.y, all(0.5f))), all(0.5f / float(sky.height)));
    const Circle elevation = circle(hn::Sub(all(0.25f), down));
    at.sine = elevation.sine;
    at.cosine = elevation.cosine;
    const M pole = isPole(sky, cell_y);
    if (!hn::AllFalse(d, pole)) at = atPole(cell_y, load(places.y, i), at, pole, sky.polar_height);
    const V x = sampleLinear(mix(upper_left, lower_left, at.y), mix(upper_right, lower_right, at.y),
                             load(places.x, i));
    const V across = hn::Mul(hn::Add(toFloat(cell_x), hn::Sub(x, all(0.5f))), all(1.0f / float(sky.width)));
    const Circle azimuth = circle(hn::Sub(across, all(0.5f)));
    const V local_x = hn::Mul(at.cosine, azimuth.cosine), local_z = hn::Mul(at.cosine, azimuth.sine);
    const V cosine = all(sky.cos_rotation), sine = all(sky.sin_rotation);
    store(x, places.x, i);
    store(at.y, places.y, i);
    store(at.cosine, places.cos_elevation, i);
    store(V3{hn::MulAdd(cosine, local_x, hn::Mul(sine, local_z)), at.sine,
             hn::NegMulAdd(sine, local_x, hn::Mul(cosine, local_z))},
          directions, i);
  }
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
    store(cos_elevation, places.cos_elevation, i);
  }
}

// ---- Light ----------------------------------------------------------------------------------------------------------

void lightKernel(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, SkyLight& light) {
  const D d;
  const hn::CappedTag<float, 4> four;
  HWY_ALIGN float texels[4 * kLanes] = {};
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const auto cell =
        std::size_t(places.cell_y.at[i]) * std::size_t(sky.width + 1) + std::size_t(places.cell_x.at[i]);
    const float* corner = &sky.texels[2 * cell].x;
    const auto x = hn::Set(four, places.x.at[i]), y = hn::Set(four, places.y.at[i]);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(four)) {  // all four channels, where vectors are so wide
      const auto upper_left = hn::LoadU(four, corner + c), upper_right = hn::LoadU(four, corner + 8 + c);
      const auto left = hn::MulAdd(hn::Sub(hn::LoadU(four, corner + 4 + c), upper_left), y, upper_left);
      const auto right = hn::MulAdd(hn::Sub(hn::LoadU(four, corner + 12 + c), upper_right), y, upper_right);
      hn::Store(hn::MulAdd(hn::Sub(right, left), x, left), four, texels + 4 * i + c);
    }
  }
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    V3 radiance;
    V importance;
    hn::LoadInterleaved4(d, texels + 4 * i, radiance.x, radiance.y, radiance.z, importance);
    const VI cell_y = load(places.cell_y, i);
    const V pdf = hn::Mul(importance, hn::GatherIndex(d, sky.density.data(), cell_y));
    const V cosine =
        hn::IfThenElse(isPole(sky, cell_y), all(1.0f), hn::Max(load(places.cos_elevation, i), all(1e-6f)));
    store(radiance, light.radiance, i);
    store(hn::Div(pdf, cosine), light.pdf, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::reference
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::reference {
HWY_EXPORT(cellsKernel);
HWY_EXPORT(placeKernel);
HWY_EXPORT(findKernel);
HWY_EXPORT(lightKernel);

void chooseCells(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& places,
                 SkyPlaces& cells) {
  HWY_DYNAMIC_DISPATCH(cellsKernel)(sky, scramble, places, cells);
}
void placesOf(const SkyTable& sky, const LaneVectors& directions, SkyPlaces& places) {
  HWY_DYNAMIC_DISPATCH(findKernel)(sky, directions, places);
}
void placeInCells(const SkyTable& sky, SkyPlaces& places, LaneVectors& directions) {
  HWY_DYNAMIC_DISPATCH(placeKernel)(sky, places, directions);
}
void sendFor(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask) {
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const glm::vec4* texel = &sky.texels[2 * (std::size_t(places.cell_y.at[i]) * std::size_t(sky.width + 1) +
                                              std::size_t(places.cell_x.at[i]))];
    hwy::Prefetch(texel);
    hwy::Prefetch(texel + 3);
  }
}
void lightAt(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, SkyLight& light) {
  HWY_DYNAMIC_DISPATCH(lightKernel)(sky, places, mask, light);
}

}  // namespace gloam::reference
#endif
