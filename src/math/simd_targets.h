// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Instruction sets that the *_simd.cpp files are compiled for; include it before Highway. Each costs compile time:
// those left out add nothing to float arithmetic, or have vectors without a fixed size, which arrays cannot hold.
#pragma once

#include <hwy/detect_compiler_arch.h>

#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
