// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_SPLATTING_SHARED_H
#define GLOAM_SPLATTING_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(splatting)

GLOAM_SHARED_CONST int kMostLevels = 16;
GLOAM_SHARED_CONST int kMostSets = 8;

/// A virtual light, or some that were merged: their flux at their mean, weighted by flux.
struct SplatLight {
  vec3 position;
  float bound;  // squared metres: nearer than that counts as that near; 0: no bound
  vec3 normal;  // mean: shorter than 1 where theirs differ, which makes it exact for whoever sees them all
  float power;  // sum of the intensity's colours
  vec3 intensity;
  float spread;  // metres: standard deviation of their positions
};
GLOAM_SHARED_SIZE(SplatLight, 48)

/// A subsplat: a texel of one level that receives light.
struct Subsplat {
  vec3 position;
  uvec2 normal;  // snorm: shading, mean over its pixels, not of length 1
};
GLOAM_SHARED_SIZE(Subsplat, 20)

/// As VkDispatchIndirectCommand.
struct Groups {
  uint x, y, z;
};

/// Bit in the place of a subsplat that was split after all.
GLOAM_SHARED_CONST uint kSplit = 0x80000000u;

/// How many, counted on the device. Texels of a level that are split or kept wait in its queue; those kept are its leaves.
struct Counts {
  uint queued[16];
  uint leaves[16];
  uint first_leaf[16];  // among all subsplats, coarse levels first
  uint listed[8];       // by set of lights: subsplats that ask for it
  uint subsplats;
};
GLOAM_SHARED_SIZE(Counts, 228)

GLOAM_SHARED_CONST int kGroup = 64;             // invocations
GLOAM_SHARED_CONST int kEach = 4;               // subsplats an invocation gathers for
GLOAM_SHARED_CONST uint kRowOfGroups = 32768u;  // a dispatch of n groups has rows of that many
GLOAM_SHARED_CONST int kSorted = 4096;          // lights that are sorted together

/// Places in the buffer of arguments: over a level's queue or leaves; over its leaves, kEach an invocation; then by chunk of
/// each set of lights.
GLOAM_SHARED_CONST int kOverFours = 16;
GLOAM_SHARED_CONST int kOverChunks = 32;

/// What varies too much within a texel.
struct Thresholds {
  float normal;  // difference of a component, 0 to 2
  float depth;   // difference over the least
};

/// For passes that make dispatches.
struct ArgumentsPush {
  int level;   // or the set of lights
  int chunks;  // of that set
  int first;   // of that set's chunks
};

/// For the first gathering of one level.
struct CoarsePush {
  int level;
  float light_threshold;    // of a texel's size over the mean distance of its light; 0: not asked
  float cluster_threshold;  // of what merging lights may change of their sum; 0: all ask for the next set
};

GLOAM_SHARED_END
#endif
