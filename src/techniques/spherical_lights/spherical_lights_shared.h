// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_SPHERICAL_LIGHTS_SHARED_H
#define GLOAM_SPHERICAL_LIGHTS_SHARED_H
#include "frame/light_peak_shared.h"
#include "frame/patch_shared.h"
#include "frame/quads_shared.h"
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(spherical_lights)
#ifdef __cplusplus
using frame::LightPeak;
using frame::PatchRow;
using frame::QuadList;
using frame::UpsampleParams;
using frame::WidenParams;
#endif

/// Of the polynomials over the coordinate of a sphere's half-angle.
GLOAM_SHARED_CONST int kFitTerms = 10;
/// Where the least eigenvalue of what a sphere leaves visible meets its clamp, logs have a kink: two polynomials, to here and from here.
GLOAM_SHARED_CONST float kLogSplit = 0.5843f;
GLOAM_SHARED_CONST uint kDirections = 92u;

GLOAM_SHARED_CONST int kPerObject = 0;
GLOAM_SHARED_CONST int kPerSphere = 1;
GLOAM_SHARED_CONST int kPerSphereReused = 2;

GLOAM_SHARED_CONST int kMean = 0;
GLOAM_SHARED_CONST int kProduct = 1;
GLOAM_SHARED_CONST int kDifference = 2;

/// Pictures to look at.
GLOAM_SHARED_CONST int kViewSamples = 0;
GLOAM_SHARED_CONST int kViewEmission = 1;
GLOAM_SHARED_CONST int kViewAverage = 2;

/// Of as many groups (objects, or spheres) a receiver keeps the sums.
GLOAM_SHARED_CONST uint kMostKept = 512u;

struct SphereRow {
  vec3 center;
  float radius;
  float blocks;       // 0: a lamp, which stands in nobody's light; 1
  float bulge;        // of its width, out of the surface that it stands for
  uint first_listed;  // of those of its object that it does not meet (per object), or meets (per sphere)
  uint listed;
  uint object;
  uint first;  // of its object's spheres
  uint count;
};
GLOAM_SHARED_SIZE(SphereRow, 44)

struct ObjectRow {
  vec3 center;
  uint first;
  uint count;
  uint first_level;
  uint levels;
};
GLOAM_SHARED_SIZE(ObjectRow, 28)

/// Spheres that stand for all of an object together: neighbours among the coarse ones, which follow all others.
struct LevelRow {
  uint first;
  uint count;
};
GLOAM_SHARED_SIZE(LevelRow, 8)
/// Which spheres a coarse one stands for: part of a list.
struct CoarseRow {
  uint first_leaf;
  uint leaves;
};
GLOAM_SHARED_SIZE(CoarseRow, 8)
/// Receivers of a cluster, a side; a work group.
GLOAM_SHARED_CONST uint kClusterSide = 8u;

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

/// What patches take of the view is found from a few cones: that much more may come from them.
GLOAM_SHARED_CONST float kPatchSlack = 1.04f;
/// Share of the sky, weighted by the cosine, from which on it is as four bands tell; closed rooms have less.
GLOAM_SHARED_CONST float kSkyLeft = 0.25f;
/// How far from its plane, in its lesser half side, a surface that lies along a patch may be its own: one stands in the middle of a thing.
GLOAM_SHARED_CONST float kPatchOwn = 1.3f;
/// Rows that the buffer of what patches send has past its last: it is read by eight words.
GLOAM_SHARED_CONST uint kPatchesPast = 2u;
/// Samples of one.
GLOAM_SHARED_CONST uint kPatchPoints = 4u;

/// Points of lists (QuadList) stand in pictures of that many columns, eight rows a row of work groups, over which the head of a list
/// dispatches (8, 1, 1 at first).
GLOAM_SHARED_CONST uint kPointColumns = 64u;
GLOAM_SHARED_CONST uint kPointRow = 512u;
/// Vertices that receive stand in pictures of that many columns.
GLOAM_SHARED_CONST uint kVertexColumns = 1024u;
struct LightRows {
  vec3 shade[144];  // Q[9 i + j]; without the peak
  LightPeak peak;
  vec4 average_fit[10];
};
GLOAM_SHARED_SIZE(LightRows, 1976)

struct GatherParams {
  uint spheres;
  uint objects;
  uint words;  // of a sphere's bits: which it meets
  uint blocking_patches;
  uint sending_patches;
  uint enclosed_patches;  // those at the head of these, also where none sends
  uint coarse;            // spheres that follow
};
GLOAM_SHARED_SIZE(GatherParams, 28)
struct CutParams {
  GatherParams params;
  float limit;  // sine of the half-angle
};
GLOAM_SHARED_SIZE(CutParams, 32)
struct FlatParams {
  uint patches;
  uint first_point;
};
GLOAM_SHARED_SIZE(FlatParams, 8)
struct VertexParams {
  uint instances;
  uint vertices;
};
GLOAM_SHARED_SIZE(VertexParams, 8)
struct SampleParams {
  GatherParams params;
  uint points;
};
GLOAM_SHARED_SIZE(SampleParams, 32)

GLOAM_SHARED_END
#endif
