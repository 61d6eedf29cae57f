// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a pixel's Phong lobe gathers of the radiance at the three vertices around it: interpolated, convolved with the lobe
// of the pixel's exponent, taken at the mirror direction about its shading normal (PRT-2, PRT-8; RF-5). What carries no
// glossy transfer gets the unshadowed lobe. Negative sums, which ringing leaves, are damped by a blunter lobe, or count
// as 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/gloss.glsl"
#define GLOAM_TRIANGLE_SET 1
#include "frame/triangle.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int field_order = 5;
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool damped = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform usampler2D ids;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D diffuse;
layout(set = 0, binding = 4) uniform sampler2D specular;
layout(set = 0, binding = 5) uniform sampler3D gloss;
layout(scalar, set = 0, binding = 6) readonly buffer GlossRows { GlossRow at[]; } gloss_rows;
layout(scalar, set = 0, binding = 7) readonly buffer Fields { uint at[]; } fields;
layout(set = 0, binding = 8) uniform writeonly image2D direct;
layout(set = 0, binding = 9) uniform writeonly image2D indirect;
layout(scalar, push_constant) uniform Push { float exposure; } push;

const uint kWords = has_indirect ? 3u : 2u;
const float kPi = 3.14159265;
const float kNoFactors[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

uvec3 first_words;  // of the three vertices
vec3 weights;
vec3 first, further, soft_first, soft_further;

/// Coefficient i of the interpolated radiance, by the weights of the lobe and of the blunter one.
void addCoefficient(uint i, float weight, float soft_weight) {
  vec3 direct_ = vec3(0.0), indirect_ = vec3(0.0);
  for (int k = 0; k < 3; ++k) {
    uint at = first_words[k] + i * kWords;
    vec2 a = unpackHalf2x16(fields.at[at]), b = unpackHalf2x16(fields.at[at + 1u]);
    direct_ += weights[k] * vec3(a, b.x);
    if (has_indirect) indirect_ += weights[k] * vec3(b.y, unpackHalf2x16(fields.at[at + 2u]));
  }
  first += weight * direct_;
  if (has_indirect) further += weight * indirect_;
  if (damped) {
    soft_first += soft_weight * direct_;
    if (has_indirect) soft_further += soft_weight * indirect_;
  }
}

#define ADD(i, l) addCoefficient(uint(i), factors[l] * y[i], soft_factors[l] * y[i]);
#define BANDS_3 ADD(0, 0) ADD(1, 1) ADD(2, 1) ADD(3, 1) ADD(4, 2) ADD(5, 2) ADD(6, 2) ADD(7, 2) ADD(8, 2)
#define BANDS_4 BANDS_3 ADD(9, 3) ADD(10, 3) ADD(11, 3) ADD(12, 3) ADD(13, 3) ADD(14, 3) ADD(15, 3)
#define BANDS_5 BANDS_4 ADD(16, 4) ADD(17, 4) ADD(18, 4) ADD(19, 4) ADD(20, 4) ADD(21, 4) ADD(22, 4) ADD(23, 4) ADD(24, 4)
#define BANDS_6 BANDS_5 ADD(25, 5) ADD(26, 5) ADD(27, 5) ADD(28, 5) ADD(29, 5) ADD(30, 5) ADD(31, 5) ADD(32, 5) \
  ADD(33, 5) ADD(34, 5) ADD(35, 5)
#define EVALUATE(order, count)    \
  {                               \
    float y[count];               \
    shEvaluate##order(axis, y);   \
    BANDS_##order                 \
    return;                       \
  }

/// Hann's window makes the lobe the blunter one.
void gather(vec3 axis, float factors[6]) {
  float soft_factors[6] = factors;
  if (damped) {
    for (int l = 0; l < 6; ++l)
      soft_factors[l] *= l < field_order ? 0.5 + 0.5 * cos(kPi * float(l) / float(field_order)) : 0.0;
  }
  if (field_order <= 3) EVALUATE(3, 9)
  if (field_order == 4) EVALUATE(4, 16)
  if (field_order == 5) EVALUATE(5, 25)
  EVALUATE(6, 36)
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  first = further = soft_first = soft_further = vec3(0.0);
  if (isCovered(id) && texelFetch(specular, pixel, 0).rgb != vec3(0.0)) {
    GlossRow row = gloss_rows.at[id.x - 1u];
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
    vec3 mirror = mirrorDirection(normal, -normalize(ray.direction));
    float exponent = phongExponent(texelFetch(diffuse, pixel, 0).a);
    if (row.first_vertex == kUnbaked) {
      first = environmentGloss(gloss, mirror, exponent);
    } else {
      uvec3 v = triangleVertices(id.x - 1u, id.y);
      weights = push.exposure * barycentrics(triangleCorners(id.x - 1u, v), ray.origin, ray.direction);
      first_words = (row.first_vertex + v) * uint(field_order * field_order) * kWords;
      float factors[6] = kNoFactors;
      if (row.exponent == 0.0) phongBandFactors(clamp(exponent, 1.0, kSharpestLobe[field_order]), factors);
      gather(row.object_from_world * mirror, factors);
      if (damped) {
        first = withoutRinging(first, soft_first);
        further = withoutRinging(further, soft_further);
      }
    }
  }
  imageStore(direct, pixel, vec4(max(first, vec3(0.0)), 1.0));
  if (has_indirect) imageStore(indirect, pixel, vec4(max(further, vec3(0.0)), 1.0));
}
