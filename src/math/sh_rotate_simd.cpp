// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-3 for batches, one item a lane: the rotation of sh_rotate.cpp with J unrolled to its non-zeros, a quarter of all.
// A last, partial vector is computed again together with the items before it.
#include "math/simd_targets.h"
// clang-format off: Highway compiles this file once an instruction set
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/sh_rotate_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <algorithm>
#include <array>
#include <utility>

#include "math/sh_batch.h"
#include "math/sh_check.h"
#include "math/sh_tables.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::sh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<D>;

/// Cosine and sine of the multiples 1 … 5 of an angle.
struct Multiples {
  V cosine[kMaxOrder], sine[kMaxOrder];
};
struct Angles {
  Multiples gamma, beta, alpha;
  V odd_band_sign;
};

/// Sets (cosine, sine) / length, or (1, 0) where both are 0, and its multiples.
template <int kOrder>
HWY_INLINE void setMultiples(D d, V cosine, V sine, Multiples& out) {
  const V length2 = hn::MulAdd(cosine, cosine, hn::Mul(sine, sine));
  const auto nothing = hn::Lt(length2, hn::Set(d, 1e-30f));
  const V scale = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::IfThenElse(nothing, hn::Set(d, 1.0f), length2)));
  const V c = hn::IfThenElse(nothing, hn::Set(d, 1.0f), hn::Mul(cosine, scale));
  const V s = hn::IfThenElse(nothing, hn::Zero(d), hn::Mul(sine, scale));
  out.cosine[1] = c;
  out.sine[1] = s;
  for (int m = 2; m < kOrder; ++m) {
    out.cosine[m] = hn::NegMulAdd(out.sine[m - 1], s, hn::Mul(out.cosine[m - 1], c));
    out.sine[m] = hn::MulAdd(out.cosine[m - 1], s, hn::Mul(out.sine[m - 1], c));
  }
}

/// Euler angles of the matrices [entry 3 column + row][lane] (sh_rotate.cpp says why in this way).
template <int kOrder>
HWY_INLINE void setAngles(D d, const float* HWY_RESTRICT matrices, Angles& angles) {
  V m[9];
  for (int i = 0; i < 9; ++i) m[i] = hn::Load(d, matrices + static_cast<std::size_t>(i) * kMaxLanes);
  const V cross0 = hn::MulSub(m[4], m[8], hn::Mul(m[5], m[7]));
  const V cross1 = hn::MulSub(m[5], m[6], hn::Mul(m[3], m[8]));
  const V cross2 = hn::MulSub(m[3], m[7], hn::Mul(m[4], m[6]));
  const V determinant = hn::MulAdd(m[0], cross0, hn::MulAdd(m[1], cross1, hn::Mul(m[2], cross2)));
  const V sign = hn::CopySignToAbs(hn::Set(d, 1.0f), determinant);
  angles.odd_band_sign = sign;
  for (V& entry : m) entry = hn::Mul(entry, sign);
  setMultiples<kOrder>(d, m[6], m[7], angles.alpha);
  const V ca = angles.alpha.cosine[1], sa = angles.alpha.sine[1];
  setMultiples<kOrder>(d, m[8], hn::MulAdd(ca, m[6], hn::Mul(sa, m[7])), angles.beta);
  setMultiples<kOrder>(d, hn::MulSub(ca, m[4], hn::Mul(sa, m[3])), hn::MulSub(ca, m[1], hn::Mul(sa, m[0])),
                       angles.gamma);
}

HWY_INLINE void setMultiples(D d, const Rotation& rotation, std::size_t angle, Multiples& out) {
  for (std::size_t m = 1; m < kMaxOrder; ++m) {
    out.cosine[m] = hn::Set(d, rotation.cosine[angle][m]);
    out.sine[m] = hn::Set(d, rotation.sine[angle][m]);
  }
}

template <int kBand>
HWY_INLINE void turnAboutZ(const Multiples& angle, V* band) {
  for (int m = 1; m <= kBand; ++m) {
    const V plus = band[kBand + m], minus = band[kBand - m];
    band[kBand + m] = hn::NegMulAdd(minus, angle.sine[m], hn::Mul(plus, angle.cosine[m]));
    band[kBand - m] = hn::MulAdd(plus, angle.sine[m], hn::Mul(minus, angle.cosine[m]));
  }
}
template <int kBand>
HWY_INLINE void turnBackAboutZ(const Multiples& angle, V* band) {
  for (int m = 1; m <= kBand; ++m) {
    const V plus = band[kBand + m], minus = band[kBand - m];
    band[kBand + m] = hn::MulAdd(minus, angle.sine[m], hn::Mul(plus, angle.cosine[m]));
    band[kBand - m] = hn::NegMulAdd(plus, angle.sine[m], hn::Mul(minus, angle.cosine[m]));
  }
}

/// One entry of J, skipped where it is 0.
template <int kBand, std::size_t kRow, std::size_t kColumn>
HWY_INLINE V addEntry(D d, V sum, const V* band) {
  constexpr float kEntry = tables::kExchange[kBand][kRow][kColumn];
  if constexpr (kEntry == 0.0f) {
    return sum;
  } else if constexpr (kEntry == 1.0f) {
    return hn::Add(sum, band[kColumn]);
  } else {
    return hn::MulAdd(hn::Set(d, kEntry), band[kColumn], sum);
  }
}
template <int kBand, std::size_t kRow, std::size_t... kColumns>
HWY_INLINE V exchangeRow(D d, const V* band, std::index_sequence<kColumns...>) {
  V sum = hn::Zero(d);
  ((sum = addEntry<kBand, kRow, kColumns>(d, sum, band)), ...);
  return sum;
}
template <int kBand, std::size_t... kRows>
HWY_INLINE void exchange(D d, V* band, std::index_sequence<kRows...> all) {
  const V result[] = {exchangeRow<kBand, kRows>(d, band, all)...};
  ((band[kRows] = result[kRows]), ...);
}

template <int kBand>
HWY_INLINE void rotateBand(D d, const Angles& angles, const float* HWY_RESTRICT in, float* HWY_RESTRICT out,
                           std::size_t stride) {
  constexpr int kSize = 2 * kBand + 1;
  constexpr auto kAll = std::make_index_sequence<kSize>();
  V band[kSize];
  for (int i = 0; i < kSize; ++i)
    band[i] = hn::LoadU(d, in + static_cast<std::size_t>(kBand * kBand + i) * stride);
  turnAboutZ<kBand>(angles.gamma, band);
  exchange<kBand>(d, band, kAll);
  turnBackAboutZ<kBand>(angles.beta, band);
  exchange<kBand>(d, band, kAll);
  turnAboutZ<kBand>(angles.alpha, band);
  for (int i = 0; i < kSize; ++i) {
    const V value = kBand % 2 != 0 ? hn::Mul(band[i], angles.odd_band_sign) : band[i];
    hn::StoreU(value, d, out + static_cast<std::size_t>(kBand * kBand + i) * stride);
  }
}

template <int kOrder>
HWY_INLINE void rotateVector(D d, const Angles& angles, const float* HWY_RESTRICT in, float* HWY_RESTRICT out,
                             std::size_t stride) {
  hn::StoreU(hn::LoadU(d, in), d, out);
  if constexpr (kOrder > 1) rotateBand<1>(d, angles, in, out, stride);
  if constexpr (kOrder > 2) rotateBand<2>(d, angles, in, out, stride);
  if constexpr (kOrder > 3) rotateBand<3>(d, angles, in, out, stride);
  if constexpr (kOrder > 4) rotateBand<4>(d, angles, in, out, stride);
  if constexpr (kOrder > 5) rotateBand<5>(d, angles, in, out, stride);
}

template <int kOrder>
HWY_INLINE void rotateEach(const glm::mat3* HWY_RESTRICT matrices, std::size_t count,
                           const float* HWY_RESTRICT in, float* HWY_RESTRICT out, std::size_t stride) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float entries[9 * kMaxLanes];
  for (std::size_t i = 0; i < count; i += lanes) {
    const std::size_t k = std::min(i, count - lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float* entry = &matrices[k + lane][0][0];
      for (std::size_t e = 0; e < 9; ++e) entries[e * kMaxLanes + lane] = entry[e];
    }
    Angles angles;
    setAngles<kOrder>(d, entries, angles);
    rotateVector<kOrder>(d, angles, in + k, out + k, stride);
  }
}

template <int kOrder>
HWY_INLINE void rotateAll(const Rotation& rotation, std::size_t count, const float* HWY_RESTRICT in,
                          float* HWY_RESTRICT out, std::size_t stride) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  Angles angles;
  setMultiples(d, rotation, 0, angles.gamma);
  setMultiples(d, rotation, 1, angles.beta);
  setMultiples(d, rotation, 2, angles.alpha);
  angles.odd_band_sign = hn::Set(d, rotation.odd_band_sign);
  for (std::size_t i = 0; i < count; i += lanes) {
    const std::size_t k = std::min(i, count - lanes);
    rotateVector<kOrder>(d, angles, in + k, out + k, stride);
  }
}

/// At least a vector full of items.
void rotateEachKernel(int order, const glm::mat3* matrices, std::size_t count, const float* in, float* out,
                      std::size_t stride) {
  switch (order) {
    case 1:
      rotateEach<1>(matrices, count, in, out, stride);
      break;
    case 2:
      rotateEach<2>(matrices, count, in, out, stride);
      break;
    case 3:
      rotateEach<3>(matrices, count, in, out, stride);
      break;
    case 4:
      rotateEach<4>(matrices, count, in, out, stride);
      break;
    case 5:
      rotateEach<5>(matrices, count, in, out, stride);
      break;
    default:
      rotateEach<6>(matrices, count, in, out, stride);
      break;
  }
}

void rotateAllKernel(const Rotation& rotation, std::size_t count, const float* in, float* out,
                     std::size_t stride) {
  switch (rotation.order) {
    case 1:
      rotateAll<1>(rotation, count, in, out, stride);
      break;
    case 2:
      rotateAll<2>(rotation, count, in, out, stride);
      break;
    case 3:
      rotateAll<3>(rotation, count, in, out, stride);
      break;
    case 4:
      rotateAll<4>(rotation, count, in, out, stride);
      break;
    case 5:
      rotateAll<5>(rotation, count, in, out, stride);
      break;
    default:
      rotateAll<6>(rotation, count, in, out, stride);
      break;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::sh {

HWY_EXPORT(rotateEachKernel);
HWY_EXPORT(rotateAllKernel);

void rotateMany(int order, std::span<const glm::mat3> matrices, std::span<const float> in,
                std::span<float> out, std::size_t stride) {
  checkOrder(order);
  const std::size_t count = matrices.size();
  const int planes = coefficientCount(order);
  checkPlanes("rotateMany: in", in.size(), planes, count, stride);
  checkPlanes("rotateMany: out", out.size(), planes, count, stride);
  if (count >= kMaxLanes) {
    HWY_DYNAMIC_DISPATCH(rotateEachKernel)(order, matrices.data(), count, in.data(), out.data(), stride);
  } else if (count > 0) {
    std::array<glm::mat3, kMaxLanes> padded_matrices;
    padded_matrices.fill(glm::mat3(1.0f));
    std::copy(matrices.begin(), matrices.end(), padded_matrices.begin());
    PaddedPlanes padded(in, planes, count, stride);
    HWY_DYNAMIC_DISPATCH(rotateEachKernel)
    (order, padded_matrices.data(), kMaxLanes, padded.in.data(), padded.out.data(), kMaxLanes);
    padded.copyOut(out, planes, count, stride);
  }
}

void rotateMany(const Rotation& rotation, std::size_t count, std::span<const float> in, std::span<float> out,
                std::size_t stride) {
  checkOrder(rotation.order);
  const int planes = coefficientCount(rotation.order);
  checkPlanes("rotateMany: in", in.size(), planes, count, stride);
  checkPlanes("rotateMany: out", out.size(), planes, count, stride);
  if (count >= kMaxLanes) {
    HWY_DYNAMIC_DISPATCH(rotateAllKernel)(rotation, count, in.data(), out.data(), stride);
  } else if (count > 0) {
    PaddedPlanes padded(in, planes, count, stride);
    HWY_DYNAMIC_DISPATCH(rotateAllKernel)
    (rotation, kMaxLanes, padded.in.data(), padded.out.data(), kMaxLanes);
    padded.copyOut(out, planes, count, stride);
  }
}

}  // namespace gloam::sh
#endif
