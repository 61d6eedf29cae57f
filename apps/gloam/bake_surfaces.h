// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where on surfaces `gloam bake` keeps light: vertices, more vertices, or texels of a lightmap.
#pragma once

#include <gloam/bake.h>

#include "arguments.h"
#include "console.h"
#include "json.h"

namespace gloam::cli {

struct SurfaceChoice {
  float tessellate = 0.0f;  ///< 0: not
  int tessellate_max = 1000000, tessellate_mrays = int(TessellateOptions{}.max_rays / 1000000);
  const CLI::Option* max_option = nullptr;
  const CLI::Option* mrays_option = nullptr;
  const CLI::Option* uv_set_option = nullptr;
};

/// --texels, --texels-per-metre, --uv-set, --tessellate, --tessellate-max, --tessellate-rays.
void addSurfaceOptions(CLI::App& app, BakeOptions& options, SurfaceChoice& choice);
void remarkUnusedSurfaceOptions(const BakeOptions& options, const SurfaceChoice& choice, Console& console);

/// The scene as it is to be baked; says what was split. Throws Error, Interrupted.
Scene tessellatedAsChosen(Scene scene, const BakeOptions& options, const SurfaceChoice& choice,
                          Console& console, TessellateReport& report);
/// Where the bound does not hold: one line with what was reached, on how much of the surface, and what ended it.
void remarkMissedBound(const SurfaceChoice& choice, const TessellateReport& report, Console& console);
/// Null where nothing was asked for.
Json tessellateJson(const SurfaceChoice& choice, const TessellateReport& report);

}  // namespace gloam::cli
