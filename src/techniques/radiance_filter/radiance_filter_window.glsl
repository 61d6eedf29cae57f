// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which pixels a pixel is averaged with (RF-4): of its object, near its tangent plane, not beyond a crease. Bindings 0 to 3 and
// the push constants are declared here, for all passes that ask.
#ifndef GLOAM_RADIANCE_FILTER_WINDOW_GLSL
#define GLOAM_RADIANCE_FILTER_WINDOW_GLSL
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/radiance_filter/radiance_filter_line.glsl"
#include "techniques/radiance_filter/radiance_filter_shared.h"

layout(constant_id = 0) const bool tests_normals = false;

layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(scalar, push_constant) uniform Push { FilterLimits limits; } push;

struct Surface {
  vec3 position;
  uint object;   // 0: none
  vec3 normal;   // geometric
  vec3 shading;  // where normals are tested
};

/// Pixels beyond the picture are of no object.
Surface surfaceAt(ivec2 pixel, ivec2 size) {
  bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
  pixel = clamp(pixel, ivec2(0), size - 1);
  Surface surface = Surface(vec3(0.0), inside ? texelFetch(ids, pixel, 0).x : 0u, vec3(0.0), vec3(0.0));
  uvec2 packed_ = texelFetch(normals, pixel, 0).xy;
  surface.normal = geometricNormal(packed_);
  Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
  surface.position = ray.origin + ray.direction * eyeDepth(frame_view.view, max(texelFetch(depth, pixel, 0).x, 1e-30));
  if (tests_normals) surface.shading = shadingNormal(packed_);
  return surface;
}

/// Metres off its tangent plane at which a pixel's surface ends.
float toleranceAt(vec3 position) {
  FrameView view = frame_view.view;
  float along = view.depth_range > 0.0 ? 1.0 : dot(position - view.eye, view.forward);
  return push.limits.tolerance * length(view.step_x) * along;
}

bool isSameSurface(Surface middle, float tolerance, Surface other) {
  return other.object != 0u && other.object == middle.object && dot(middle.normal, other.normal) >= kCrease &&
         abs(dot(middle.normal, other.position - middle.position)) <= tolerance &&
         (!tests_normals || dot(middle.shading, other.shading) >= push.limits.normal_cosine);
}

#endif
