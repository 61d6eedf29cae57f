// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A power of two that brings the most light, without shadow, of a few points near to 1, where halves are finest.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "visibility/visibility_shared.h"
#include "vpls/walks.glsl"

const uint kSamples = 256u;
shared float most[kSamples];

layout(local_size_x = 256) in;
layout(scalar, set = 0, binding = 0) readonly buffer Points { SightPoint at[]; } points;
layout(scalar, set = 0, binding = 1) readonly buffer Rows { WalkVpl at[]; } rows;
layout(scalar, set = 0, binding = 2) readonly buffer Sets { SightSet at[]; } sets;
layout(scalar, set = 0, binding = 3) writeonly buffer Exposure { float at[]; } exposure;
layout(scalar, push_constant) uniform Push { uint points; } push;

void main() {
  uint sample_ = gl_LocalInvocationIndex;
  // Golden steps: even over the points, out of step with rows and tiles.
  float place = fract(float(sample_) * 0.6180339887);
  SightPoint point = points.at[min(uint(place * float(push.points)), push.points - 1u)];
  SightSet own = sets.at[point.set];
  vec3 sum = vec3(0.0);
  if (point.normal != vec3(0.0)) {
    for (uint k = own.first; k < own.first + own.count; ++k) {
      vec3 to_light;
      vec3 light = walkIrradiance(rows.at[k], point.position, to_light);
      if (rows.at[k].end.kind != kSightNothing && dot(to_light, point.normal) > 0.0) sum += light;
    }
  }
  most[sample_] = max(sum.r, max(sum.g, sum.b));
  barrier();
  for (uint half_ = kSamples / 2u; half_ > 0u; half_ /= 2u) {
    if (sample_ < half_) most[sample_] = max(most[sample_], most[sample_ + half_]);
    barrier();
  }
  if (sample_ == 0u) {
    float greatest = most[0];
    bool usable = greatest > 1e-36 && greatest < 1e37;  // false for not-a-number
    exposure.at[0] = usable ? exp2(-ceil(log2(greatest))) : 1.0;
  }
}
