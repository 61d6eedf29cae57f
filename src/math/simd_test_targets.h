// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "math/simd_targets.h"
// Highway must come after the choice of targets.
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <cstdint>

#include "math/sh_batch.h"

namespace gloam {

/// Runs a function once on each instruction set that was compiled and that this machine has.
template <class Function>
void onEveryTarget(const Function& function) {
  const std::int64_t supported = hwy::SupportedTargets();
  for (std::int64_t rest = supported; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    if ((target & HWY_DISABLED_TARGETS) != 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    function(sh::simdTarget().c_str());
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace gloam
