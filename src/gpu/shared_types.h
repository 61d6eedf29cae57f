// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Names that let one header be read by C++ and GLSL. A shared header looks like this:
//
//   #ifndef GLOAM_PROXIES_SHARED_H        (GLSL knows no #pragma once)
//   #define GLOAM_PROXIES_SHARED_H
//   #include "gpu/shared_types.h"
//   GLOAM_SHARED_BEGIN(proxies)           (namespace gloam::proxies; nothing in GLSL)
//   struct AccumulateParams { vec3 eye; uint proxy_count; };
//   GLOAM_SHARED_SIZE(AccumulateParams, 16)
//   GLOAM_SHARED_END
//   #endif
//
// and a shader, after its #version, requires GL_GOOGLE_include_directive and GL_EXT_scalar_block_layout,
// includes it, and declares every block `layout(scalar, …)`: then the offsets of both sides agree, without
// padding.
#ifndef GLOAM_GPU_SHARED_TYPES_H
#define GLOAM_GPU_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>

namespace gloam::gpu::shared_types {
using glm::ivec2, glm::ivec3, glm::ivec4;
using glm::mat3, glm::mat4, glm::mat3x4, glm::mat4x3;
using glm::uvec2, glm::uvec3, glm::uvec4;
using glm::vec2, glm::vec3, glm::vec4;
using uint = std::uint32_t;
}  // namespace gloam::gpu::shared_types

#define GLOAM_SHARED_BEGIN(room) \
  namespace gloam::room {        \
  using namespace gpu::shared_types;
#define GLOAM_SHARED_END }
#define GLOAM_SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), #type " has padding");
#define GLOAM_SHARED_CONST inline constexpr
#else
#define GLOAM_SHARED_BEGIN(room)
#define GLOAM_SHARED_END
#define GLOAM_SHARED_SIZE(type, bytes)
#define GLOAM_SHARED_CONST const
#endif

#endif
