// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Loops over SH coefficients, two a step, written out: arrays with constant places stay in registers.
#ifndef GLOAM_PRT_PAIRS_GLSL
#define GLOAM_PRT_PAIRS_GLSL

// WORK(2p, 2p + 1) for the first `count` of 36, rounded up to pairs and to 9, 16 or 25: WORK asks what is in use.
#define PAIRS_9(WORK) WORK(0, 1) WORK(2, 3) WORK(4, 5) WORK(6, 7) WORK(8, 9)
#define PAIRS_16(WORK) WORK(10, 11) WORK(12, 13) WORK(14, 15)
#define PAIRS_25(WORK) WORK(16, 17) WORK(18, 19) WORK(20, 21) WORK(22, 23) WORK(24, 25)
#define PAIRS_36(WORK) WORK(26, 27) WORK(28, 29) WORK(30, 31) WORK(32, 33) WORK(34, 35)
#define PAIRS(count, WORK)            \
  PAIRS_9(WORK)                       \
  if (count > 9) { PAIRS_16(WORK) }   \
  if (count > 16) { PAIRS_25(WORK) }  \
  if (count > 25) { PAIRS_36(WORK) }

#endif
