// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light: what techniques ask of an Environment beyond radianceFrom() (gloam/scene.h).
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

namespace gloam {

/// The environment's radiance in spherical harmonics, its rotation and intensity applied (SH-2): those it was painted from,
/// where it knows them (Environment::lights), else of its texels. All of them take part with their exact solid angle, so that
/// a sun of one texel keeps its energy. An empty environment is black.
sh::ShRgb projectEnvironment(const Environment& environment, int order);

/// Direction through the middle of a texel, without the environment's rotation; row 0 is the top.
glm::vec3 texelDirection(const Environment& environment, int column, int row);

/// Radiance of the map, bilinear, at a direction in its own axes (unit): without rotation and intensity.
glm::vec3 mapRadiance(const Environment& environment, const glm::vec3& local_direction);

/// `description`: a sky's name, with values: "preetham?elevation=30&turbidity=3". Throws Error that lists the names.
Environment makeSky(const std::string& description);

}  // namespace gloam
