// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "bench_stage.h"

namespace gloam::cli {

/// gloam bench spherical_lights --figures DIR: the experiments of the paper's Figures 7 to 11 against the reference, one bounce. DIR gets a
/// folder an experiment, as `gloam compare` writes it, and a strip: technique, reference, twice their difference. Throws Error for other
/// techniques.
int benchFigures(const BenchChoice& choice, Console& console);

}  // namespace gloam::cli
