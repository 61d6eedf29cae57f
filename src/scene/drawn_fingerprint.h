// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a picture shows, told apart: by what is seen of scene, light and camera, not by names, bakes, other instants of an
// animation or the file that it came from. A reference picture carries these, and what is held against it is checked.
#pragma once

#include "scene/scene_fingerprint.h"

namespace gloam {

/// Surfaces, materials and lamps as they stand.
Fingerprint drawnFingerprint(const Scene& scene, const PosedScene& posed);
/// Pixels, rotation and intensity; the same for all that are empty.
Fingerprint drawnFingerprint(const Environment& environment);
/// Projection and place.
Fingerprint drawnFingerprint(const PosedCamera& camera);

}  // namespace gloam
