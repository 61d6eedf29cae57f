// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What others' neighbourhoods leave of the light at a pixel, and what they throw there (PRT-6): the cosine lobe about the
// shading normal for what is not lit by baked vertices (those are done), the Phong lobe about the mirror direction for all.
// Shadows of several objects multiply, what they throw adds.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/gloss.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#define GLOAM_RADIANCE_BINDING 0
#include "techniques/prt/prt_neighbourhood.glsl"
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int field_order = 5;
layout(constant_id = 1) const bool has_thrown = true;
layout(constant_id = 2) const bool has_indirect_in = true;  // else there was none so far
layout(constant_id = 3) const bool has_gloss_in = true;
layout(constant_id = 4) const bool has_gloss_indirect_in = true;
layout(constant_id = 5) const bool damped = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 1) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D depth;
layout(set = 0, binding = 5) uniform sampler2D diffuse;
layout(set = 0, binding = 6) uniform sampler2D specular;
layout(set = 0, binding = 7) uniform sampler3D gloss;
layout(scalar, set = 0, binding = 8) readonly buffer Owners { uvec2 at[]; } owners;  // carrier, 1: lit by vertices
layout(scalar, set = 0, binding = 9) readonly buffer Grids { NeighbourhoodGrid at[]; } grids;
layout(scalar, set = 0, binding = 10) readonly buffer Light { vec3 at[]; } light;
layout(set = 0, binding = 11) uniform sampler2D direct_in;
layout(set = 0, binding = 12) uniform sampler2D indirect_in;
layout(set = 0, binding = 13) uniform sampler2D gloss_in;
layout(set = 0, binding = 14) uniform sampler2D gloss_indirect_in;
layout(set = 0, binding = 15) uniform writeonly image2D direct;
layout(set = 0, binding = 16) uniform writeonly image2D indirect;
layout(set = 0, binding = 17) uniform writeonly image2D gloss_direct;
layout(set = 0, binding = 18) uniform writeonly image2D gloss_indirect;
layout(scalar, push_constant) uniform Push { NeighbourhoodPixels params; } push;

const uint kWords = has_thrown ? 3u : 2u;
const uint kRows = uint(field_order * field_order);

vec3 open, shadowed, soft, thrown;

void addCoefficient(uint at, float weight, float soft_weight) {
  vec2 a = unpackHalf2x16(radiance.at[at]), b = unpackHalf2x16(radiance.at[at + 1u]);
  shadowed += weight * vec3(a, b.x);
  if (damped) soft += soft_weight * vec3(a, b.x);
  if (has_thrown) thrown += weight * vec3(b.y, unpackHalf2x16(radiance.at[at + 2u]));
}

#define ADD(i) addCoefficient(at + uint(i) * kWords, weight * y[i], weight * z[i]);
#define OPEN(i) open += y[i] * light.at[i];
#define BANDS_3(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8)
#define BANDS_4(DO) BANDS_3(DO) DO(9) DO(10) DO(11) DO(12) DO(13) DO(14) DO(15)
#define BANDS_5(DO) BANDS_4(DO) DO(16) DO(17) DO(18) DO(19) DO(20) DO(21) DO(22) DO(23) DO(24)
#define BANDS_6(DO) BANDS_5(DO) DO(25) DO(26) DO(27) DO(28) DO(29) DO(30) DO(31) DO(32) DO(33) DO(34) DO(35)
#define COSINE_3(DO) BANDS_3(DO)
#define COSINE_5(DO) BANDS_3(DO) DO(16) DO(17) DO(18) DO(19) DO(20) DO(21) DO(22) DO(23) DO(24)
#define GATHER(order, count, coefficients)          \
  {                                                 \
    float y[count], z[count];                       \
    shEvaluate##order(axis, y);                     \
    GLOAM_SH_SCALE_BANDS_##order(y, factors)        \
    z = y;                                          \
    GLOAM_SH_SCALE_BANDS_##order(z, soft_factors)   \
    coefficients(OPEN)                              \
    for (uint corner = 0u; corner < 8u; ++corner) { \
      uint at = cornerWord(place, corner);          \
      float weight = cornerWeight(place, corner);   \
      coefficients(ADD)                             \
    }                                               \
    if (damped) shadowed = withoutRinging(shadowed, soft); \
    return;                                         \
  }

float soft_factors[6];

/// The lobe of these band factors about an axis, over light as it is and as it is here.
void gatherPhong(GridPlace place, vec3 axis, float factors[6]) {
  open = shadowed = soft = thrown = vec3(0.0);
  if (field_order <= 3) GATHER(3, 9, BANDS_3)
  if (field_order == 4) GATHER(4, 16, BANDS_4)
  if (field_order == 5) GATHER(5, 25, BANDS_5)
  GATHER(6, 36, BANDS_6)
}

/// The same of the clamped cosine, which has nothing in bands 3 and 5.
void gatherCosine(GridPlace place, vec3 axis) {
  const float factors[6] = kShClampedCosineFactors;
  open = shadowed = soft = thrown = vec3(0.0);
  if (field_order <= 4) GATHER(3, 9, COSINE_3)
  GATHER(5, 25, COSINE_5)
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  uvec2 id = texelFetch(ids, pixel, 0).xy;
  vec3 irradiance = texelFetch(direct_in, pixel, 0).rgb, bounced = vec3(0.0), lobe = vec3(0.0), lobe_bounced = vec3(0.0);
  if (has_indirect_in) bounced = texelFetch(indirect_in, pixel, 0).rgb;
  if (has_gloss_in) lobe = texelFetch(gloss_in, pixel, 0).rgb;
  if (has_gloss_indirect_in) lobe_bounced = texelFetch(gloss_indirect_in, pixel, 0).rgb;
  if (isCovered(id)) {
    uvec2 owner = owners.at[id.x - 1u];
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    vec3 position = ray.origin + eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x) * ray.direction;
    vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
    vec3 mirror = mirrorDirection(normal, -normalize(ray.direction));
    float exponent = phongExponent(texelFetch(diffuse, pixel, 0).a);
    bool shines = texelFetch(specular, pixel, 0).rgb != vec3(0.0);
    if (!has_gloss_in && shines) lobe = environmentGloss(gloss, mirror, exponent);
    float phong[6];
    for (uint l = 0u; l < 6u; ++l) soft_factors[l] = int(l) < field_order ? softened(l, field_order) : 0.0;
    phongBandFactors(clamp(exponent, 1.0, kSharpestLobe[field_order]), phong);
    for (uint g = 0u; g < push.params.grid_count; ++g) {
      if (grids.at[g].carrier == owner.x) continue;
      GridPlace place = placeInGrid(grids.at[g], position, kRows * kWords);
      if (place.share == 0.0) continue;
      if (owner.y == 0u) {
        gatherCosine(place, normal);
        irradiance *= leftInShadow(open, shadowed, place.share);
        bounced += place.share * push.params.exposure * max(thrown, vec3(0.0));
      }
      if (shines) {
        gatherPhong(place, mirror, phong);
        lobe *= leftInShadow(open, shadowed, place.share);
        lobe_bounced += place.share * push.params.exposure * max(thrown, vec3(0.0));
      }
    }
  }
  imageStore(direct, pixel, vec4(irradiance, 1.0));
  imageStore(indirect, pixel, vec4(bounced, 1.0));
  imageStore(gloss_direct, pixel, vec4(lobe, 1.0));
  imageStore(gloss_indirect, pixel, vec4(lobe_bounced, 1.0));
}
