// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance that arrives at a vertex, in SH: its transfer matrices times its object's light (PRT-2). GS is symmetric as
// far as it is square and stored so; where only V is kept, it is multiplied by the light's product matrix instead (the
// triple product). Loops over columns are written out: arrays with constant places stay in registers. One work group a
// block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_gloss_vertices.glsl"
