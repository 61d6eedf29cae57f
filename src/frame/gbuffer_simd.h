// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gbuffer.glsl with the host's vector units. Highway includes this file once an instruction set; include <hwy/highway.h> first.
#if defined(GLOAM_FRAME_GBUFFER_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOAM_FRAME_GBUFFER_SIMD_H
#undef GLOAM_FRAME_GBUFFER_SIMD_H
#else
#define GLOAM_FRAME_GBUFFER_SIMD_H
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace gloam::frame {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector3 {
  V x, y, z;
};

/// octahedralDirection of two 16-bit numbers in a word.
template <class D>
HWY_INLINE Vector3<hn::Vec<D>> unpackNormal(D d, hn::Vec<hn::RebindToUnsigned<D>> words) {
  using V = hn::Vec<D>;
  const hn::RebindToSigned<D> di;
  const auto scale = hn::Set(d, 1.0f / 32767.0f), one = hn::Set(d, 1.0f), least = hn::Set(d, -1.0f);
  const auto bits = hn::BitCast(di, words);
  const V x = hn::Max(hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(bits))), scale), least);
  const V y = hn::Max(hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(bits)), scale), least);
  const V z = hn::Sub(hn::Sub(one, hn::Abs(x)), hn::Abs(y));
  // Below the equator both move inward by what z is below zero, which is the other way to write the fold.
  const V fold = hn::Max(hn::Neg(z), hn::Zero(d));
  const V fx = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Add(x, fold), hn::Sub(x, fold));
  const V fy = hn::IfThenElse(hn::Lt(y, hn::Zero(d)), hn::Add(y, fold), hn::Sub(y, fold));
  const V squared = hn::MulAdd(fx, fx, hn::MulAdd(fy, fy, hn::Mul(z, z)));
  const V scale_to_unit = hn::Div(one, hn::Sqrt(squared));
  return {hn::Mul(fx, scale_to_unit), hn::Mul(fy, scale_to_unit), hn::Mul(z, scale_to_unit)};
}

/// frame.normals of as many pixels as there are lanes: (shading, geometric) from `words`.
template <class D>
HWY_INLINE void readNormals(D d, const std::uint32_t* words, Vector3<hn::Vec<D>>* shading,
                            Vector3<hn::Vec<D>>* geometric) {
  const hn::RebindToUnsigned<D> du;
  hn::Vec<decltype(du)> first, second;
  hn::LoadInterleaved2(du, words, first, second);
  *shading = unpackNormal(d, first);
  if (geometric) *geometric = unpackNormal(d, second);
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::frame
HWY_AFTER_NAMESPACE();

#endif
