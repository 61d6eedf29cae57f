// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// isSameSurface of radiance_filter_window.glsl with the host's vector units. Highway includes this file once an instruction set; include
// <hwy/highway.h> first.
#if defined(GLOAM_RADIANCE_FILTER_SURFACE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOAM_RADIANCE_FILTER_SURFACE_SIMD_H
#undef GLOAM_RADIANCE_FILTER_SURFACE_SIMD_H
#else
#define GLOAM_RADIANCE_FILTER_SURFACE_SIMD_H
#endif

#include <hwy/highway.h>

#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_shared.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::radiance_filter {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What others are held against: a pixel a lane, in the middle of its window.
struct Middle {
  using D = hn::CappedTag<float, 16>;
  using DU = hn::RebindToUnsigned<D>;
  hn::Vec<DU> object;
  hn::Vec<D> x, y, z, normal_x, normal_y, normal_z, tolerance;

  /// The pixels from `at` on.
  static HWY_INLINE Middle ofEach(const HostSurfaces& s, std::size_t at) {
    const D d;
    return {hn::LoadU(DU(), &s.objects[at]), hn::LoadU(d, &s.x[at]),        hn::LoadU(d, &s.y[at]),
            hn::LoadU(d, &s.z[at]),          hn::LoadU(d, &s.normal_x[at]), hn::LoadU(d, &s.normal_y[at]),
            hn::LoadU(d, &s.normal_z[at]),   hn::LoadU(d, &s.tolerance[at])};
  }
  /// One pixel, in all lanes.
  static HWY_INLINE Middle ofOne(const HostSurfaces& s, std::size_t at) {
    const D d;
    return {hn::Set(DU(), s.objects[at]), hn::Set(d, s.x[at]),        hn::Set(d, s.y[at]),
            hn::Set(d, s.z[at]),          hn::Set(d, s.normal_x[at]), hn::Set(d, s.normal_y[at]),
            hn::Set(d, s.normal_z[at]),   hn::Set(d, s.tolerance[at])};
  }

  /// Which of the pixels from `there` on are of its surface.
  HWY_INLINE hn::Mask<D> same(const HostSurfaces& s, std::size_t there) const {
    const D d;
    const auto off = hn::MulAdd(normal_x, hn::Sub(hn::LoadU(d, &s.x[there]), x),
                                hn::MulAdd(normal_y, hn::Sub(hn::LoadU(d, &s.y[there]), y),
                                           hn::Mul(normal_z, hn::Sub(hn::LoadU(d, &s.z[there]), z))));
    const auto facing = hn::MulAdd(normal_x, hn::LoadU(d, &s.normal_x[there]),
                                   hn::MulAdd(normal_y, hn::LoadU(d, &s.normal_y[there]),
                                              hn::Mul(normal_z, hn::LoadU(d, &s.normal_z[there]))));
    const auto near = hn::And(hn::Le(hn::Abs(off), tolerance), hn::Ge(facing, hn::Set(d, kCrease)));
    return hn::And(near, hn::RebindMask(d, hn::Eq(object, hn::LoadU(DU(), &s.objects[there]))));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace gloam::radiance_filter
HWY_AFTER_NAMESPACE();
#endif
