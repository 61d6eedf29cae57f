// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_SPLATTING_SHARED_H
#define GLOAM_SPLATTING_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(splatting)

GLOAM_SHARED_CONST int kMostLevels = 16;

/// A subsplat: a texel of one level that receives light.
struct Subsplat {
  vec3 position;
  uint place;   // x + (y << 16), of its level
  vec3 normal;  // shading, mean over its pixels, not of length 1
  uint unused;
};
GLOAM_SHARED_SIZE(Subsplat, 32)

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
  uint subsplats;
};
GLOAM_SHARED_SIZE(Counts, 196)

GLOAM_SHARED_CONST int kGroup = 64;             // invocations
GLOAM_SHARED_CONST uint kRowOfGroups = 32768u;  // a dispatch of n groups has rows of that many

/// What varies too much within a texel.
struct Thresholds {
  float normal;  // difference of a component, 0 to 2
  float depth;   // difference over the least
};

/// Which level, for passes that make its dispatches.
struct LevelPush {
  int level;
  int finest;       // level 0 as such: its queue holds leaves
  int chunks;       // of lights
  float threshold;  // of a texel's size over the mean distance of its light; 0: not asked
};

GLOAM_SHARED_END
#endif
