// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "frame/gpu_scene.h"

namespace gloam::visibility {

/// What does not move, read back from the device: meshes without normals and an empty one at the end, materials, textures of at most kTextureSide texels a
/// side (their mips). Texture coordinates of slot s are set s of a mesh.
Scene downloadScene(const frame::GpuScene& scene);

inline constexpr int kTextureSide = 1024;

}  // namespace gloam::visibility
