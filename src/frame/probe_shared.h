// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What C++ and shaders both know about probes (frame/probes.h).
#ifndef GLOAM_FRAME_PROBE_SHARED_H
#define GLOAM_FRAME_PROBE_SHARED_H
#include "frame/frame_shared.h"
GLOAM_SHARED_BEGIN(frame)

/// Numbers a texel of the projection's table: up to 36 basis functions integrated over it, then its solid angle.
GLOAM_SHARED_CONST uint kProbeStride = 40u;
GLOAM_SHARED_CONST uint kProbeSolidAngle = 36u;

/// Share of the sphere in which a probe may see backs of surfaces before it counts as buried in them, and from which on it
/// counts for nothing.
GLOAM_SHARED_CONST float kProbeSomeBacks = 0.1f;
GLOAM_SHARED_CONST float kProbeMostBacks = 0.4f;

/// One face of a probe's cube, as long as the step at which any device binds parts of buffers.
struct ProbeView {
  FrameView view;
  uint unused[13];
};
GLOAM_SHARED_SIZE(ProbeView, 256)

struct ProbeLightParams {
  uint size;          // texels a side of a face
  uint lamp_count;    // of the lights' rows
  uint lamps_on_lit;  // 0: what surfaces send on holds the light of lamps already
};
GLOAM_SHARED_SIZE(ProbeLightParams, 12)

/// Irradiance of a vertex of a surface that a technique has lit.
struct SurfaceLight {
  vec3 direct;
  vec3 indirect;
};
GLOAM_SHARED_SIZE(SurfaceLight, 24)

/// Where the light of an instance's points stands; first kAbsent: no technique has lit it.
struct LitRow {
  uint first;
  uint texel_width;  // 0: points are vertices, else texels of a lightmap
  uint texel_height;
  uint first_uv;  // of the lightmap's texture coordinates
};
GLOAM_SHARED_SIZE(LitRow, 16)

/// Sums over one face of a cube, by coefficient. Beyond the last one: sky's luminance that is seen, backs, surfaces, each
/// times their solid angles.
struct ProbeSums {
  vec3 emitted;
  vec3 reflected;
};
GLOAM_SHARED_SIZE(ProbeSums, 24)

/// What a picture of few texels leaves out of the sky.
struct ProbeSky {
  vec3 remainder[36];  // the sky's coefficients less those of its picture
  float luminance;     // of the picture, integrated over the sphere
};
GLOAM_SHARED_SIZE(ProbeSky, 436)

/// A lamp as one probe sees it.
struct ProbeLamp {
  vec3 irradiance;  // on a plane that faces it, with nothing in the way
  float distance;   // 0: infinitely far
  vec3 direction;
  float basis[36];
};
GLOAM_SHARED_SIZE(ProbeLamp, 172)

/// A probe's light in axes of someone's own.
struct ProbeJob {
  uint probe;
  uint turn;
};
GLOAM_SHARED_SIZE(ProbeJob, 8)

struct ProbeGatherParams {
  uint size;
  uint lamp_count;
  uint coefficients;
  float band[6];  // factors of a window
};
GLOAM_SHARED_SIZE(ProbeGatherParams, 36)

/// One coefficient of a probe's light without lamps, apart by what is done with it. Both bounce on the receiver itself.
struct ProbeLight {
  vec3 direct;     // of emitters and sky
  vec3 reflected;  // by the surfaces around
};
GLOAM_SHARED_SIZE(ProbeLight, 24)

GLOAM_SHARED_END
#endif
