// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rows as words (frame/lanes.glsl). Includers declare by_lanes, the buffers spheres, sent, glow, blocking_patches, sending_patches and
// patch_radiance of words, and push.params.
#ifndef GLOAM_SPHERICAL_LIGHTS_LANES_GLSL
#define GLOAM_SPHERICAL_LIGHTS_LANES_GLSL
#include "frame/lanes.glsl"

Ball ballAt(uint i) {
  Eight row;
  GLOAM_READ_EIGHT(row, spheres, 11u * i)
  return Ball(row.a.xyz, row.a.w, row.b.x, row.b.y, floatBitsToUint(row.b.z), floatBitsToUint(row.b.w));
}

PatchRow blockingPatch(uint j) {
  PatchRow row;
  GLOAM_READ_PATCH(row, blocking_patches, j)
  return row;
}
PatchRow sendingPatch(uint j) {
  PatchRow row;
  GLOAM_READ_PATCH(row, sending_patches, j)
  return row;
}
vec3 patchRadiance(uint j) {
  Eight p;
  GLOAM_READ_EIGHT(p, patch_radiance, 3u * j)
  return p.a.xyz;
}

vec3 eightOf(Eight p, Eight q, Eight r, vec4 f, vec4 g) {
  return f.x * p.a.xyz + f.y * vec3(p.a.w, p.b.xy) + f.z * vec3(p.b.zw, q.a.x) + f.w * q.a.yzw + g.x * q.b.xyz +
         g.y * vec3(q.b.w, r.a.xy) + g.z * vec3(r.a.zw, r.b.x) + g.w * r.b.yzw;
}
/// What sphere i sends, where f is averageAt.
#define GLOAM_SENT(buffer, i, f)                                   \
  Eight p, q, r, s, t, u;                                          \
  GLOAM_READ_EIGHT(p, buffer, 48u * (i))                           \
  GLOAM_READ_EIGHT(q, buffer, 48u * (i) + 8u)                      \
  GLOAM_READ_EIGHT(r, buffer, 48u * (i) + 16u)                     \
  GLOAM_READ_EIGHT(s, buffer, 48u * (i) + 24u)                     \
  GLOAM_READ_EIGHT(t, buffer, 48u * (i) + 32u)                     \
  GLOAM_READ_EIGHT(u, buffer, 48u * (i) + 40u)                     \
  return max(eightOf(p, q, r, f.a, f.b) + eightOf(s, t, u, f.c, f.d), vec3(0.0));
vec3 radianceOf(uint i, Sh4 f) { GLOAM_SENT(sent, i, f) }
vec3 glowOf(uint i, Sh4 f) { GLOAM_SENT(glow, i, f) }

#endif
