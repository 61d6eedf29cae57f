// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One chunk of virtual lights in the Phong lobes of pixels that have gloss: sum of I max(0, N_l.V_ls) / max(d^2, b^2) times the
// lobe (n + 1) / (2 pi) (R.V)^n. A light stands for a disc of b^2 pi: its angle widens the lobe (1 / n + b^2 / (4 d^2), variances to
// each side), so that few lights do not show as points in what is polished.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#include "techniques/splatting/splatting_light.glsl"

layout(constant_id = 0) const bool first = true;  // nothing to add to yet

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform VplBlock { VplRow at[kVplChunk]; } vpls;
layout(scalar, set = 0, binding = 1) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D diffuse;
layout(scalar, set = 0, binding = 5) readonly buffer CountBlock { uint value; } count;
layout(scalar, set = 0, binding = 6) readonly buffer Shiny { uint at[]; } shiny;
layout(set = 0, binding = 7, rgba32f) uniform image2D gloss;

struct Mirrors {
  Receivers at;  // its normals are mirrored ways to the eye
  vec4 side_x, side_y, side_z, exponent;
};

void addGloss(inout Gathered sum, VplRow vpl, Mirrors m) {
  vec4 x = vpl.position.x - m.at.x, y = vpl.position.y - m.at.y, z = vpl.position.z - m.at.z;
  vec4 inverse = 1.0 / max(x * x + y * y + z * z, 1e-12), scale = sqrt(inverse);
  vec4 light_cosine = max(-(vpl.normal.x * x + vpl.normal.y * y + vpl.normal.z * z), 0.0) * scale;
  vec4 cosine = max(m.at.normal_x * x + m.at.normal_y * y + m.at.normal_z * z, 0.0) * scale;
  vec4 above = step(vec4(0.0), m.side_x * x + m.side_y * y + m.side_z * z);
  vec4 bounded = bound_kind == 0 ? inverse : min(inverse, 1.0 / max(vpl.bound, 1e-20));
  vec4 exponent = m.exponent / (1.0 + m.exponent * min(0.25 * vpl.bound * inverse, 1.0));
  vec4 lobe = (exponent + 1.0) * (0.5 * kInvPi) * exp2(exponent * log2(max(cosine, 1e-20)));
  vec4 weight = light_cosine * bounded * lobe * above;
  sum.red += vpl.intensity.r * weight;
  sum.green += vpl.intensity.g * weight;
  sum.blue += vpl.intensity.b * weight;
}

void main() {
  uint index = uint(kEach) * (gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x);
  if (index >= count.value) return;
  FrameView view = frame_view.view;
  Mirrors m;
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  for (int i = 0; i < kEach; ++i) {
    uint place = shiny.at[min(index + uint(i), count.value - 1u)];
    ivec2 pixel = ivec2(place & 0xffffu, place >> 16);
    Ray ray = pixelRay(view, vec2(pixel) + 0.5);
    vec3 position = ray.origin + ray.direction * eyeDepth(view, texelFetch(depth, pixel, 0).x);
    uvec2 packed_normals = texelFetch(normals, pixel, 0).xy;
    vec3 mirror = mirrorDirection(shadingNormal(packed_normals), directionToEye(view, position));
    vec3 side = geometricNormal(packed_normals);
    m.at.x[i] = position.x;
    m.at.y[i] = position.y;
    m.at.z[i] = position.z;
    m.at.normal_x[i] = mirror.x;
    m.at.normal_y[i] = mirror.y;
    m.at.normal_z[i] = mirror.z;
    m.side_x[i] = side.x;
    m.side_y[i] = side.y;
    m.side_z[i] = side.z;
    m.exponent[i] = phongExponent(texelFetch(diffuse, pixel, 0).a);
    vec4 before = first ? vec4(0.0) : imageLoad(gloss, pixel);
    sum.red[i] = before.r;
    sum.green[i] = before.g;
    sum.blue[i] = before.b;
  }
  // In halves, as in splatting_full.comp.glsl.
  for (int i = 0; i < kVplChunk / 2; ++i) addGloss(sum, vpls.at[i], m);
  for (int i = 0; i < kVplChunk / 2; ++i) addGloss(sum, vpls.at[kVplChunk / 2 + i], m);
  for (int i = 0; i < kEach; ++i) {
    if (index + uint(i) >= count.value) break;
    uint place = shiny.at[index + uint(i)];
    imageStore(gloss, ivec2(place & 0xffffu, place >> 16), vec4(sum.red[i], sum.green[i], sum.blue[i], 1.0));
  }
}
