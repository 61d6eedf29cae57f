// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_VISIBILITY_SHARED_H
#define GLOAM_VISIBILITY_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(visibility)

/// A point that asks which lights of its set it sees. Lights behind its surface are not seen.
struct SightPoint {
  vec3 position;
  float offset;  // metres along the normal at which its rays begin
  vec3 normal;   // geometric, unit; zero: nobody asks, all bits are 0
  uint set;
};
GLOAM_SHARED_SIZE(SightPoint, 32)

GLOAM_SHARED_CONST uint kSightSurface = 0u;    // a point of a surface that sends to the side of its normal
GLOAM_SHARED_CONST uint kSightBothSides = 1u;  // one that sends to both
GLOAM_SHARED_CONST uint kSightLamp = 2u;       // a point in space; `normal` does not matter
GLOAM_SHARED_CONST uint kSightDirectional =
    3u;  // infinitely far away: `position` is the unit direction towards it
GLOAM_SHARED_CONST uint kSightNothing = 4u;  // not seen from anywhere

/// The end of rays at a light. It begins every row of lights that are asked about; what follows it is the asker's.
struct SightEnd {
  vec3 position;
  uint kind;
  vec3 normal;   // geometric, unit
  float offset;  // metres before the light at which rays end
};
GLOAM_SHARED_SIZE(SightEnd, 32)

/// Lights first … first + count - 1 of the rows. The other two words are the asker's.
struct SightSet {
  uint first;
  uint count;
  uint lamps;
  uint direct;
};
GLOAM_SHARED_SIZE(SightSet, 16)

GLOAM_SHARED_END
#endif
