// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "bench_stage.h"

namespace gloam::cli {

/// gloam bench visibility: which virtual lights of its set each pixel sees (row RF-2), against the tracing library alone on the
/// same rays, and by the device.
int benchVisibility(const BenchChoice& choice, Console& console);

}  // namespace gloam::cli
