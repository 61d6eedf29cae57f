// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rows as they are (spherical_lights_lanes.glsl reads them as words). Includers declare the buffers spheres, blocking_patches,
// sending_patches and patch_radiance.
#ifndef GLOAM_SPHERICAL_LIGHTS_ROWS_GLSL
#define GLOAM_SPHERICAL_LIGHTS_ROWS_GLSL

Ball ballAt(uint i) { return ballOf(spheres.at[i]); }
PatchRow blockingPatch(uint j) { return blocking_patches.at[j]; }
PatchRow sendingPatch(uint j) { return sending_patches.at[j]; }
vec3 patchRadiance(uint j) { return patch_radiance.at[j]; }
Sh4 logOf(vec3 position, vec3 normal, uint j) { return logOf(position, normal, ballAt(j)); }

#endif
