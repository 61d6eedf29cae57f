// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The part of `gloam bake` that bakes smoke and cloud (PRT-7).
#pragma once

#include <gloam/bake.h>
#include <gloam/volume.h>

#include <CLI/CLI.hpp>

#include "bake_checkpoints.h"
#include "console.h"
#include "json.h"

namespace gloam::cli {

struct VolumeChoice {
  VolumeBakeOptions options;
  const CLI::Option* scatterings_option = nullptr;
};

/// --scatterings.
void addVolumeOptions(CLI::App& app, VolumeChoice& choice);
/// Takes over what transfer's options say; says what the volumes will take, or that there are none. For --estimate --json: null
/// without volumes. Throws Error, also where --memory does not suffice.
Json estimateVolumes(const Scene& scene, VolumeChoice& choice, const BakeOptions& bake, bool half_float,
                     Console& console, bool print);
/// The scene with its volumes baked; they stay in their checkpoint, from which they are taken if it is there. `json` gets an
/// object for --json, or null. Throws Error, Interrupted.
Scene bakeVolumesAsChosen(Scene scene, const VolumeChoice& choice, const BakeCheckpoints& checkpoints,
                          Console& console, Json& json);

}  // namespace gloam::cli
