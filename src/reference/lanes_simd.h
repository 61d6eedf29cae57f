// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Numbers, angles and vectors of sixteen lanes in registers: sampler.h's and angles.h's functions under the same names. For
// *_simd.cpp files, which Highway compiles once an instruction set: hence the guard that is undone each time. Longer than
// other headers, since three short ones would have that guard three times.
#if defined(GLOAM_REFERENCE_LANES_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOAM_REFERENCE_LANES_SIMD_H
#undef GLOAM_REFERENCE_LANES_SIMD_H
#else
#define GLOAM_REFERENCE_LANES_SIMD_H
#endif

#include <hwy/highway.h>

#include <cstring>

#include "reference/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::reference {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kLanes>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using M = hn::Mask<D>;

HWY_INLINE V all(float value) {
  return hn::Set(D(), value);
}
HWY_INLINE V zero() {
  return hn::Zero(D());
}
HWY_INLINE V load(const LaneFloats& from, std::size_t i) {
  return hn::Load(D(), from.at + i);
}
HWY_INLINE VU load(const LaneBits& from, std::size_t i) {
  return hn::Load(DU(), from.at + i);
}
HWY_INLINE VI load(const LaneInts& from, std::size_t i) {
  return hn::Load(DI(), from.at + i);
}
HWY_INLINE void store(V v, LaneFloats& to, std::size_t i) {
  hn::Store(v, D(), to.at + i);
}
HWY_INLINE void store(VU v, LaneBits& to, std::size_t i) {
  hn::Store(v, DU(), to.at + i);
}
HWY_INLINE void store(VI v, LaneInts& to, std::size_t i) {
  hn::Store(v, DI(), to.at + i);
}

/// Columns of rows of four floats a lane.
struct Columns {
  V a, b, c, d;
};
HWY_INLINE Columns columns(const float (*rows)[4], std::size_t i) {
  Columns v;
  hn::LoadInterleaved4(D(), rows[i], v.a, v.b, v.c, v.d);
  return v;
}

// ---- Vectors of three -----------------------------------------------------------------------------------------------

struct V3 {
  V x, y, z;
};
HWY_INLINE V3 load(const LaneVectors& from, std::size_t i) {
  return {load(from.x, i), load(from.y, i), load(from.z, i)};
}
HWY_INLINE void store(const V3& v, LaneVectors& to, std::size_t i) {
  store(v.x, to.x, i);
  store(v.y, to.y, i);
  store(v.z, to.z, i);
}
HWY_INLINE V3 all(const glm::vec3& v) {
  return {all(v.x), all(v.y), all(v.z)};
}
HWY_INLINE V3 add(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 sub(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 mul(const V3& a, const V3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE V3 mul(const V3& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
/// a s + b.
HWY_INLINE V3 mulAdd(const V3& a, V s, const V3& b) {
  return {hn::MulAdd(a.x, s, b.x), hn::MulAdd(a.y, s, b.y), hn::MulAdd(a.z, s, b.z)};
}
HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE V3 choose(M mask, const V3& a, const V3& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}
HWY_INLINE V3 keep(M mask, const V3& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y), hn::IfThenElseZero(mask, a.z)};
}
HWY_INLINE M notBlack(const V3& a) {
  return hn::Gt(hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z)), zero());
}
/// One bit a lane, from bit i on.
HWY_INLINE std::uint32_t bitsOf(M mask, std::size_t i) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits << i;
}
/// Lanes of a mask given by bits, from bit i on.
HWY_INLINE M maskOf(std::uint32_t bits, std::size_t i) {
  const DU du;
  const VU one_each = hn::Shl(hn::Set(du, 1u), hn::Iota(du, std::uint32_t(i)));
  return hn::RebindMask(D(), hn::Ne(hn::And(hn::Set(du, bits), one_each), hn::Zero(du)));
}
HWY_INLINE V mix(V a, V b, V t) {
  return hn::MulAdd(hn::Sub(b, a), t, a);
}
HWY_INLINE V clampUnit(V v) {
  return hn::Min(hn::Max(v, zero()), all(1.0f));
}
HWY_INLINE VI toInt(V v) {
  return hn::ConvertTo(DI(), v);
}
HWY_INLINE V toFloat(VI v) {
  return hn::ConvertTo(D(), v);
}

// ---- Random numbers -------------------------------------------------------------------------------------------------

HWY_INLINE VU allBits(std::uint32_t v) {
  return hn::Set(DU(), v);
}
template <int kShift>
HWY_INLINE VU swapped(VU v, std::uint32_t mask) {
  const VU m = allBits(mask);
  return hn::Or(hn::And(hn::ShiftRight<kShift>(v), m), hn::ShiftLeft<kShift>(hn::And(v, m)));
}
HWY_INLINE VU reversedBits(VU v) {
  v = swapped<1>(v, 0x55555555u);
  v = swapped<2>(v, 0x33333333u);
  v = swapped<4>(v, 0x0f0f0f0fu);
  v = swapped<8>(v, 0x00ff00ffu);
  return hn::Or(hn::ShiftRight<16>(v), hn::ShiftLeft<16>(v));
}
HWY_INLINE VU scrambled(VU v, std::uint32_t seed) {
  v = hn::Xor(v, hn::Mul(v, allBits(0x3d20adeau)));
  v = hn::Add(v, allBits(seed));
  v = hn::Mul(v, allBits((seed >> 16) | 1u));
  v = hn::Xor(v, hn::Mul(v, allBits(0x05526c56u)));
  return hn::Xor(v, hn::Mul(v, allBits(0x53a22864u)));
}
HWY_INLINE VU pascal(VU v) {
  v = hn::Xor(v, hn::And(hn::ShiftRight<1>(v), allBits(0x55555555u)));
  v = hn::Xor(v, hn::And(hn::ShiftRight<2>(v), allBits(0x33333333u)));
  v = hn::Xor(v, hn::And(hn::ShiftRight<4>(v), allBits(0x0f0f0f0fu)));
  v = hn::Xor(v, hn::And(hn::ShiftRight<8>(v), allBits(0x00ff00ffu)));
  return hn::Xor(v, hn::ShiftRight<16>(v));
}
struct Numbers {
  VU x, y;
};
HWY_INLINE Numbers numbers(const Sampler::Scramble& scramble, VU place) {
  const VU index = reversedBits(scrambled(place, scramble.order));
  return {reversedBits(scrambled(index, scramble.x)), reversedBits(scrambled(pascal(index), scramble.y))};
}
HWY_INLINE V toUnit(VU bits) {
  return hn::Mul(toFloat(hn::BitCast(DI(), hn::ShiftRight<8>(bits))), all(0x1p-24f));
}

// ---- Angles ---------------------------------------------------------------------------------------------------------

HWY_INLINE V turns(V y, V x) {
  const V ax = hn::Abs(x), ay = hn::Abs(y);
  const V t = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), all(1e-37f))), s = hn::Mul(t, t);
  V p = hn::MulAdd(s, all(-0.00072571f), all(0.00378479f));
  p = hn::MulAdd(s, p, all(-0.00936305f));
  p = hn::MulAdd(s, p, all(0.01570679f));
  p = hn::MulAdd(s, p, all(-0.02228693f));
  p = hn::MulAdd(s, p, all(0.03177841f));
  p = hn::MulAdd(s, p, all(-0.05304923f));
  p = hn::MulAdd(s, p, all(0.15915492f));
  V angle = hn::Mul(t, p);
  angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(all(0.25f), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, zero()), hn::Sub(all(0.5f), angle), angle);
  return hn::CopySign(angle, y);
}
HWY_INLINE V quarterSine(V t) {
  const V s = hn::Mul(t, t);
  V p = hn::MulAdd(s, all(39.7598271f), all(-76.5811726f));
  p = hn::MulAdd(s, p, all(81.6024764f));
  p = hn::MulAdd(s, p, all(-41.3416806f));
  return hn::Mul(t, hn::MulAdd(s, p, all(6.28318528f)));
}
struct Circle {
  V cosine, sine;
};
HWY_INLINE Circle circle(V turns) {
  V t = hn::Sub(turns, hn::IfThenElseZero(hn::Ge(turns, all(0.5f)), all(1.0f)));
  t = hn::Add(t, hn::IfThenElseZero(hn::Lt(turns, all(-0.5f)), all(1.0f)));
  const V size = hn::Abs(t), quarter = all(0.25f);
  return {quarterSine(hn::Sub(quarter, size)),
          hn::CopySign(quarterSine(hn::Sub(quarter, hn::Abs(hn::Sub(size, quarter)))), t)};
}
/// sampling::frame(axis) * (direction about +Z).
HWY_INLINE V3 about(const V3& n, V x, V y, V z) {
  const V sign = hn::CopySign(all(1.0f), n.z);
  const V a = hn::Div(all(-1.0f), hn::Add(sign, n.z)), b = hn::Mul(hn::Mul(n.x, n.y), a);
  const V xx = hn::MulAdd(hn::Mul(sign, hn::Mul(n.x, n.x)), a, all(1.0f));
  const V yy = hn::MulAdd(hn::Mul(n.y, n.y), a, sign);
  return {hn::MulAdd(xx, x, hn::MulAdd(b, y, hn::Mul(n.x, z))),
          hn::MulAdd(hn::Mul(sign, b), x, hn::MulAdd(yy, y, hn::Mul(n.y, z))),
          hn::NegMulAdd(hn::Mul(sign, n.x), x, hn::NegMulAdd(n.y, y, hn::Mul(n.z, z)))};
}
/// About a unit axis, with density cosine / pi.
HWY_INLINE V3 cosineAbout(const V3& axis, V u, V v) {
  const V radius = hn::Sqrt(u);
  const Circle azimuth = circle(v);
  return about(axis, hn::Mul(radius, azimuth.cosine), hn::Mul(radius, azimuth.sine),
               hn::Sqrt(hn::Sub(all(1.0f), u)));
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::reference
HWY_AFTER_NAMESPACE();
#endif
