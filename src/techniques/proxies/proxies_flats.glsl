// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What ground and walls leave visible, as rectangles (frame/patch.glsl). They stand before distant light alone: added to logs after light
// of proxies was normalised. Includers declare the constant by_lanes, the buffer flats of words and the
// buffer log_table, and have all lanes run.
#ifndef GLOAM_PROXIES_FLATS_GLSL
#define GLOAM_PROXIES_FLATS_GLSL
#include "frame/lanes.glsl"
#include "frame/patch.glsl"
#include "math/sh.glsl"
#include "math/sh_log_blocker.glsl"
#include "spheres/receiver_rule.glsl"

void addFlats(uint count, vec3 position, vec3 normal, inout vec4 log0, inout vec4 log1, inout vec4 log2,
              inout vec4 log3) {
  for (uint i = 0u; i < count; ++i) {
    PatchRow flat_row;
    GLOAM_READ_PATCH(flat_row, flats, i)
    PatchCone cone = patchCone(flat_row, position, normal);
    SeenSphere seen = seenSphere(vec3(0.0), normal, cone.direction, cone.sin_half_angle, 0.0);
    float at = shLogBlockerCoordinate(seen.sin_half_angle) * float(kLogEntries - 1);
    int below = min(int(at), kLogEntries - 2);
    vec4 zonal = mix(log_table.at[below], log_table.at[below + 1], at - float(below)) * cone.there;
    float y[16];
    shEvaluate4(seen.direction, y);
    log0 += vec4(y[0], y[1], y[2], y[3]) * zonal.xyyy;
    log1 += vec4(y[4], y[5], y[6], y[7]) * zonal.z;
    log2 += vec4(y[8], y[9], y[10], y[11]) * zonal.zwww;
    log3 += vec4(y[12], y[13], y[14], y[15]) * zonal.w;
  }
}

#endif
