// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PRT_SHARED_H
#define GLOAM_PRT_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(prt)

/// Vertices of a block, in which transfer is stored: eight lanes (as many as Mesa's software driver runs together) of four
/// vertices each read a block from its first byte to its last, and 32 lanes of one each read whole lines.
GLOAM_SHARED_CONST uint kBlockVertices = 32u;
/// Blocks that a work group of prt.vertices takes.
GLOAM_SHARED_CONST uint kBlocksTogether = 8u;
GLOAM_SHARED_CONST uint kUnbaked = 0xffffffffu;

/// The sharpest Phong lobe that bands of radiance show, by their number: its truncated kernel dips to no more than -8 % of
/// its peak. Sharper materials are shown with this exponent.
GLOAM_SHARED_CONST float kSharpestLobe[7] = {1.0f, 1.0f, 1.0f, 2.0f, 3.0f, 10.0f, 12.0f};

/// What `window auto` leaves of the windowed light at least, in each colour, where light is not taken in two parts.
GLOAM_SHARED_CONST float kLeastOfDamped = 0.5f;

struct VerticesParams {
  uint block_count;
  uint first_peak;  // of the lights' peaks, where they come in two parts
};
GLOAM_SHARED_SIZE(VerticesParams, 8)

/// One work group: some vertices of one instance.
struct VertexBlock {
  uint transfer;  // block in the transfer buffers of this pass
  uint light;     // first of the instance's rotated light coefficients
  uint output_;   // where its first vertex goes
  uint count;     // 1 to kBlockVertices
};
GLOAM_SHARED_SIZE(VertexBlock, 16)

/// Irradiance of a vertex.
struct VertexLight {
  vec3 direct;
  vec3 indirect;
};
GLOAM_SHARED_SIZE(VertexLight, 24)

/// Where the light of an instance's points stands; first kUnbaked: it carries no transfer.
struct OutputRow {
  uint first;
  uint texel_width;  // 0: points are vertices
  uint texel_height;
  uint first_uv;  // of the lightmap's texture coordinates
};
GLOAM_SHARED_SIZE(OutputRow, 16)

/// The world's light convolved with the clamped cosine, for what carries no transfer.
struct UnbakedRow {
  vec3 sh[36];
};
GLOAM_SHARED_SIZE(UnbakedRow, 432)

/// An instance whose gloss is baked, or not.
struct GlossRow {
  mat3 object_from_world;  // its rotation alone
  uint first_vertex;       // of its vertices' radiance; kUnbaked: there is none
  float exponent;          // of a lobe that is baked in; 0: the material's
};
GLOAM_SHARED_SIZE(GlossRow, 44)

GLOAM_SHARED_END
#endif
