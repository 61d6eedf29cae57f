// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options of the same meaning in each room that lights by spheres: "spheres", "divisor", "parts", "window".
#pragma once

#include <gloam/renderer.h>

namespace gloam {

Option spheresOption();
Option divisorOption();
Option partsOption();
Option windowOption();

}  // namespace gloam
