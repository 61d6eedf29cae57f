// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The camera as shaders know it (frame/view.glsl) and as the host plans with it.
#pragma once

#include <gloam/scene.h>

#include "frame/frame_shared.h"

namespace gloam::frame {

/// Rows for a picture of that size. Only the orientation and position of world_from_view count; scale and
/// shear are taken out. The far plane is ignored by perspective cameras; the near plane cuts. `bounds` are
/// those of the scene: an orthographic camera sees all of it in front of its near plane. Throws Error for a
/// field of view outside 0 to 180 degrees, a near plane or an orthographic height that is not positive.
FrameView makeView(const PosedCamera& camera, int width, int height, const glm::vec3& bounds_min,
                   const glm::vec3& bounds_max);

/// What a view and a box have in common, from the eye: corners of the frustum cut at the farthest corner of
/// the box.
std::array<glm::vec3, 8> frustumCorners(const FrameView& view, const glm::vec3& bounds_min,
                                        const glm::vec3& bounds_max);

}  // namespace gloam::frame
