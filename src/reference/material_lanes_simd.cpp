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
// clang-format on
#include <cstring>

#include "math/brdf.h"
#include "reference/lanes_simd.h"
#include "reference/material_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::reference {
namespace HWY_NAMESPACE {

HWY_INLINE void storeIn(M mask, const V3& v, LaneVectors& to, std::size_t i) {
  store(choose(mask, v, load(to, i)), to, i);
}

// ---- Textures -------------------------------------------------------------------------------------------------------

struct Texels {
  VI first, second;
  V rest;  // how far from the first to the second
};
// Which lanes wrap how.
struct Wraps {
  M clamped, mirrored;
  bool any;  // of the two
};
HWY_INLINE Wraps wrapsOf(V wrap) {
  const M clamped = hn::Eq(wrap, all(float(Wrap::kClampToEdge))),
          mirrored = hn::Eq(wrap, all(float(Wrap::kMirroredRepeat)));
  return {clamped, mirrored, !hn::AllFalse(D(), hn::Or(clamped, mirrored))};
}

HWY_INLINE VI wrapped(VI texel, const Wraps& wraps, VI size) {
  const DI di;
  const VI none = hn::Zero(di), last = hn::Sub(size, hn::Set(di, 1));
  VI period = size;
  if (wraps.any) period = hn::IfThenElse(hn::RebindMask(di, wraps.mirrored), hn::Add(size, size), size);
  VI in_period = hn::Add(texel, hn::IfThenElseZero(hn::Lt(texel, none), period));
  in_period =
      hn::Sub(in_period, hn::IfThenElseZero(hn::Gt(in_period, hn::Sub(period, hn::Set(di, 1))), period));
  if (!wraps.any) return in_period;
  // Only those that are mirrored reach the second half of a period.
  in_period = hn::Min(in_period, hn::Sub(hn::Add(last, size), in_period));
  return hn::IfThenElse(hn::RebindMask(di, wraps.clamped), hn::Min(hn::Max(texel, none), last), in_period);
}

HWY_INLINE Texels texelsAt(V given, V size, V wrap, V nearest) {
  const Wraps wraps = wrapsOf(wrap);
  const V coordinate = hn::IfThenElseZero(hn::Lt(hn::Abs(given), all(0x1p30f)), given);
  V in_period = hn::Sub(coordinate, hn::Floor(coordinate));
  if (wraps.any) {
    const V mirrored = hn::NegMulAdd(all(2.0f), hn::Floor(hn::Mul(coordinate, all(0.5f))), coordinate);
    in_period = hn::IfThenElse(wraps.mirrored, mirrored, in_period);
    in_period = hn::IfThenElse(wraps.clamped, hn::Min(hn::Max(coordinate, all(-1.0f)), all(2.0f)), in_period);
  }
  const V place = hn::MulAdd(in_period, size, hn::MulSub(all(0.5f), nearest, all(0.5f)));
  const V before = hn::Floor(place);
  const VI first = toInt(before), texels = toInt(size);
  return {wrapped(first, wraps, texels), wrapped(hn::Add(first, hn::Set(DI(), 1)), wraps, texels),
          hn::Mul(hn::Sub(place, before), hn::Sub(all(1.0f), nearest))};
}

void findKernel(const TextureLanes& textures, std::uint32_t mask, const LaneFloats& u, const LaneFloats& v,
                TexelLanes& texels) {
  const hn::CappedTag<float, 4> four;
  LaneRows rows[3];
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const float* from = textures[i]->placement.across_from_uv;
    for (std::size_t k = 0; k < 4; k += hn::Lanes(four)) {
      hn::StoreU(hn::LoadU(four, from + k), four, rows[0].at[i] + k);
      hn::StoreU(hn::LoadU(four, from + 4 + k), four, rows[1].at[i] + k);
      hn::StoreU(hn::LoadU(four, from + 8 + k), four, rows[2].at[i] + k);
    }
  }
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const Columns x = columns(rows[0].at, i), y = columns(rows[1].at, i), how = columns(rows[2].at, i);
    const V s = load(u, i), t = load(v, i);
    const Texels across = texelsAt(hn::MulAdd(x.a, s, hn::MulAdd(x.b, t, x.c)), x.d, how.a, how.c),
                 down = texelsAt(hn::MulAdd(y.a, s, hn::MulAdd(y.b, t, y.c)), y.d, how.b, how.c);
    const VI width = toInt(x.d), upper = hn::Mul(down.first, width), lower = hn::Mul(down.second, width);
    store(hn::Add(upper, across.first), texels.corners[0], i);
    store(hn::Add(upper, across.second), texels.corners[1], i);
    store(hn::Add(lower, across.first), texels.corners[2], i);
    store(hn::Add(lower, across.second), texels.corners[3], i);
    store(across.rest, texels.across, i);
    store(down.rest, texels.down, i);
  }
}

template <int kShift>
HWY_INLINE V channel(const float* linear, VU texel) {
  const VI byte = hn::BitCast(DI(), hn::And(hn::ShiftRight<kShift>(texel), allBits(0xffu)));
  return linear ? hn::GatherIndex(D(), linear, byte) : hn::Mul(toFloat(byte), all(1.0f / 255.0f));
}
HWY_INLINE V3 decoded(const float* linear, VU texel) {
  return {channel<0>(linear, texel), channel<8>(linear, texel), channel<16>(linear, texel)};
}

void textureKernel(const TextureLanes& textures, std::uint32_t mask, const TexelLanes& texels, bool srgb,
                   LaneVectors& color) {
  LaneBits corners[4];
  const float* linear = nullptr;
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    if (srgb) linear = textures[i]->linear;  // one table for all
    for (int c = 0; c < 4; ++c)
      std::memcpy(&corners[c].at[i], textures[i]->texels + std::size_t(texels.corners[c].at[i]) * 4, 4);
  }
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const M here = maskOf(mask, i);
    V3 upper = decoded(linear, load(corners[0], i)), lower = decoded(linear, load(corners[2], i));
    const V across = load(texels.across, i), one = all(1.0f);
    upper = mulAdd(sub(decoded(linear, load(corners[1], i)), upper), across, upper);
    lower = mulAdd(sub(decoded(linear, load(corners[3], i)), lower), across, lower);
    store(choose(here, mulAdd(sub(lower, upper), load(texels.down, i), upper), V3{one, one, one}), color, i);
  }
}

// ---- Lobes and normals ----------------------------------------------------------------------------------------------

HWY_INLINE V luminance(const V3& c) {
  return hn::MulAdd(all(0.2126f), c.x, hn::MulAdd(all(0.7152f), c.y, hn::Mul(all(0.0722f), c.z)));
}

// Two rows of four.
void gatherFactors(const MaterialFactors* const* factors, std::uint32_t mask, LaneRows& low, LaneRows& high) {
  const hn::CappedTag<float, 4> four;
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const float* from = &factors[i]->base_color.x;
    for (std::size_t k = 0; k < 4; k += hn::Lanes(four)) {
      hn::StoreU(hn::LoadU(four, from + k), four, low.at[i] + k);
      hn::StoreU(hn::LoadU(four, from + 4 + k), four, high.at[i] + k);
    }
  }
}

void makeKernel(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material) {
  const V one = all(1.0f);
  LaneRows low, high;
  gatherFactors(material.factors, mask, low, high);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const M here = maskOf(mask, i);
    if (hn::AllFalse(D(), here)) continue;
    const Columns base = columns(low.at, i), rest = columns(high.at, i);
    const V3 given = mul(load(material.color, i), V3{base.a, base.b, base.c});
    const V3 color{clampUnit(given.x), clampUnit(given.y), clampUnit(given.z)};
    const V metallic = clampUnit(hn::Mul(load(material.metallic_roughness.z, i), base.d));
    const V roughness = clampUnit(hn::Mul(load(material.metallic_roughness.y, i), rest.a));
    const V3 diffuse = mul(color, hn::Sub(one, metallic));
    const V plain = hn::Mul(all(0.04f), rest.b);
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

void gatherTangents(const TangentLanes& map, std::uint32_t mask, LaneRows& tangents, LaneFloats& scales) {
  const hn::CappedTag<float, 4> four;
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
    const float *p = &map.corners[i][0]->x, *q = &map.corners[i][1]->x, *r = &map.corners[i][2]->x;
    const float u = map.u.at[i], v = map.v.at[i];
    scales.at[i] = map.factors[i]->normal_scale;
    for (std::size_t k = 0; k < 4; k += hn::Lanes(four)) {
      const auto rest_of_them = hn::MulAdd(hn::LoadU(four, q + k), hn::Set(four, u),
                                           hn::Mul(hn::LoadU(four, r + k), hn::Set(four, v)));
      hn::StoreU(hn::MulAdd(hn::LoadU(four, p + k), hn::Set(four, 1.0f - u - v), rest_of_them), four,
                 tangents.at[i] + k);
    }
  }
}

void tiltKernel(PathLanes& lanes, std::uint32_t mask, const TangentLanes& map) {
  const V one = all(1.0f), two = all(2.0f);
  LaneRows tangents;
  LaneFloats scales = {};
  gatherTangents(map, mask, tangents, scales);
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(D())) {
    const M here = maskOf(mask, i);
    if (hn::AllFalse(D(), here)) continue;
    const Columns from = columns(tangents.at, i);
    const V side = load(map.side, i);
    const V3 normal = mul(load(lanes.normal, i), side), given{from.a, from.b, from.c};
    const V3 along = mulAdd(normal, hn::Neg(dot(normal, given)), given);
    const V squared = dot(along, along);
    const V3 tangent = mul(along, hn::Div(one, hn::Sqrt(squared)));
    const V hand = hn::IfThenElse(hn::Lt(from.d, zero()), all(-1.0f), one);
    const V3 texel = load(map.texel, i);
    const V scale = load(scales, i), x = hn::Mul(hn::MulAdd(texel.x, two, all(-1.0f)), scale),
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

HWY_EXPORT(findKernel);
HWY_EXPORT(textureKernel);
HWY_EXPORT(makeKernel);
HWY_EXPORT(tiltKernel);

void findTexels(const TextureLanes& textures, std::uint32_t mask, const LaneFloats& u, const LaneFloats& v,
                TexelLanes& texels) {
  HWY_DYNAMIC_DISPATCH(findKernel)(textures, mask, u, v, texels);
}
void readTexels(const TextureLanes& textures, std::uint32_t mask, const TexelLanes& texels, bool srgb,
                LaneVectors& color) {
  HWY_DYNAMIC_DISPATCH(textureKernel)(textures, mask, texels, srgb, color);
}
void setLobes(PathLanes& lanes, std::uint32_t mask, const MaterialLanes& material) {
  HWY_DYNAMIC_DISPATCH(makeKernel)(lanes, mask, material);
}
void tiltNormals(PathLanes& lanes, std::uint32_t mask, const TangentLanes& map) {
  HWY_DYNAMIC_DISPATCH(tiltKernel)(lanes, mask, map);
}

}  // namespace gloam::reference
#endif
