// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shaders exchanged while the program runs: who edits a shader sees the next frame drawn by it. For the whole process, from any
// thread.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/shader_code.h"

namespace gloam::gpu {

/// All that programs were made of so far, as the build embedded them, in the order of their first use.
std::vector<const ShaderCode*> shadersInUse();

/// Programs made from now on have these words of SPIR-V in place of `code`; passes make theirs at the next frame. What does not fit the
/// passes that use it is an Error there, until it is replaced again. Words are kept to the end: for development.
void replaceShader(const ShaderCode& code, std::vector<std::uint32_t> words);

/// `code`, or what replaced it; notes its use.
const ShaderCode& currentShader(const ShaderCode& code);

}  // namespace gloam::gpu
