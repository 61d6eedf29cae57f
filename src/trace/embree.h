// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Embree 3.13 and Embree 4 under one set of calls. They differ in how flags of a query are handed over: a context in 3,
// arguments in 4. Only tracer.cpp and alpha_filter.cpp include this.
#pragma once

#if GLOAM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gloam::trace {

#if GLOAM_EMBREE_MAJOR >= 4

template <typename Arguments>
inline void setFlags(Arguments& arguments, bool coherent) {
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}

inline void embreeOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, bool coherent) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  setFlags(arguments, coherent);
  rtcOccluded16(valid, scene, rays, &arguments);
}
inline void embreeIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  setFlags(arguments, coherent);
  rtcIntersect16(valid, scene, rays, &arguments);
}
inline void embreeOccluded1(RTCScene scene, RTCRay* ray) {
  rtcOccluded1(scene, ray);
}
inline void embreeIntersect1(RTCScene scene, RTCRayHit* ray) {
  rtcIntersect1(scene, ray);
}

#else

inline RTCIntersectContext embreeContext(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
inline void embreeOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, bool coherent) {
  RTCIntersectContext context = embreeContext(coherent);
  rtcOccluded16(valid, scene, &context, rays);
}
inline void embreeIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, bool coherent) {
  RTCIntersectContext context = embreeContext(coherent);
  rtcIntersect16(valid, scene, &context, rays);
}
inline void embreeOccluded1(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context = embreeContext(false);
  rtcOccluded1(scene, &context, ray);
}
inline void embreeIntersect1(RTCScene scene, RTCRayHit* ray) {
  RTCIntersectContext context = embreeContext(false);
  rtcIntersect1(scene, &context, ray);
}

#endif

}  // namespace gloam::trace
