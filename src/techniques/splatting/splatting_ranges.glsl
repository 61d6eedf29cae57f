// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-3: how a texel's ranges and means are kept. Ranges: least and greatest component of the normal, 10 bits each; greatest and
// least value of the depth buffer (reversed: near, far). Means: depth, shading normal, part that shows a surface, its middle.
#ifndef GLOAM_SPLATTING_RANGES_GLSL
#define GLOAM_SPLATTING_RANGES_GLSL

struct Ranges {
  vec3 low, high;   // normal
  float near, far;  // values of the depth buffer; near 0: no surface
};

const Ranges kNothing = Ranges(vec3(1.0), vec3(-1.0), 0.0, 2.0);

uint packTens(vec3 v) {
  uvec3 u = uvec3(clamp(v * 511.0 + 511.5, 0.0, 1023.0));
  return u.x | (u.y << 10) | (u.z << 20);
}
vec3 unpackTens(uint word) { return vec3(word & 1023u, (word >> 10) & 1023u, (word >> 20) & 1023u) / 511.0 - 1.0; }

uvec4 packRanges(Ranges r) { return uvec4(packTens(r.low), packTens(r.high), floatBitsToUint(r.near), floatBitsToUint(r.far)); }
Ranges unpackRanges(uvec4 words) {
  return Ranges(unpackTens(words.x), unpackTens(words.y), uintBitsToFloat(words.z), uintBitsToFloat(words.w));
}

Ranges joined(Ranges a, Ranges b) { return Ranges(min(a.low, b.low), max(a.high, b.high), max(a.near, b.near), min(a.far, b.far)); }

/// How much a component of the normal differs.
float normalSpan(Ranges r) {
  vec3 span = r.high - r.low;
  return max(span.x, max(span.y, span.z));
}

/// Difference of eye depths over the least. orthographic: (depth_range, z_near), else depth_range 0.
float depthSpan(Ranges r, vec2 orthographic) {
  if (orthographic.x <= 0.0) return r.near / max(r.far, 1e-30) - 1.0;
  return (r.near - r.far) * orthographic.x / max(orthographic.y + (1.0 - r.near) * orthographic.x, 1e-30);
}

struct Means {
  float depth;
  vec3 shading;   // not of length 1
  float covered;  // part of its pixels
  vec2 middle;    // of those, in parts of the texel
};

uvec4 packMeans(Means m) {
  return uvec4(floatBitsToUint(m.depth), packSnorm2x16(m.shading.xy),
               (packSnorm2x16(vec2(m.shading.z, 0.0)) & 0xffffu) | (uint(m.covered > 0.0 ? max(m.covered * 65535.0 + 0.5, 1.0) : 0.0) << 16),
               packUnorm2x16(m.middle));
}
Means unpackMeans(uvec4 words) {
  return Means(uintBitsToFloat(words.x), vec3(unpackSnorm2x16(words.y), unpackSnorm2x16(words.z).x), float(words.z >> 16) / 65535.0,
               unpackUnorm2x16(words.w));
}
bool isCovered(uvec4 means) { return (means.z >> 16) != 0u; }

#endif
