// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Windows along a line of pixels. The window holds each set once: `taps` pixels about the middle. Where one of them is of another
// surface, or beyond the picture's edge, the next pixel of its set on the other side takes its place: `taps` further on.
#ifndef GLOAM_RADIANCE_FILTER_LINE_GLSL
#define GLOAM_RADIANCE_FILTER_LINE_GLSL
#include "techniques/radiance_filter/radiance_filter_shared.h"

/// Taps to the left of the middle, the middle, the rest to the right.
int tapsBefore(int taps) { return taps / 2; }
bool replacesTaps(int taps) { return taps <= kMostTapsReplaced; }
/// Pixels before the middle that may be looked at, and of all of them.
int reachBefore(int taps) { return replacesTaps(taps) ? taps : tapsBefore(taps); }
int reach(int taps) { return replacesTaps(taps) ? 2 * taps : taps; }
/// Where the pixel stands that may take the place of tap number `tap` of the reach.
int replacementOf(int tap, int taps) { return tap < taps ? tap + taps : tap - taps; }

/// All taps of the window, none replaced.
uint wholeWindow(int taps) {
  uint window = taps == 32 ? 0xffffffffu : (1u << taps) - 1u;
  return replacesTaps(taps) ? window << (taps - tapsBefore(taps)) : window;
}
/// Of pixels that are of the surface (bits of the reach), those that are taken.
uint chosenTaps(uint same, int taps) {
  uint window = wholeWindow(taps);
  if (!replacesTaps(taps)) return same & window;
  uint before = (1u << taps) - 1u, missing = ~same & window;
  return same & (window | ((missing & before) << taps) | ((missing & ~before) >> taps));
}

/// The first pixel of an invocation's run along an axis, and the step to the next.
ivec2 runStart(int axis, int run) { return ivec2(gl_GlobalInvocationID.xy) * (axis == 0 ? ivec2(run, 1) : ivec2(1, run)); }
ivec2 runStep(int axis) { return axis == 0 ? ivec2(1, 0) : ivec2(0, 1); }

/// Room for all that a run looks at. Runs are written out, and loops over taps cut in two, so that indexed arrays stay in registers:
/// software drivers unroll loops of at most 32.
const int kMostNear = 2 * kMostTapsReplaced + 8;
#define GLOAM_OVER_RUN(body) body(0) body(1) body(2) body(3) body(4) body(5) body(6) body(7)
#define GLOAM_OVER_NEAR(run, taps, body)                                  \
  for (int j = 0; j < min(run + reach(taps) - 1, 24); ++j) body           \
  for (int j = 24; j < run + reach(taps) - 1; ++j) body

#endif
