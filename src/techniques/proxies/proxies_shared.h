// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PROXIES_SHARED_H
#define GLOAM_PROXIES_SHARED_H
#include "frame/light_peak_shared.h"
#include "frame/patch_shared.h"
#include "frame/quads_shared.h"
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(proxies)
#ifdef __cplusplus
using frame::LightPeak;
using frame::PatchRow;
using frame::QuadList;
using frame::UpsampleParams;
using frame::WidenParams;
#endif

/// Receivers of a square of that many a side share a list of proxies.
GLOAM_SHARED_CONST uint kTileSize = 8u;

/// Entries of the tables over the sine of a proxy's half-angle, at equal steps of shLogBlockerCoordinate.
GLOAM_SHARED_CONST int kLogEntries = 256;
GLOAM_SHARED_CONST int kOperatorEntries = 64;

GLOAM_SHARED_CONST int kIndirectOff = 0;
GLOAM_SHARED_CONST int kIndirectPoint = 1;
GLOAM_SHARED_CONST int kIndirectAveraged = 2;
GLOAM_SHARED_CONST int kIndirectExact = 3;

GLOAM_SHARED_CONST int kExpSeries = 0;
GLOAM_SHARED_CONST int kExpLinear = 1;
GLOAM_SHARED_CONST int kExpHybrid = 2;
GLOAM_SHARED_CONST int kExpQuadratic = 3;
GLOAM_SHARED_CONST int kExpTerms = 9;  // of the series

struct ProxyRow {
  vec3 center;
  float radius;
  vec3 albedo;
  float bulge;
};
GLOAM_SHARED_SIZE(ProxyRow, 32)

/// The box round a tile's receivers; low > high where it has none.
struct TileBounds {
  vec3 low;
  vec3 high;
};
GLOAM_SHARED_SIZE(TileBounds, 24)

struct TileParams {
  uint tiles;
  uint proxies;
  float least_sine;  // as below
};
GLOAM_SHARED_SIZE(TileParams, 12)

/// Where contributions fade out, in steps of shLogBlockerCoordinate.
struct AccumulateParams {
  uint words;  // of a tile's bits: which proxies reach it
  float shadow_from;
  float shadow_to;
  float indirect_from;
  float indirect_to;
  float least_sine;  // of half-angles that count anywhere
};
GLOAM_SHARED_SIZE(AccumulateParams, 24)

/// One proxy's quad, six vertices an instance, over the receivers that its sphere of influence may hold.
struct SplatParams {
  AccumulateParams params;
  uint columns;  // of receivers
  uint rows;
  uint divisor;  // pixels a side to one receiver
};
GLOAM_SHARED_SIZE(SplatParams, 36)

struct ShadeParams {
  uint flats;
};
GLOAM_SHARED_SIZE(ShadeParams, 4)

/// Pixels that are computed from scratch share a list of proxies within a square of that many a side.
GLOAM_SHARED_CONST uint kRepairTile = 32u;
struct RepairBoundsParams {
  uint columns;   // of tiles
  uint capacity;  // of the list
  uint divisor;
};
GLOAM_SHARED_SIZE(RepairBoundsParams, 12)
struct RepairParams {
  AccumulateParams params;
  uint columns;
  uint capacity;
  uint divisor;
  uint flats;
};
GLOAM_SHARED_SIZE(RepairParams, 40)

/// Squares of 2 x 2 pixels of a list (QuadList, all four of it 1 at first) that a work group looks at.
GLOAM_SHARED_CONST uint kRepairGroup = 64u;

struct ProxyLight {
  /// Radiance that leaves an unshadowed white diffuse sphere at a surface normal: light * cosine / pi.
  vec3 leaving[9];
  /// Its second band as a tensor: xx, yy, zz, xy, yz, xz.
  vec3 tensor[6];
  /// Q[9 i + j]: irradiance of a receiver = sum of O_i Q_ij y_j(N), of the light less its peak.
  vec3 shade[144];
  LightPeak peak;
};
GLOAM_SHARED_SIZE(ProxyLight, 1996)

GLOAM_SHARED_END
#endif
