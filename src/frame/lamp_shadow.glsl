// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A point in the light of one lamp. Includers declare the uniform block light.row, the buffer shadow_views (of this lamp) and the
// sampler shadow_maps.
#ifndef GLOAM_FRAME_LAMP_SHADOW_GLSL
#define GLOAM_FRAME_LAMP_SHADOW_GLSL
#include "frame/lamp.glsl"
#include "frame/shadow.glsl"

/// Share of its light that arrives.
float lampShadow(vec3 position, vec3 geometric_normal) {
  if (light.row.map_count == 0u) return 1.0;
  uint face = light.row.map_count == 6u ? cubeFace(position - light.row.position) : 0u;
  return shadowFactor(shadow_views.at[face], shadow_maps, int(light.row.first_map + face), position, geometric_normal);
}

#endif
