// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// RF-5: the averaged field through the pixel's lobes, about its own normal (maps included) and mirror direction, with what three
// bands lack; or the averaged light of the classical filter as it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#include "techniques/radiance_filter/radiance_filter_beams.glsl"
#include "techniques/radiance_filter/radiance_filter_values.glsl"

layout(constant_id = 1) const bool beams = true;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 2) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform usampler2D normals;
layout(set = 0, binding = 5) uniform sampler2D diffuse;
layout(set = 0, binding = 6) uniform writeonly image2D irradiance;
layout(set = 0, binding = 7) uniform writeonly image2D gloss;
layout(scalar, push_constant) uniform Push { int part; } push;

const float kPi = 3.14159265;
const float kLargestHalf = 65504.0;

/// What three bands lack of the light of one colour.
void addBeyond(inout float to_diffuse, inout float to_gloss, Beams beams_, vec3 normal, vec3 mirror, float n, float shown) {
  to_diffuse += irradianceBeyond(beams_, normal);
  to_gloss += glossBeyond(beams_, n, shown, mirror);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(irradiance)))) return;
  float d = texelFetch(depth, pixel, 0).x;
  vec3 to_diffuse = vec3(0.0), to_gloss = vec3(0.0);
  if (d > 0.0) {
    if (field) {
      vec3 light[9];
      readField(light, pixel, push.part);
      vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
      Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
      vec3 position = ray.origin + ray.direction * eyeDepth(frame_view.view, d);
      vec3 mirror = mirrorDirection(normal, directionToEye(frame_view.view, position));
      to_diffuse = kPi * shadeLambert3(light, normal);
      float exponent = phongExponent(texelFetch(diffuse, pixel, 0).a), shown = min(exponent, kSharpestLobe);
      to_gloss = shadePhong3(light, mirror, shown);
      if (beams) {  // written out: software drivers spill arrays whose index a loop counts
        addBeyond(to_diffuse.r, to_gloss.r, beamsOf(light, 0), normal, mirror, exponent, shown);
        addBeyond(to_diffuse.g, to_gloss.g, beamsOf(light, 1), normal, mirror, exponent, shown);
        addBeyond(to_diffuse.b, to_gloss.b, beamsOf(light, 2), normal, mirror, exponent, shown);
      }
    } else {
      readLobes(to_diffuse, to_gloss, pixel, push.part);
    }
  }
  imageStore(irradiance, pixel, vec4(clamp(to_diffuse, 0.0, kLargestHalf), 1.0));
  imageStore(gloss, pixel, vec4(clamp(to_gloss, 0.0, kLargestHalf), 1.0));
}
