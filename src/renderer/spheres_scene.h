// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres in place of models, as a scene: what a technique of spheres takes the world for, to be path traced.
#pragma once

#include <gloam/spheres.h>

namespace gloam {

/// The scene with every object that casts replaced by its spheres as techniques take them (ProxySet): where they are in `posed`, of
/// the same size and colour, diffuse. What only receives, cameras, lamps and light stay. Throws Error where sets or pose belong
/// to another scene.
Scene spheresInPlace(const Scene& scene, const SceneSpheres& spheres, const PosedScene& posed);

}  // namespace gloam
