// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance that arrives at a vertex under local light: its matrices times the light of its object's probes, blended by
// weight at the vertex (PRT-5, GS and GI).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define GLOAM_LOCAL_LIGHT
#include "frame/probe_shared.h"
#include "techniques/prt/prt_gloss_vertices.glsl"
