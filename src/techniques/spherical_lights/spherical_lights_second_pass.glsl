// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the second pass reads at each receiver and writes there, whichever way it sums. Includers define GLOAM_ROW: the type of a row, or
// words.
layout(constant_id = 2) const bool has_indirect = true;
layout(constant_id = 3) const bool glows = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_position;
layout(set = 0, binding = 1) uniform sampler2D receiver_normal;
layout(scalar, set = 0, binding = 2) readonly buffer Spheres { GLOAM_ROW(SphereRow) at[]; } spheres;
layout(scalar, set = 0, binding = 3) readonly buffer Objects { ObjectRow at[]; } objects;
layout(scalar, set = 0, binding = 4) readonly buffer Sent { GLOAM_ROW(SentRow) at[]; } sent;
layout(scalar, set = 0, binding = 13) readonly buffer Glow { GLOAM_ROW(SentRow) at[]; } glow;
layout(scalar, set = 0, binding = 8) uniform LightBlock { LightRows row; } light;
layout(set = 0, binding = 9) uniform writeonly image2D direct;
layout(set = 0, binding = 10) uniform writeonly image2D indirect;
layout(set = 0, binding = 11) uniform writeonly image2D visibility;
layout(set = 0, binding = 12) uniform writeonly image2D unblocked;
layout(scalar, set = 0, binding = 20) readonly buffer BlockingPatches { GLOAM_ROW(PatchRow) at[]; } blocking_patches;
layout(scalar, set = 0, binding = 21) readonly buffer SendingPatches { GLOAM_ROW(PatchRow) at[]; } sending_patches;
layout(scalar, set = 0, binding = 22) readonly buffer PatchRadiance { GLOAM_ROW(vec3) at[]; } patch_radiance;
layout(scalar, push_constant) uniform Push { GatherParams params; } push;
