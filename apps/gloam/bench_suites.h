// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "console.h"
#include "scene_inputs.h"

namespace gloam::cli {

/// Measurements of parts that are no technique.
struct BenchSuite {
  const char* name;
  const char* summary;
  int (*run)(const SceneChoice& scene, Console& console);
};
std::span<const BenchSuite> benchSuites();

}  // namespace gloam::cli
