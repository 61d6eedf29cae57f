// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "bench_stage.h"
#include "console.h"

namespace gloam::cli {

/// Measurements of parts that are no technique.
struct BenchSuite {
  const char* name;
  const char* summary;
  /// Which options it has a use for; of the others some are refused, none is dropped silently.
  bool takes_scene, takes_light, takes_view;
  int (*run)(const BenchChoice& choice, Console& console);
};
std::span<const BenchSuite> benchSuites();

/// Throws Error for an option that was given and means nothing to the suite.
void refuseUnused(const BenchSuite& suite, const CLI::App& app);

}  // namespace gloam::cli
