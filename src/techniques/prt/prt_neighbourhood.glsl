// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A place in a grid of radiance (prt_neighbourhood_field.cpp has the twins). GLOAM_RADIANCE_BINDING is the includer's.
#ifndef GLOAM_PRT_NEIGHBOURHOOD_GLSL
#define GLOAM_PRT_NEIGHBOURHOOD_GLSL
#include "techniques/prt/prt_neighbourhood_shared.h"

layout(scalar, set = 0, binding = GLOAM_RADIANCE_BINDING) readonly buffer Radiance { uint at[]; } radiance;

struct GridPlace {
  uint first_word;  // of the nearest lower corner's radiance
  uvec3 step_words;
  vec3 along;   // 0 to 1 within the cell
  float share;  // how much of the grid counts here; 0: nothing
};

GridPlace placeInGrid(NeighbourhoodGrid grid, vec3 place, uint words) {
  vec3 way = grid.way_from_place * vec4(place, 1.0), last = vec3(grid.size - 1u);
  vec3 fade = (grid.half_size - abs(way)) / (kNeighbourhoodFade * grid.half_size);
  float share = clamp(min(min(fade.x, fade.y), fade.z), 0.0, 1.0);
  vec3 beyond = max(abs(way) - grid.core, vec3(0.0));
  vec3 q = min(abs(way), grid.core) + grid.growth * log(1.0 + beyond / grid.growth);
  vec3 at = sign(way) * q / grid.spacing + 0.5 * last;
  uvec3 cell = uvec3(clamp(at, vec3(0.0), last - 1.0));
  uvec3 step_words = words * uvec3(1u, grid.size.x, grid.size.x * grid.size.y);
  return GridPlace(grid.first_word + cell.x * step_words.x + cell.y * step_words.y + cell.z * step_words.z, step_words,
                   clamp(at - vec3(cell), 0.0, 1.0), share * share * (3.0 - 2.0 * share));
}

uint cornerWord(GridPlace place, uint corner) {
  return place.first_word + (corner & 1u) * place.step_words.x + ((corner >> 1) & 1u) * place.step_words.y +
         (corner >> 2) * place.step_words.z;
}
float cornerWeight(GridPlace place, uint corner) {
  vec3 w = mix(1.0 - place.along, place.along, vec3(corner & 1u, (corner >> 1) & 1u, corner >> 2));
  return w.x * w.y * w.z;
}

/// What is left of light that is `open` without the object where it is `shadowed` with it, colour by colour. Shadow darkens,
/// whatever the bands' ringing says, and no further than to black.
vec3 leftInShadow(vec3 open, vec3 shadowed, float share) {
  vec3 left = clamp(shadowed / max(open, vec3(1e-9)), vec3(0.0), vec3(1.0));
  return mix(vec3(1.0), left, share * vec3(greaterThan(open, vec3(1e-9))));
}

/// Hann's window over the radiance, by band: what is gathered through it rings less and is mixed in where a colour falls
/// below 0, as in prt_gloss_pixels.comp.glsl.
float softened(uint band, int order) { return 0.5 + 0.5 * cos(3.14159265 * float(band) / float(order)); }

#endif
