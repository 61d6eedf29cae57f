// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What C++ and shaders both know about a frame: the camera, instances, materials, lights.
#ifndef GLOAM_FRAME_SHARED_H
#define GLOAM_FRAME_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(frame)

GLOAM_SHARED_CONST uint kAbsent = 0xffffffffu;

/// The camera of this frame. Pixels count from the top left corner; centres are at + 1/2. Depth is reversed:
/// 1 at the near plane, 0 infinitely far (perspective) or at the far plane (orthographic).
struct FrameView {
  mat4 clip_from_world;
  mat4 previous_clip_from_world;
  vec3 eye;
  float z_near;
  vec3 forward;       // unit
  float depth_range;  // orthographic: far - near; perspective: 0
  vec3
      corner;  // pixel (x, y) looks along corner + x step_x + y step_y (perspective), or from eye + that (orthographic)
  uint width;
  vec3 step_x;
  uint height;
  vec3 step_y;
};
GLOAM_SHARED_SIZE(FrameView, 204)

/// Geometry of one mesh. `first_uv` has one entry a texture slot: base colour, metallic-roughness, normal,
/// emission.
struct MeshRow {
  uint first_vertex;
  uint first_index;
  uint material;
  uint first_color;  // kAbsent: white
  uvec4 first_uv;    // kAbsent: (0, 0)
};
GLOAM_SHARED_SIZE(MeshRow, 32)

/// One mesh standing in the world; rows stand in the order of PosedScene::instances. Object ids are row + 1.
struct InstanceRow {
  mat4x3 world_from_object;
  mat4x3 previous_world_from_object;
  mat3 world_from_normal;  // inverse transpose up to a positive factor
  float handedness;        // -1 where the matrix mirrors
  uint
      first_vertex;  // of positions, normals, tangents: the mesh's, or the instance's own where it is deformed
  uint previous_first_vertex;
  uint mesh;
};
GLOAM_SHARED_SIZE(InstanceRow, 148)

GLOAM_SHARED_CONST uint kMaterialNormalMap = 1u;

struct MaterialRow {
  vec4 base_color;
  vec3 emission;
  float metallic;
  float roughness;
  float specular;
  float normal_scale;
  float alpha_cutoff;
  uint flags;
  vec4 texture_from_uv[4];  // columns of the 2x2 part; slots as in MeshRow::first_uv
  vec2 texture_offset[4];
};
GLOAM_SHARED_SIZE(MaterialRow, 148)

GLOAM_SHARED_CONST uint kLightDirectional = 0u;
GLOAM_SHARED_CONST uint kLightPoint = 1u;
GLOAM_SHARED_CONST uint kLightSpot = 2u;

/// A punctual light. Its shadow maps are layers first_map …: one, or six (the faces of a cube).
struct LightRow {
  vec3 position;
  uint kind;
  vec3 direction;  // the way it shines
  float range;     // 0: unlimited
  vec3 intensity;
  float cos_inner;
  float cos_outer;
  uint first_map;
  uint map_count;
  uint unused[49];  // as ShadowView
};
GLOAM_SHARED_SIZE(LightRow, 256)

/// One layer of the shadow maps. Depth is reversed as in FrameView. As long as the step at which any device
/// binds parts of buffers, so that each lamp binds its own rows.
struct ShadowView {
  mat4 clip_from_world;
  vec3 origin;
  float z_near;  // perspective
  vec3 right;
  float half_width;  // at distance 1 (perspective) or everywhere (orthographic)
  vec3 up;
  float half_height;
  vec3 forward;
  float depth_range;  // orthographic; perspective: 0
  float unused[32];
};
GLOAM_SHARED_SIZE(ShadowView, 256)

/// The sharpest Phong lobe that order 6 shows without rings: its truncated kernel dips to -6 % of its peak
/// (exponent 20: -11 %, a mirror: -17 %). Sharper materials are shown with this exponent.
GLOAM_SHARED_CONST float kSharpestGloss = 10.0f;

/// What lobes show of the environment, tabulated: directions by an octahedral map of kGlossSize texels a side
/// and one more around it, exponents from 1 to kSharpestGloss in equal steps of their logarithm.
GLOAM_SHARED_CONST int kGlossSize = 32;
GLOAM_SHARED_CONST int kGlossSlices = 8;

/// A volume in its box, whose texture coordinates are 0 to 1.
struct VolumeRow {
  mat4x3 box_from_world;
  vec3 side;   // of the box, in the node: lengths that extinction counts by
  float step;  // of the march, in the node
};
GLOAM_SHARED_SIZE(VolumeRow, 64)

/// How to look up the environment's picture.
struct EnvironmentRow {
  float cos_rotation;
  float sin_rotation;
  float intensity;
  float map_width;
  float map_height;
  uint disc_count;
};
GLOAM_SHARED_SIZE(EnvironmentRow, 24)

/// A disc of even radiance, infinitely far away.
struct DiscRow {
  vec3 direction;
  float radius_rad;
  vec3 radiance;
};
GLOAM_SHARED_SIZE(DiscRow, 28)

GLOAM_SHARED_END
#endif
