// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bench relight: what a change of light costs (PRT-4), on the host and on the device.
#pragma once

#include "scene_inputs.h"
#include "scene_inputs.h"

namespace gloam::cli {

int benchRelight(const SceneChoice& scene, Console& console);

}  // namespace gloam::cli
