// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Between two rays (Veach 1997, chapter 9): vertices, steps by lobes, and light by sources, sixteen paths at once.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/path_lanes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on
#include "math/sampling.h"
#include "reference/lanes_simd.h"
#include "reference/path_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::reference {
namespace HWY_NAMESPACE {

constexpr float kPi = sampling::kPi;
constexpr float kEver = std::numeric_limits<float>::infinity();

void numbersKernel(const Sampler::Scramble& scramble, const LaneBits& places, LaneBits& x, LaneBits& y) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Numbers n = numbers(scramble, load(places, i));
    store(n.x, x, i);
    store(n.y, y, i);
  }
}

// ---- Vertices -------------------------------------------------------------------------------------------------------

struct Gathered {
  LaneRows low, high, reach, lobes_low, lobes_high;
};

// Eight floats of each corner are mixed lane by lane: that no lane waits for another's memory.
HWY_INLINE void gatherVertices(const MeetingLanes& meetings, std::uint32_t mask, Gathered& to) {
  const hn::CappedTag<float, 4> four;
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const float *p = &meetings.corners[i][0]->position.x, *q = &meetings.corners[i][1]->position.x,
                *r = &meetings.corners[i][2]->position.x, *lobes = meetings.lobes[i];
    const float u = meetings.u.at[i], v = meetings.v_and_face[i][0];
    const auto of_p = hn::Set(four, 1.0f - u - v), of_q = hn::Set(four, u), of_r = hn::Set(four, v);
    for (std::size_t k = 0; k < 4; k += hn::Lanes(four)) {
      const auto a = hn::LoadU(four, p + k), b = hn::LoadU(four, q + k), c = hn::LoadU(four, r + k);
      hn::StoreU(hn::MulAdd(a, of_p, hn::MulAdd(b, of_q, hn::Mul(c, of_r))), four, to.low.at[i] + k);
      hn::StoreU(hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Abs(c)), four, to.reach.at[i] + k);
      const auto d = hn::LoadU(four, p + k + 4), e = hn::LoadU(four, q + k + 4),
                 f = hn::LoadU(four, r + k + 4);
      hn::StoreU(hn::MulAdd(d, of_p, hn::MulAdd(e, of_q, hn::Mul(f, of_r))), four, to.high.at[i] + k);
      hn::StoreU(hn::LoadU(four, lobes + k), four, to.lobes_low.at[i] + k);
      hn::StoreU(hn::LoadU(four, lobes + k + 4), four, to.lobes_high.at[i] + k);
    }
  }
}

void verticesKernel(PathLanes& lanes, const MeetingLanes& meetings, std::uint32_t mask, PlaceLanes& places) {
  Gathered gathered;
  gatherVertices(meetings, mask, gathered);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Columns low = columns(gathered.low.at, i), high = columns(gathered.high.at, i),
                  reach = columns(gathered.reach.at, i), hit = columns(meetings.v_and_face, i);
    const V3 position{low.a, low.b, low.c}, smooth{low.d, high.a, high.b}, hit_normal{hit.b, hit.c, hit.d};
    const V3 face = mul(hit_normal, hn::CopySign(all(1.0f), dot(load(lanes.to_view, i), hit_normal)));
    const V squared = dot(smooth, smooth);
    const M has_normal = hn::And(hn::Gt(squared, zero()), hn::Lt(squared, all(kEver)));
    const V side = hn::CopySign(all(1.0f), dot(smooth, face));
    const V3 normal = choose(has_normal, mul(smooth, hn::Div(side, hn::Sqrt(squared))), face);
    const V most = hn::Max(hn::Max(reach.a, reach.b), reach.c);  // trace::surfaceOffset
    store(face, lanes.geometric_normal, i);
    store(normal, lanes.normal, i);
    store(position, lanes.position, i);
    store(mulAdd(face, hn::Mul(most, all(0x1p-18f)), position), lanes.origin, i);
    store(high.c, places.u, i);
    store(high.d, places.v, i);
    store(hn::IfThenElse(has_normal, side, all(1.0f)), places.side, i);
    const Columns lobes = columns(gathered.lobes_low.at, i), others = columns(gathered.lobes_high.at, i);
    store(V3{lobes.a, lobes.b, lobes.c}, lanes.diffuse, i);
    store(V3{lobes.d, others.a, others.b}, lanes.specular, i);
    store(others.c, lanes.exponent, i);
    store(others.d, lanes.specular_share, i);
  }
}

template <class Lanes>
HWY_INLINE void moveUp(const Lanes& from, M taken, std::size_t i, Lanes& to, std::size_t left) {
  const auto row = load(from, i);
  const hn::DFromV<decltype(row)> d;
  hn::StoreU(hn::Compress(row, hn::RebindMask(d, taken)), d, to.at + left);
}

void takeKernel(PathLanes& lanes, std::uint32_t mask) {
  const D d;
  for (std::size_t i = 0, left = 0; i < kLanes; i += hn::Lanes(d)) {
    const M taken = maskOf(mask, i);
    moveUp(lanes.place, taken, i, lanes.place, left);
    moveUp(lanes.slot, taken, i, lanes.slot, left);
    moveUp(lanes.step.x, taken, i, lanes.throughput.x, left);
    moveUp(lanes.step.y, taken, i, lanes.throughput.y, left);
    moveUp(lanes.step.z, taken, i, lanes.throughput.z, left);
    const V3 direction = load(lanes.direction, i);
    hn::StoreU(hn::Neg(hn::Compress(direction.x, taken)), d, lanes.to_view.x.at + left);
    hn::StoreU(hn::Neg(hn::Compress(direction.y, taken)), d, lanes.to_view.y.at + left);
    hn::StoreU(hn::Neg(hn::Compress(direction.z, taken)), d, lanes.to_view.z.at + left);
    left += hn::CountTrue(d, taken);
  }
}

void mirrorsKernel(PathLanes& lanes) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V3 normal = load(lanes.normal, i), to_view = load(lanes.to_view, i);
    const V twice = hn::Mul(all(2.0f), dot(normal, to_view));
    store(sub(mul(normal, twice), to_view), lanes.mirror, i);
  }
}

// ---- Lobes ----------------------------------------------------------------------------------------------------------

struct Lobes {
  V3 value;
  V pdf;
};

HWY_INLINE Lobes lobesAt(const PathLanes& lanes, const V3& direction, std::size_t i) {
  const D d;
  const V lambert = hn::Mul(hn::Max(zero(), dot(load(lanes.normal, i), direction)), all(1.0f / kPi));
  const V3 value = mul(load(lanes.diffuse, i), lambert);
  if (!lanes.glossy) return {value, lambert};
  const V cosine = dot(load(lanes.mirror, i), direction), n = load(lanes.exponent, i);
  const V power = hn::Exp(d, hn::Mul(n, hn::Log(d, hn::Max(cosine, all(1e-30f)))));
  const V scaled = hn::Mul(power, hn::MulAdd(n, all(0.5f / kPi), all(0.5f / kPi)));
  const V phong = hn::IfThenElseZero(hn::Gt(cosine, zero()), scaled), share = load(lanes.specular_share, i);
  return {mulAdd(load(lanes.specular, i), phong, value), mix(lambert, phong, share)};
}

void lobesKernel(const PathLanes& lanes, const LaneVectors& directions, LaneVectors& values,
                 LaneFloats& pdfs) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Lobes lobes = lobesAt(lanes, load(directions, i), i);
    store(lobes.value, values, i);
    store(lobes.pdf, pdfs, i);
  }
}

// sampling::phongLobe about the mirror direction.
HWY_INLINE V3 aboutMirror(const PathLanes& lanes, V u, V v, std::size_t i) {
  const D d;
  const V first = hn::Min(hn::Div(u, load(lanes.specular_share, i)), all(0x1.fffffep-1f));
  const V log_z = hn::Div(hn::Log(d, hn::Sub(all(1.0f), first)), hn::Add(load(lanes.exponent, i), all(1.0f)));
  const V radius = hn::Sqrt(hn::Max(zero(), hn::Neg(hn::Expm1(d, hn::Add(log_z, log_z)))));
  const Circle azimuth = circle(v);
  return about(load(lanes.mirror, i), hn::Mul(radius, azimuth.cosine), hn::Mul(radius, azimuth.sine),
               hn::Exp(d, log_z));
}

HWY_INLINE V3 stepDirection(const PathLanes& lanes, V u, V v, std::size_t i) {
  const V3 normal = load(lanes.normal, i);
  if (!lanes.glossy) return cosineAbout(normal, u, v);
  const V share = load(lanes.specular_share, i);
  const V rest = hn::Div(hn::Sub(u, share), hn::Sub(all(1.0f), share));
  const V3 lambert = cosineAbout(normal, hn::Min(hn::Max(rest, zero()), all(0x1.fffffep-1f)), v);
  const M specular = hn::Lt(u, share);
  if (hn::AllFalse(D(), specular)) return lambert;
  return choose(specular, aboutMirror(lanes, u, v, i), lambert);
}

void stepsKernel(PathLanes& lanes, const Sampler::Scramble& scramble) {
  lanes.going = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Numbers n = numbers(scramble, load(lanes.place, i));
    const V3 direction = stepDirection(lanes, toUnit(n.x), toUnit(n.y), i);
    const Lobes lobes = lobesAt(lanes, direction, i);
    const M above =
        hn::And(hn::Gt(dot(load(lanes.geometric_normal, i), direction), zero()), hn::Gt(lobes.pdf, zero()));
    const V3 step = mul(mul(load(lanes.throughput, i), lobes.value), hn::Div(all(1.0f), lobes.pdf));
    store(direction, lanes.direction, i);
    store(hn::IfThenElseZero(above, lobes.pdf), lanes.pdf, i);
    const V3 kept = keep(above, step);
    store(kept, lanes.step, i);
    lanes.going |= bitsOf(notBlack(kept), i);
  }
}

// ---- Light ----------------------------------------------------------------------------------------------------------

// Power heuristic; 1 where `both` is 0.
HWY_INLINE V weight(V pdf, V other_pdf, V both) {
  const V ratio = hn::Mul(both, hn::Div(other_pdf, pdf));
  return hn::Div(all(1.0f), hn::MulAdd(ratio, ratio, all(1.0f)));
}

HWY_INLINE M isAbove(const PathLanes& lanes, const V3& direction, std::size_t i) {
  return hn::Gt(dot(load(lanes.geometric_normal, i), direction), zero());
}

void aboveKernel(const PathLanes& lanes, const LaneVectors& directions, std::uint32_t& bits) {
  bits = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D()))
    bits |= bitsOf(isAbove(lanes, load(directions, i), i), i);
}

// Light and the bits of who has some.
HWY_INLINE std::uint32_t storeLight(M wanted, const V3& given, LaneVectors& light, std::size_t i) {
  const V3 kept = keep(wanted, given);
  store(kept, light, i);
  return bitsOf(notBlack(kept), i);
}

void skyKernel(const PathLanes& lanes, const LaneFloats& pdf, bool both, LightLanes& light) {
  light.wanted = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V3 direction = load(light.direction, i);
    const V sky_pdf = load(pdf, i);
    const M wanted = hn::And(isAbove(lanes, direction, i), hn::Gt(sky_pdf, zero()));
    if (hn::AllFalse(D(), wanted)) continue;
    const Lobes lobes = lobesAt(lanes, direction, i);
    const V share = hn::Div(weight(sky_pdf, lobes.pdf, all(both ? 1.0f : 0.0f)), sky_pdf);
    store(all(kEver), light.t_far, i);
    light.wanted |=
        storeLight(wanted, mul(mul(load(lanes.throughput, i), lobes.value), share), light.light, i);
  }
}

void skyStepsKernel(const PathLanes& lanes, const LaneFloats& sky_pdf, bool both, LaneVectors& light) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V pdf = load(lanes.pdf, i), of_sky = load(sky_pdf, i);
    const M there = hn::And(hn::Gt(pdf, zero()), hn::Gt(of_sky, zero()));  // no light where it has no density
    const V share = weight(pdf, of_sky, all(both ? 1.0f : 0.0f));
    storeLight(there, mul(load(lanes.step, i), share), light, i);
  }
}

HWY_INLINE void storeRay(const PathLanes& lanes, const V3& end, LightLanes& light, std::size_t i) {
  const V3 way = sub(end, load(lanes.origin, i));
  const V length = hn::Sqrt(dot(way, way));
  store(mul(way, hn::Div(all(1.0f), hn::Max(length, all(1e-37f)))), light.direction, i);
  store(length, light.t_far, i);
}

void emittersKernel(const PathLanes& lanes, const EmitterLanes& points, bool both, LightLanes& light) {
  light.wanted = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V3 position = load(points.position, i), normal = load(points.normal, i);
    const V3 way = sub(position, load(lanes.position, i));
    const V squared = dot(way, way);
    const V3 direction = mul(way, hn::Div(all(1.0f), hn::Sqrt(squared)));
    const V cosine = dot(normal, direction);
    const V pdf = hn::Div(hn::Mul(load(points.area_pdf, i), squared), hn::Abs(cosine));
    const M there = hn::And(hn::Gt(squared, zero()), hn::Ne(cosine, zero()));
    const M wanted = hn::And(hn::And(isAbove(lanes, direction, i), hn::Gt(pdf, zero())), there);
    if (hn::AllFalse(D(), wanted)) continue;
    const Lobes lobes = lobesAt(lanes, direction, i);
    const V share = hn::Div(weight(pdf, lobes.pdf, all(both ? 1.0f : 0.0f)), pdf);
    const V3 sum = mul(mul(load(lanes.throughput, i), lobes.value), mul(load(points.radiance, i), share));
    // To just before the triangle, on the side from which it is seen.
    storeRay(lanes, mulAdd(normal, hn::CopySign(load(points.ray_offset, i), hn::Neg(cosine)), position),
             light, i);
    light.wanted |= storeLight(wanted, sum, light.light, i);
  }
}

// ---- Lamps ----------------------------------------------------------------------------------------------------------

struct Arriving {
  V3 irradiance, to_lamp;
  V distance;
};

// Lamp::at.
HWY_INLINE Arriving lampAt(const Lamp& lamp, const V3& place) {
  if (lamp.type == Light::Type::kDirectional) return {all(lamp.intensity), all(-lamp.direction), all(kEver)};
  const V3 way = sub(all(lamp.position), place);
  const V squared = hn::Max(dot(way, way), all(punctual::kLeastSquaredDistance));
  const V distance = hn::Sqrt(squared);
  const V3 to_lamp = mul(way, hn::Div(all(1.0f), distance));
  V factor = hn::Div(all(1.0f), squared);
  if (lamp.range > 0.0f) {
    const V ratio = hn::Div(distance, all(lamp.range)), two = hn::Mul(ratio, ratio);
    factor = hn::Mul(factor, clampUnit(hn::NegMulAdd(two, two, all(1.0f))));
  }
  if (lamp.type == Light::Type::kSpot) {
    const V cosine = hn::Neg(dot(to_lamp, all(lamp.direction)));
    const float width = std::max(1e-3f, lamp.cos_inner - lamp.cos_outer);
    const V ramp = clampUnit(hn::Div(hn::Sub(cosine, all(lamp.cos_outer)), all(width)));
    factor = hn::Mul(factor, hn::Mul(ramp, ramp));
  }
  return {mul(all(lamp.intensity), factor), to_lamp, distance};
}

// What it gives without shadow, and without the path's throughput.
HWY_INLINE V3 lampLight(const PathLanes& lanes, const Lamp& lamp, const Arriving& from, std::size_t i) {
  const M wanted = hn::And(isAbove(lanes, from.to_lamp, i), notBlack(from.irradiance));
  if (hn::AllFalse(D(), wanted)) return {zero(), zero(), zero()};
  const V3 given = mul(from.irradiance, lobesAt(lanes, from.to_lamp, i).value);
  if (lamp.shot_density == 0.0f) return keep(wanted, given);
  const V cosine = dot(load(lanes.geometric_normal, i), from.to_lamp);
  const V shot = hn::Div(hn::Mul(all(lamp.shot_density), cosine), hn::Mul(from.distance, from.distance));
  return keep(wanted, mul(given, weight(load(lanes.found, i), shot, all(1.0f))));
}

HWY_INLINE std::uint32_t storeLamp(const PathLanes& lanes, const V3& to_lamp, V distance, const V3& given,
                                   LightLanes& light, std::size_t i) {
  const M far_away = hn::Ge(distance, all(kEver));
  storeRay(lanes, mulAdd(to_lamp, hn::IfThenZeroElse(far_away, distance), load(lanes.position, i)), light, i);
  const V3 near_direction = load(light.direction, i);
  const M as_given = hn::Or(far_away, hn::Eq(load(light.t_far, i), zero()));
  store(choose(as_given, to_lamp, near_direction), light.direction, i);
  store(hn::IfThenElse(far_away, all(kEver), load(light.t_far, i)), light.t_far, i);
  const V3 sum = mul(given, load(lanes.throughput, i));
  return storeLight(notBlack(given), sum, light.light, i);
}

void lampKernel(const PathLanes& lanes, const Lamp& lamp, LightLanes& light) {
  light.wanted = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Arriving from = lampAt(lamp, load(lanes.position, i));
    const V3 given = lampLight(lanes, lamp, from, i);
    if (hn::AllFalse(D(), notBlack(given))) continue;
    light.wanted |= storeLamp(lanes, from.to_lamp, from.distance, given, light, i);
  }
}

void oneLampKernel(const PathLanes& lanes, std::span<const Lamp> lamps, const Sampler::Scramble& scramble,
                   LightLanes& light) {
  light.wanted = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    V u = toUnit(numbers(scramble, load(lanes.place, i)).x), total = zero(), distance = zero();
    V3 chosen{zero(), zero(), zero()}, to_lamp = chosen;
    for (const Lamp& lamp : lamps) {
      const Arriving from = lampAt(lamp, load(lanes.position, i));
      const V3 given = lampLight(lanes, lamp, from, i);
      const V size = hn::Add(hn::Add(given.x, given.y), given.z);
      const M some = hn::Gt(size, zero());
      if (hn::AllFalse(D(), some)) continue;
      total = hn::Add(total, hn::IfThenElseZero(some, size));
      const V share = hn::Div(size, total);
      const M takes = hn::And(some, hn::Lt(u, share));
      chosen = choose(takes, mul(given, hn::Div(all(1.0f), size)), chosen);
      to_lamp = choose(takes, from.to_lamp, to_lamp);
      distance = hn::IfThenElse(takes, from.distance, distance);
      const V passed = hn::Div(hn::Sub(u, share), hn::Sub(all(1.0f), share));
      u = hn::IfThenElse(some, hn::IfThenElse(takes, hn::Div(u, share), passed), u);
    }
    light.wanted |= storeLamp(lanes, to_lamp, distance, mul(chosen, total), light, i);
  }
}

void shotsKernel(const PathLanes& lanes, const PathLanes& there, const ShotLanes& shots, LightLanes& light) {
  light.wanted = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const V3 way = sub(load(there.position, i), load(lanes.position, i));
    const V squared = dot(way, way);
    const V3 direction = mul(way, hn::Div(all(1.0f), hn::Sqrt(squared)));
    const V cosine = hn::Neg(dot(load(there.geometric_normal, i), direction));
    const M wanted = hn::And(isAbove(lanes, direction, i), hn::Gt(cosine, zero()));
    if (hn::AllFalse(D(), wanted)) continue;
    const V reach = hn::Div(cosine, squared);
    const Lobes near_lobes = lobesAt(lanes, direction, i);
    const Lobes far_lobes = lobesAt(there, load(shots.to_lamp, i), i);
    const V share =
        hn::Mul(reach, weight(load(shots.area_pdf, i), hn::Mul(near_lobes.pdf, reach), all(1.0f)));
    const V3 sum = mul(mul(mul(load(lanes.throughput, i), near_lobes.value), far_lobes.value),
                       mul(load(shots.irradiance, i), share));
    storeRay(lanes, load(there.origin, i), light, i);
    light.wanted |= storeLight(wanted, sum, light.light, i);
  }
  light.wanted &= shots.landed;
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::reference
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::reference {

HWY_EXPORT(numbersKernel);
HWY_EXPORT(verticesKernel);
HWY_EXPORT(takeKernel);
HWY_EXPORT(mirrorsKernel);
HWY_EXPORT(lobesKernel);
HWY_EXPORT(stepsKernel);
HWY_EXPORT(aboveKernel);
HWY_EXPORT(skyKernel);
HWY_EXPORT(skyStepsKernel);
HWY_EXPORT(emittersKernel);
HWY_EXPORT(lampKernel);
HWY_EXPORT(oneLampKernel);
HWY_EXPORT(shotsKernel);

void numbersOfLanes(const Sampler::Scramble& scramble, const LaneBits& places, LaneBits& x, LaneBits& y) {
  HWY_DYNAMIC_DISPATCH(numbersKernel)(scramble, places, x, y);
}
void setVertices(PathLanes& lanes, const MeetingLanes& meetings, std::uint32_t mask, PlaceLanes& places) {
  HWY_DYNAMIC_DISPATCH(verticesKernel)(lanes, meetings, mask, places);
}
void takeSteps(PathLanes& lanes, std::uint32_t mask) {
  HWY_DYNAMIC_DISPATCH(takeKernel)(lanes, mask);
}
void setMirrors(PathLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(mirrorsKernel)(lanes);
}
void chooseSteps(PathLanes& lanes, const Sampler::Scramble& scramble) {
  HWY_DYNAMIC_DISPATCH(stepsKernel)(lanes, scramble);
}
void lobesOfLanes(const PathLanes& lanes, const LaneVectors& directions, LaneVectors& values,
                  LaneFloats& pdfs) {
  HWY_DYNAMIC_DISPATCH(lobesKernel)(lanes, directions, values, pdfs);
}
std::uint32_t lanesAbove(const PathLanes& lanes, const LaneVectors& directions) {
  std::uint32_t bits;
  HWY_DYNAMIC_DISPATCH(aboveKernel)(lanes, directions, bits);
  return bits;
}
void lightFromSky(const PathLanes& lanes, const LaneFloats& pdf, bool both, LightLanes& light) {
  HWY_DYNAMIC_DISPATCH(skyKernel)(lanes, pdf, both, light);
}
void lightOfSteps(const PathLanes& lanes, const LaneFloats& pdf, bool both, LaneVectors& light) {
  HWY_DYNAMIC_DISPATCH(skyStepsKernel)(lanes, pdf, both, light);
}
void lightFromEmitters(const PathLanes& lanes, const EmitterLanes& points, bool both, LightLanes& light) {
  HWY_DYNAMIC_DISPATCH(emittersKernel)(lanes, points, both, light);
}
void lightFromLamp(const PathLanes& lanes, const Lamp& lamp, LightLanes& light) {
  HWY_DYNAMIC_DISPATCH(lampKernel)(lanes, lamp, light);
}
void lightFromOneLamp(const PathLanes& lanes, std::span<const Lamp> lamps, const Sampler::Scramble& scramble,
                      LightLanes& light) {
  HWY_DYNAMIC_DISPATCH(oneLampKernel)(lanes, lamps, scramble, light);
}
void lightFromShots(const PathLanes& lanes, const PathLanes& there, const ShotLanes& shots,
                    LightLanes& light) {
  HWY_DYNAMIC_DISPATCH(shotsKernel)(lanes, there, shots, light);
}

}  // namespace gloam::reference
#endif
