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

#include "techniques/prt/prt_neighbourhood_lobes.glsl"

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
