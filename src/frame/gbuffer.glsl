// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How the G-buffer keeps its numbers. Normals: octahedral map, two 16-bit numbers in a word (Cigolle et al.
// 2014, "A survey of efficient representations for independent unit vectors"); the error stays below 6e-5
// rad.
#ifndef GLOAM_FRAME_GBUFFER_GLSL
#define GLOAM_FRAME_GBUFFER_GLSL

vec2 signOrOne(vec2 v) { return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

/// A place of the square -1 … 1 for a unit vector, and back.
vec2 octahedralPlace(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signOrOne(p);
}
vec3 octahedralDirection(vec2 p) {
  float z = 1.0 - abs(p.x) - abs(p.y);
  return normalize(vec3(z >= 0.0 ? p : (1.0 - abs(p.yx)) * signOrOne(p), z));
}

uint packNormal(vec3 n) { return packSnorm2x16(octahedralPlace(n)); }
vec3 unpackNormal(uint word) { return octahedralDirection(unpackSnorm2x16(word)); }

/// frame.normals holds (shading, geometric); both face the eye's side of the surface.
vec3 shadingNormal(uvec2 normals) { return unpackNormal(normals.x); }
vec3 geometricNormal(uvec2 normals) { return unpackNormal(normals.y); }

/// frame.ids holds (object id, triangle); object id 0 is no surface at all.
bool isCovered(uvec2 ids) { return ids.x != 0u; }

#endif
