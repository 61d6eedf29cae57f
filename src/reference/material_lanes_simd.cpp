// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// texture_reader.cpp, math/brdf.cpp's makeLobes and trace/surface.cpp's mappedNormal, sixteen at once.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/material_lanes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/cache_control.h>
// clang-format on
#include <bit>

#include "math/brdf.h"
#include "reference/lanes_simd.h"
#include "reference/material_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::reference {
namespace HWY_NAMESPACE {

// Lanes of a mask given by bits, from bit i on.
HWY_INLINE M maskOf(std::uint32_t bits, std::size_t i) {
  const DU du;
  const VU one_each = hn::Shl(hn::Set(du, 1u), hn::Iota(du, std::uint32_t(i)));
  return hn::RebindMask(D(), hn::Ne(hn::And(hn::Set(du, bits), one_each), hn::Zero(du)));
}
HWY_INLINE void storeIn(M mask, const V3& v, LaneVectors& to, std::size_t i) {
  store(choose(mask, v, load(to, i)), to, i);
}

// ---- Textures -------------------------------------------------------------------------------------------------------

struct Texels {
  VI first, second;
  V rest;  // how far from the first to the second
};

HWY_INLINE VI wrapped(VI texel, Wrap wrap, int size) {
  const DI di;
  const VI none = hn::Zero(di), all_of = hn::Set(di, size), last = hn::Set(di, size - 1);
  if (wrap == Wrap::kClampToEdge) return hn::Min(hn::Max(texel, none), last);
  const VI period = wrap == Wrap::kRepeat ? all_of : hn::Add(all_of, all_of);
  VI in_period = hn::Add(texel, hn::IfThenElseZero(hn::Lt(texel, none), period));
  in_period =
      hn::Sub(in_period, hn::IfThenElseZero(hn::Gt(in_period, hn::Sub(period, hn::Set(di, 1))), period));
  if (wrap == Wrap::kRepeat) return in_period;
  return hn::Min(in_period, hn::Sub(hn::Add(last, all_of), in_period));
}

HWY_INLINE Texels texelsAt(const TextureTable::Axis& axis, bool nearest, V given) {
  const V coordinate = hn::IfThenElseZero(hn::Lt(hn::Abs(given), all(0x1p30f)), given);
  V in_period;
  if (axis.wrap == Wrap::kRepeat) {
    in_period = hn::Sub(coordinate, hn::Floor(coordinate));
  } else if (axis.wrap == Wrap::kMirroredRepeat) {
    in_period = hn::NegMulAdd(all(2.0f), hn::Floor(hn::Mul(coordinate, all(0.5f))), coordinate);
  } else {
    in_period = hn::Min(hn::Max(coordinate, all(-1.0f)), all(2.0f));
  }
  const V place = hn::Sub(hn::Mul(in_period, all(float(axis.size))), all(nearest ? 0.0f : 0.5f));
  const V before = hn::Floor(place);
  const VI first = toInt(before), second = hn::Add(first, hn::Set(DI(), 1));
  return {wrapped(first, axis.wrap, axis.size), wrapped(second, axis.wrap, axis.size),
          hn::Sub(place, before)};
}

template <int kShift>
HWY_INLINE V channel(const TextureTable& texture, VU texel) {
  const VI byte = hn::BitCast(DI(), hn::And(hn::ShiftRight<kShift>(texel), allBits(0xffu)));
  return texture.srgb ? hn::GatherIndex(D(), texture.linear, byte)
                      : hn::Mul(toFloat(byte), all(1.0f / 255.0f));
}

HWY_INLINE V3 texelAt(const TextureTable& texture, VI row, VI column) {
  const VU texel = hn::GatherIndex(DU(), reinterpret_cast<const std::uint32_t*>(texture.texels),
                                   hn::Add(hn::Mul(row, hn::Set(DI(), texture.across.size)), column));
  return {channel<0>(texture, texel), channel<8>(texture, texel), channel<16>(texture, texel)};
}

struct Corners {
  Texels across, down;
};
HWY_INLINE Corners cornersAt(const TextureTable& texture, V s, V t) {
  const V x =
      hn::MulAdd(all(texture.from_u.x), s, hn::MulAdd(all(texture.from_v.x), t, all(texture.shift.x)));
  const V y =
      hn::MulAdd(all(texture.from_u.y), s, hn::MulAdd(all(texture.from_v.y), t, all(texture.shift.y)));
  return {texelsAt(texture.across, texture.nearest, x), texelsAt(texture.down, texture.nearest, y)};
}

void offsetsKernel(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v, LaneInts& upper,
                   LaneInts& lower) {
  const VI width = hn::Set(DI(), texture.across.size);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Corners at = cornersAt(texture, load(u, i), load(v, i));
    store(hn::Add(hn::Mul(at.down.first, width), at.across.first), upper, i);
    store(hn::Add(hn::Mul(at.down.second, width), at.across.first), lower, i);
  }
}

void textureKernel(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v,
                   LaneVectors& color) {
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const auto [across, down] = cornersAt(texture, load(u, i), load(v, i));
    V3 result = texelAt(texture, down.first, across.first);
    if (!texture.nearest) {
      result = mulAdd(sub(texelAt(texture, down.first, across.second), result), across.rest, result);
      V3 below = texelAt(texture, down.second, across.first);
      below = mulAdd(sub(texelAt(texture, down.second, across.second), below), across.rest, below);
      result = mulAdd(sub(below, result), down.rest, result);
    }
    store(result, color, i);
  }
}

// ---- Lobes and normals ----------------------------------------------------------------------------------------------

HWY_INLINE V luminance(const V3& c) {
  return hn::MulAdd(all(0.2126f), c.x, hn::MulAdd(all(0.7152f), c.y, hn::Mul(all(0.0722f), c.z)));
}

void makeKernel(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material) {
  const V one = all(1.0f);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const M here = maskOf(mask, i);
    if (hn::AllFalse(D(), here)) continue;
    const V3 given = mul(load(material.color, i), all(material.base_color));
    const V3 color{clampUnit(given.x), clampUnit(given.y), clampUnit(given.z)};
    const V metallic = clampUnit(hn::Mul(load(material.metallic_roughness.z, i), all(material.metallic)));
    const V roughness = clampUnit(hn::Mul(load(material.metallic_roughness.y, i), all(material.roughness)));
    const V3 diffuse = mul(color, hn::Sub(one, metallic));
    const V plain = all(0.04f * material.specular);
    const V3 specular{mix(plain, color.x, metallic), mix(plain, color.y, metallic),
                      mix(plain, color.z, metallic)};
    const V alpha = hn::Mul(roughness, roughness);
    const V n = hn::Sub(hn::Div(all(2.0f), hn::Max(hn::Mul(alpha, alpha), all(1e-12f))), all(2.0f));
    const V exponent = hn::Min(hn::Max(n, one), all(brdf::kMaxPhongExponent));
    const V of_specular = luminance(specular), sum = hn::Add(luminance(diffuse), of_specular);
    const V share = hn::IfThenElseZero(hn::Gt(sum, zero()), hn::Div(of_specular, sum));
    storeIn(here, diffuse, lanes.diffuse, i);
    storeIn(here, specular, lanes.specular, i);
    store(hn::IfThenElse(here, exponent, load(lanes.exponent, i)), lanes.exponent, i);
    store(hn::IfThenElse(here, share, load(lanes.specular_share, i)), lanes.specular_share, i);
  }
}

HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

void tiltKernel(PathLanes& lanes, std::uint32_t mask, const CornerLanes& corners, const TangentLanes& map) {
  const V one = all(1.0f), two = all(2.0f);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const M here = maskOf(mask, i);
    if (hn::AllFalse(D(), here)) continue;
    const V u = load(corners.u, i), v = load(corners.v, i), w = hn::Sub(hn::Sub(one, u), v);
    const V3 smooth = mulAdd(load(corners.normals[0], i), w,
                             mulAdd(load(corners.normals[1], i), u, mul(load(corners.normals[2], i), v)));
    const V3 seen = load(lanes.normal, i);
    const V side = hn::IfThenElse(hn::Lt(dot(smooth, seen), zero()), all(-1.0f), one);
    const V3 normal = mul(seen, side), given = load(map.tangent, i);
    const V3 along = mulAdd(normal, hn::Neg(dot(normal, given)), given);
    const V squared = dot(along, along);
    const V3 tangent = mul(along, hn::Div(one, hn::Sqrt(squared)));
    const V hand = hn::IfThenElse(hn::Lt(load(map.handedness, i), zero()), all(-1.0f), one);
    const V3 texel = load(map.texel, i);
    const V scale = all(map.scale), x = hn::Mul(hn::MulAdd(texel.x, two, all(-1.0f)), scale),
            y = hn::Mul(hn::MulAdd(texel.y, two, all(-1.0f)), hn::Mul(scale, hand));
    const V3 tilted = mulAdd(
        tangent, x, mulAdd(cross(normal, tangent), y, mul(normal, hn::MulAdd(texel.z, two, all(-1.0f)))));
    const V length = dot(tilted, tilted);
    const M valid = hn::And(hn::And(here, hn::Ge(squared, all(1e-12f))), hn::Gt(length, zero()));
    storeIn(valid, mul(tilted, hn::Div(side, hn::Sqrt(length))), lanes.normal, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::reference
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::reference {

HWY_EXPORT(textureKernel);
HWY_EXPORT(offsetsKernel);
HWY_EXPORT(makeKernel);
HWY_EXPORT(tiltKernel);

void readTexture(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v, LaneVectors& color) {
  HWY_DYNAMIC_DISPATCH(textureKernel)(texture, u, v, color);
}
void sendForTexture(const TextureTable& texture, const LaneFloats& u, const LaneFloats& v,
                    std::uint32_t mask) {
  LaneInts upper, lower;
  HWY_DYNAMIC_DISPATCH(offsetsKernel)(texture, u, v, upper, lower);
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    hwy::Prefetch(texture.texels + std::size_t(upper.at[i]) * 4);
    hwy::Prefetch(texture.texels + std::size_t(lower.at[i]) * 4);
  }
}
void setLobes(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material) {
  HWY_DYNAMIC_DISPATCH(makeKernel)(lanes, mask, material);
}
void tiltNormals(PathLanes& lanes, std::uint32_t mask, const CornerLanes& corners, const TangentLanes& map) {
  HWY_DYNAMIC_DISPATCH(tiltKernel)(lanes, mask, corners, map);
}

}  // namespace gloam::reference
#endif
