// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace gloam::gpu {

/// SPIR-V as the build embeds it. `gloam_room(name SHADERS a_verb.comp.glsl b.vert.glsl b.frag.glsl)` makes
/// the header "shaders/<name>_shaders.h", which declares, in namespace gloam, `a_verb_spv` for a compute
/// shader and `b_vert_spv`, `b_frag_spv` for the two stages of a raster program.
struct ShaderCode {
  const char* name;  ///< source file without ".glsl", for messages: "a_verb.comp"
  const std::uint32_t* words;
  std::size_t word_count;
  const char* source = nullptr;  ///< where it was written, from src/: "frame/frame_shade.comp.glsl"
};

}  // namespace gloam::gpu
