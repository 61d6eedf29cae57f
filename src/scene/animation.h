// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Animation channels: which of them play, and their values at a time.
#pragma once

#include <gloam/scene.h>

#include <vector>

namespace gloam {

/// The channels that pose() evaluates. All animations of a file play at once; where several move the same
/// property of a node (a file that stores "walk" and "run" of one figure), the first one has it.
std::vector<const AnimationChannel*> channelsInPlay(const Scene& scene);

/// Value of a channel at a time, clamped to the range of its keys: `components` numbers, written to `value`.
/// Rotations are unit quaternions (x, y, z, w); between two keys they take the shorter way round (slerp), or
/// follow the normalised spline. Formulas: glTF 2.0 specification, appendix C.
void sampleChannel(const AnimationChannel& channel, float time_s, std::vector<float>& value);

/// Whether rigid meshes that the scene shows move against one another: what is baked into them then holds for one instant.
/// By what moves each of them, not by how: two doors that swing in step count as two.
bool movesApart(const Scene& scene);

}  // namespace gloam
