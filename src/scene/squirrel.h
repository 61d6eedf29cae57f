// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>

#include "scene/scene_builder.h"

namespace gloam::squirrel {

/// A squirrel, 0.97 m tall, that sits at the origin on y = 0, faces +Z and holds an acorn. Closed bodies in one mesh; UVs
/// name a place on the palette of `fur`.
Mesh model(float cell);
/// How far it reaches before and behind the origin.
inline constexpr float kFront_m = 0.37f, kBack_m = 0.66f;

/// Its material.
int fur(SceneBuilder& builder);

}  // namespace gloam::squirrel
