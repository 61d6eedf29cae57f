// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Scenes made by code: the furnaces and bowls whose light can be worked out by hand, and small stages for pictures.
#pragma once

#include <gloam/scene.h>

#include <string>

namespace gloam {

/// `description` is a name of builtinScenes(), with values where wanted: "columns?detail=2", "bowl?coverage=0.3". All
/// take detail (0.25 to 8), which multiplies vertices along each side of every surface. Throws Error that lists the names.
Scene makeBuiltinScene(const std::string& description);

}  // namespace gloam
