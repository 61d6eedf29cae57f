// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rows RF-5 and beyond with the host's vector units, a pixel a lane: twin of radiance_filter_shade and radiance_filter_beams, which tell the method.
// More than 300 lines: types of lanes are known within one instruction set's part of one file, and beams and lobes share all of them; a
// header of the halves would be compiled as often, and read by this file alone.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/radiance_filter/radiance_filter_shade_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
#include "frame/gbuffer_simd.h"
// clang-format on
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "math/sh_constants.h"
#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_shared.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::radiance_filter {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, HostShading::kBlock>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using Vector = frame::HWY_NAMESPACE::Vector3<V>;

constexpr float kPi = 3.14159265f, kSharpestBeam = 1e3f, kLargestHalf = 65504.0f;

HWY_INLINE V set(float value) {
  return hn::Set(D(), value);
}
HWY_INLINE V dot(const Vector& a, const Vector& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
HWY_INLINE Vector times(const Vector& a, V f) {
  return {a.x * f, a.y * f, a.z * f};
}
HWY_INLINE Vector plus(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE Vector choose(M mask, const Vector& a, const Vector& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}
/// 1 / v and 1 / sqrt(v) to the last bits, for v above 0: a guess and a step of Newton's, in a fraction of a division's time.
HWY_INLINE V inverse(V v) {
  const V guess = hn::ApproximateReciprocal(v);
  return guess * hn::NegMulAdd(guess, v, set(2.0f));
}
HWY_INLINE V inverseRoot(V v) {
  const V guess = hn::ApproximateReciprocalSqrt(v);
  return guess * hn::NegMulAdd(set(0.5f) * v * guess, guess, set(1.5f));
}
HWY_INLINE V root(V v) {
  return v * inverseRoot(hn::Max(v, set(1e-30f)));
}
HWY_INLINE Vector unit(const Vector& a) {
  return times(a, inverseRoot(hn::Max(dot(a, a), set(1e-30f))));
}
HWY_INLINE V clamped(V v, float low, float high) {
  return hn::Min(hn::Max(v, set(low)), set(high));
}

/// Nine coefficients of one colour.
using Bands = std::array<V, 9>;

HWY_INLINE V convolved(const Bands& light, const Vector& d, V zero, V one, V two) {
  const V first = hn::MulAdd(light[1], d.y, hn::MulAdd(light[2], d.z, light[3] * d.x)) * set(sh::kShNorm11);
  const V off = hn::MulAdd(light[4] * d.x, d.y, hn::MulAdd(light[5] * d.y, d.z, light[7] * d.x * d.z)) *
                set(sh::kShNorm21);
  const V on = light[6] * set(sh::kShNorm20) * hn::MulSub(set(3.0f) * d.z, d.z, set(1.0f)) +
               light[8] * set(sh::kShNorm22) * (d.x * d.x - d.y * d.y);
  return hn::MulAdd(zero * set(sh::kShNorm00), light[0], hn::MulAdd(one, first, two * (off + on)));
}

HWY_INLINE V bandOne(V s) {
  return (s + set(1.0f)) * inverse(s + set(2.0f));
}
HWY_INLINE V bandTwo(V s) {
  return s * inverse(s + set(3.0f));
}
HWY_INLINE V exponentOfBandOne(V b) {
  return hn::Max(hn::MulSub(set(2.0f), b, set(1.0f)), set(0.0f)) * inverse(set(1.0f) - b);
}
HWY_INLINE V exponentOfRatio(V r) {
  const V middle = hn::MulSub(set(2.0f), r, set(1.0f)), rest = set(1.0f) - r;
  return (middle + root(hn::MulAdd(middle, middle, set(3.0f) * r * rest))) * inverse(rest);
}

struct Symmetric {
  V xx, yy, zz, xy, xz, yz;
};
HWY_INLINE Vector times(const Symmetric& q, const Vector& v) {
  return {dot({q.xx, q.xy, q.xz}, v), dot({q.xy, q.yy, q.yz}, v), dot({q.xz, q.yz, q.zz}, v)};
}

/// Root of the mean square of the eigenvalues of a matrix without trace, times sqrt(1 / 2).
HWY_INLINE V sizeOf(const Symmetric& q) {
  const V on = hn::MulAdd(q.xx, q.xx, hn::MulAdd(q.yy, q.yy, q.zz * q.zz));
  const V off = hn::MulAdd(q.xy, q.xy, hn::MulAdd(q.xz, q.xz, q.yz * q.yz));
  return root(hn::MulAdd(set(2.0f), off, on) * set(1.0f / 6.0f));
}

/// Of a matrix of size 1.
HWY_INLINE V leastEigenvalue(const Symmetric& n) {
  const V determinant = dot({n.xx, n.xy, n.xz}, cross({n.xy, n.yy, n.yz}, {n.xz, n.yz, n.zz}));
  // cos(acos(x) / 3 + 2 pi / 3) is smooth in sqrt((1 - x) / 2): to 2e-7.
  const V x = clamped(set(0.5f) * determinant, -1.0f, 1.0f), t = root(hn::NegMulAdd(set(0.5f), x, set(0.5f)));
  V cosine = set(0.0021034910f);
  for (const float c :
       {-0.0105017536f, 0.0263997493f, -0.0514747633f, 0.1108054709f, -0.5773319021f, -0.5000001860f})
    cosine = hn::MulAdd(cosine, t, set(c));
  return cosine + cosine;
}

/// Of a matrix of size 1.
HWY_INLINE Vector eigenvectorOf(const Symmetric& n, V value) {
  const Vector r0{n.xx - value, n.xy, n.xz}, r1{n.xy, n.yy - value, n.yz}, r2{n.xz, n.yz, n.zz - value};
  const Vector a = cross(r0, r1), b = cross(r1, r2), c = cross(r2, r0);
  Vector best = choose(hn::Gt(dot(a, a), dot(b, b)), a, b);
  best = choose(hn::Gt(dot(best, best), dot(c, c)), best, c);
  return unit(best);
}

/// One colour on its way to beams. The steps are taken by all three colours in turn: each is a chain of operations that wait for one another,
/// and three of them run side by side.
struct Color {
  Bands light;
  V all, least, along, mean, uu, uw, ww;
  M are;
  Symmetric q;
  Vector v, across, u, w;
  // The beams.
  Vector direction[2];
  V strength[2], exponent;
};

/// q and its least eigenvalue, with its eigenvector.
HWY_INLINE void findPlane(Color& c) {
  const V one = set(2.0466534f), off = set(1.3729382f), on = set(0.7926655f);
  c.all = set(3.5449077f) * c.light[0];
  c.v = {one * c.light[3], one * c.light[1], one * c.light[2]};
  const V zz = on * c.light[6], xx_yy = off * c.light[8];
  c.q = {xx_yy - zz, hn::Neg(xx_yy) - zz, zz + zz, off * c.light[4], off * c.light[7], off * c.light[5]};
  const V size = sizeOf(c.q), shrink = inverse(hn::Max(size, set(1e-30f)));
  const Symmetric n{c.q.xx * shrink, c.q.yy * shrink, c.q.zz * shrink,
                    c.q.xy * shrink, c.q.xz * shrink, c.q.yz * shrink};
  const V value = leastEigenvalue(n);
  c.across = eigenvectorOf(n, value);
  c.least = size * value;
}

/// N in the plane, u along V.
HWY_INLINE void findEllipse(Color& c) {
  const Vector in_plane = plus(c.v, times(c.across, hn::Neg(dot(c.v, c.across))));
  const V along = root(dot(in_plane, in_plane));
  c.are = hn::And(hn::Lt(c.least, set(-1e-4f) * c.all), hn::Gt(along, set(1e-3f) * c.all));
  c.least = hn::IfThenElse(c.are, c.least, set(-1.0f));
  c.along = hn::IfThenElse(c.are, along, set(1.0f));
  c.u = times(in_plane, inverse(c.along));
  c.w = cross(c.across, c.u);
  const V scale = inverse(set(-3.0f) * c.least), less = hn::Neg(c.least);
  const Vector nu = times(plus(times(c.q, c.u), times(c.u, less)), scale),
               nw = times(plus(times(c.q, c.w), times(c.w, less)), scale);
  c.uu = dot(c.u, nu), c.uw = dot(c.u, nw), c.ww = dot(c.w, nw);
}

HWY_INLINE void findStrength(Color& c) {
  const V k = c.along * root(hn::Max(c.ww, set(1e-4f)) *
                             inverse(hn::Max(c.uu * c.ww - c.uw * c.uw, set(1e-4f) * c.uu)));
  const V to_k = inverse(k), ratio = clamped(set(-2.0f) * c.least * to_k, 0.0f, 0.9995f);
  const V s = hn::Min(exponentOfRatio(ratio), set(kSharpestBeam));
  c.strength[0] = hn::Min(k * (s + set(2.0f)) * inverse(s + set(1.0f)), c.all);
  c.mean = hn::Min(c.along * to_k, set(1.0f));
  c.exponent = hn::IfThenElseZero(c.are, s);
}

HWY_INLINE void findBeams(Color& c) {
  const M tilts = hn::Gt(c.ww, set(1e-5f));
  const V shorten = inverseRoot(hn::IfThenElse(tilts, hn::MulAdd(c.uw, c.uw, c.ww * c.ww), set(1.0f)));
  const V tx = hn::IfThenElseZero(tilts, c.uw * shorten),
          ty = hn::IfThenElse(tilts, c.ww * shorten, set(1.0f));
  const V middle = hn::Neg(c.mean) * tx;
  const V reach = root(hn::Max(hn::MulAdd(middle, middle, set(1.0f) - c.mean * c.mean), set(0.0f)));
  const M apart = hn::Gt(reach, set(1e-4f));
  const V lean = set(0.5f) * middle * inverse(hn::IfThenElse(apart, reach, set(1.0f)));
  const V share = hn::IfThenElse(apart, clamped(set(0.5f) - lean, 0.0f, 1.0f), set(0.5f));
  const Vector way = plus(times(c.u, tx), times(c.w, ty)), base = times(c.u, c.mean),
               none{set(0.0f), set(0.0f), set(1.0f)};
  c.direction[0] = choose(c.are, unit(plus(base, times(way, middle + reach))), none);
  c.direction[1] = choose(c.are, unit(plus(base, times(way, middle - reach))), none);
  const V strength = c.strength[0];
  c.strength[0] = hn::IfThenElseZero(c.are, share * strength);
  c.strength[1] = hn::IfThenElseZero(c.are, (set(1.0f) - share) * strength);
}

/// A Phong lobe, and as three bands show it.
struct Lobe {
  V one, shown_one, shown_two;
};

HWY_INLINE V glossBeyond(const Color& beams, const Lobe& phong, const Vector& mirror) {
  const D d;
  const V one = bandOne(beams.exponent), m = exponentOfBandOne(one * phong.one);
  const V first = set(3.0f) * one * phong.shown_one,
          second = set(2.5f) * bandTwo(beams.exponent) * phong.shown_two;
  V sum = set(0.0f);
  for (int i = 0; i < 2; ++i) {
    const V c = dot(mirror, beams.direction[i]);
    const V bands =
        hn::MulAdd(second, hn::MulSub(set(3.0f) * c, c, set(1.0f)), hn::MulAdd(first, c, set(1.0f)));
    const V power = hn::Exp(d, m * hn::Log(d, hn::Max(c, set(1e-30f))));
    const V lobe = hn::IfThenElseZero(hn::Gt(c, set(0.0f)), (m + set(1.0f)) * set(0.5f / kPi) * power);
    sum = hn::MulAdd(beams.strength[i], hn::NegMulAdd(set(0.25f / kPi), bands, lobe), sum);
  }
  const V t = clamped(m, 0.0f, 1.0f);
  return t * t * hn::NegMulAdd(set(2.0f), t, set(3.0f)) * sum;
}

HWY_INLINE V irradianceBeyond(const Color& beams, const Vector& normal) {
  const V s = beams.exponent, b4 = bandTwo(s) * (s - set(2.0f)) * inverse(s + set(5.0f)),
          b6 = b4 * (s - set(4.0f)) * inverse(s + set(7.0f));
  const V by4 = set(9.0f / 96.0f) * hn::Max(b4, set(0.0f)),
          by6 = set(13.0f / 256.0f) * hn::Max(b6, set(0.0f));
  V sum = set(0.0f);
  for (int i = 0; i < 2; ++i) {
    const V c = dot(normal, beams.direction[i]), x = c * c;
    const V p4 = hn::MulAdd(hn::MulSub(set(35.0f), x, set(30.0f)), x, set(3.0f)) * set(1.0f / 8.0f);
    const V p6 =
        hn::MulSub(hn::MulAdd(hn::MulSub(set(231.0f), x, set(315.0f)), x, set(105.0f)), x, set(5.0f)) *
        set(1.0f / 16.0f);
    sum = hn::MulAdd(beams.strength[i], by6 * p6 - by4 * p4, sum);
  }
  return sum;
}

/// What a block of pixels is shaded from: halves, four a pixel.
struct Block {
  const std::uint16_t* layers[kFieldLayers];
  const std::uint16_t* diffuse;
  const std::uint32_t* normals;  ///< two words a pixel
  std::size_t surface;           ///< place in the planes
};

HWY_INLINE void readFour(const std::uint16_t* from, V* to) {
  const D d;
  const hn::Rebind<hwy::float16_t, D> dh;
  const hn::Rebind<std::uint16_t, D> du;
  hn::Vec<decltype(du)> x, y, z, w;
  hn::LoadInterleaved4(du, from, x, y, z, w);
  to[0] = hn::PromoteTo(d, hn::BitCast(dh, x)), to[1] = hn::PromoteTo(d, hn::BitCast(dh, y));
  to[2] = hn::PromoteTo(d, hn::BitCast(dh, z)), to[3] = hn::PromoteTo(d, hn::BitCast(dh, w));
}

HWY_INLINE hn::Vec<hn::Rebind<std::uint16_t, D>> halvesOf(V v) {
  const hn::Rebind<hwy::float16_t, D> dh;
  const hn::Rebind<std::uint16_t, D> du;
  return hn::BitCast(du, hn::DemoteTo(dh, clamped(v, 0.0f, kLargestHalf)));
}
HWY_INLINE void writeColor(const V* rgb, std::uint16_t* to) {
  const hn::Rebind<std::uint16_t, D> du;
  hn::StoreInterleaved4(halvesOf(rgb[0]), halvesOf(rgb[1]), halvesOf(rgb[2]), halvesOf(set(1.0f)), du, to);
}

HWY_INLINE void shadeBlock(const HostSurfaces& s, const HostShading& shading, const Block& block,
                           std::uint16_t* irradiance, std::uint16_t* gloss) {
  const D d;
  V values[4 * kFieldLayers], diffuse[4];
  readFour(block.layers[kFieldLayers - 1], values + 4 * (kFieldLayers - 1));
  if (hn::AllFalse(d, hn::Gt(values[4 * kFieldLayers - 1], set(0.0f)))) {
    const V none[3] = {set(0.0f), set(0.0f), set(0.0f)};
    writeColor(none, irradiance);
    writeColor(none, gloss);
    return;
  }
  for (int l = 0; l + 1 < kFieldLayers; ++l) readFour(block.layers[l], values + 4 * l);
  readFour(block.diffuse, diffuse);
  const V weight = values[4 * kFieldLayers - 1];
  const M lit = hn::Gt(weight, set(0.0f));
  const V scale =
      hn::IfThenElseZero(lit, set(1.0f / shading.exposure) * inverse(hn::IfThenElse(lit, weight, set(1.0f))));

  const Vector position{hn::LoadU(d, &s.x[block.surface]), hn::LoadU(d, &s.y[block.surface]),
                        hn::LoadU(d, &s.z[block.surface])};
  Vector normal;
  frame::HWY_NAMESPACE::readNormals(d, block.normals, &normal, nullptr);
  const Vector between{set(shading.eye.x) - position.x, set(shading.eye.y) - position.y,
                       set(shading.eye.z) - position.z};
  const Vector to_eye =
      shading.perspective ? unit(between)
                          : Vector{set(-shading.forward.x), set(-shading.forward.y), set(-shading.forward.z)};
  const V twice = set(2.0f) * dot(normal, to_eye);
  const Vector mirror{hn::MulSub(twice, normal.x, to_eye.x), hn::MulSub(twice, normal.y, to_eye.y),
                      hn::MulSub(twice, normal.z, to_eye.z)};
  const V alpha = diffuse[3] * diffuse[3], alpha2 = hn::Max(alpha * alpha, set(1e-12f));
  const V exponent = clamped(hn::MulSub(set(2.0f), inverse(alpha2), set(2.0f)), 1.0f, 1e6f),
          shown = hn::Min(exponent, set(kSharpestLobe));
  const Lobe phong{bandOne(exponent), bandOne(shown), bandTwo(shown)};

  V to_diffuse[3], to_gloss[3];
  Color colors[3];
  for (int c = 0; c < 3; ++c) {
    Bands& light = colors[c].light;
    for (int i = 0; i < 9; ++i) light[std::size_t(i)] = values[3 * i + c] * scale;
    to_diffuse[c] = convolved(light, normal, set(kPi), set(kPi * 2.0f / 3.0f), set(kPi * 0.25f));
    to_gloss[c] = convolved(light, mirror, set(1.0f), phong.shown_one, phong.shown_two);
  }
  if (shading.beams) {
    for (Color& color : colors) findPlane(color);
    for (Color& color : colors) findEllipse(color);
    for (Color& color : colors) findStrength(color);
    for (Color& color : colors) findBeams(color);
    for (int c = 0; c < 3; ++c) to_diffuse[c] = to_diffuse[c] + irradianceBeyond(colors[c], normal);
    for (int c = 0; c < 3; ++c) to_gloss[c] = to_gloss[c] + glossBeyond(colors[c], phong, mirror);
  }
  writeColor(to_diffuse, irradiance);
  writeColor(to_gloss, gloss);
}

void ShadeRow(const HostSurfaces& s, const HostShading& shading, int y, int from, int to_column) {
  const auto lanes = std::size_t(hn::Lanes(D())), width = std::size_t(s.width), end = std::size_t(to_column);
  const std::size_t row = std::size_t(y) * width;
  for (auto x = std::size_t(from); x < end; x += lanes) {
    const std::size_t pixel = row + x, count = std::min(lanes, end - x);
    Block block;
    for (std::size_t l = 0; l < kFieldLayers; ++l)
      block.layers[l] = shading.values.data() + 4 * (l * width * std::size_t(s.height) + pixel);
    block.diffuse = shading.diffuse.data() + 4 * pixel;
    block.normals = &shading.normals[pixel].x;
    block.surface = s.at(int(x), y);
    if (count == lanes) {
      shadeBlock(s, shading, block, shading.irradiance.data() + 4 * pixel, shading.gloss.data() + 4 * pixel);
      continue;
    }
    // The row's end, with pixels of nothing after it.
    constexpr std::size_t kHalves = 4 * HostShading::kBlock;
    std::uint16_t ends[kFieldLayers + 1][kHalves] = {}, to[2][kHalves];
    std::uint32_t normals[2 * HostShading::kBlock] = {};
    for (std::size_t l = 0; l < kFieldLayers; ++l) {
      std::copy_n(block.layers[l], 4 * count, ends[l]);
      block.layers[l] = ends[l];
    }
    std::copy_n(block.diffuse, 4 * count, ends[kFieldLayers]);
    std::copy_n(block.normals, 2 * count, normals);
    block.diffuse = ends[kFieldLayers], block.normals = normals;
    shadeBlock(s, shading, block, to[0], to[1]);
    std::copy_n(to[0], 4 * count, shading.irradiance.data() + 4 * pixel);
    std::copy_n(to[1], 4 * count, shading.gloss.data() + 4 * pixel);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::radiance_filter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::radiance_filter {

HWY_EXPORT(ShadeRow);

void shadeRow(const HostSurfaces& surfaces, const HostShading& shading, int row, int from, int to) {
  HWY_DYNAMIC_DISPATCH(ShadeRow)(surfaces, shading, row, from, to);
}

}  // namespace gloam::radiance_filter
#endif
