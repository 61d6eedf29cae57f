// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_SPHERICAL_LIGHTS_SHARED_H
#define GLOAM_SPHERICAL_LIGHTS_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(spherical_lights)

/// Entries of the tables over the sine of a sphere's half-angle, at equal steps of shLogBlockerCoordinate.
GLOAM_SHARED_CONST int kLogEntries = 256;
GLOAM_SHARED_CONST uint kDirections = 92u;

GLOAM_SHARED_CONST int kPerObject = 0;
GLOAM_SHARED_CONST int kPerSphere = 1;
GLOAM_SHARED_CONST int kPerSphereReused = 2;

struct SphereRow {
  vec3 center;
  float radius;
  uint object;
  uint first;  // of its object's spheres
  uint count;
  float blocks;  // 0: a lamp, which stands in nobody's light; 1
};
GLOAM_SHARED_SIZE(SphereRow, 32)

struct ObjectRow {
  vec3 center;
  uint first;
  uint count;
};
GLOAM_SHARED_SIZE(ObjectRow, 20)

/// A point of a surface that lights a sphere, in the world.
struct PointRow {
  vec3 position;
  float sends;
  vec3 normal;
  float unused;
};
GLOAM_SHARED_SIZE(PointRow, 32)

/// What a sphere sends, in the axes of its shape space, and how those stand in the world.
struct SenderRow {
  vec3 albedo[16];
  float turn[83];  // bands 1 to 3
};
GLOAM_SHARED_SIZE(SenderRow, 524)

/// L^c of a sphere, world axes.
struct SentRow {
  vec3 at[16];
};
GLOAM_SHARED_SIZE(SentRow, 192)

struct LightRows {
  vec3 shade[144];  // Q[9 i + j]
};
GLOAM_SHARED_SIZE(LightRows, 1728)

struct GatherParams {
  uint spheres;
  uint objects;
  uint words;  // of a sphere's bits: which it meets
};
GLOAM_SHARED_SIZE(GatherParams, 12)
struct SampleParams {
  GatherParams params;
  uint points;
};
GLOAM_SHARED_SIZE(SampleParams, 16)

GLOAM_SHARED_END
#endif
