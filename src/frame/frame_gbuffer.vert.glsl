// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Vertices are pulled: gl_VertexIndex is the vertex within its mesh, gl_InstanceIndex a place in the order of
// drawing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"

layout(constant_id = 0) const bool textured = true;
layout(constant_id = 2) const bool vertex_colors = false;

layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 2) readonly buffer Normals { vec3 at[]; } normals;
layout(scalar, set = 0, binding = 3) readonly buffer Tangents { vec4 at[]; } tangents;
layout(scalar, set = 0, binding = 4) readonly buffer Uvs { vec2 at[]; } uvs;
layout(scalar, set = 0, binding = 5) readonly buffer Colors { uvec2 at[]; } colors;  // four unorm16
layout(scalar, set = 0, binding = 6) readonly buffer Instances { InstanceRow at[]; } instances;
layout(scalar, set = 0, binding = 9) readonly buffer DrawOrder { uint at[]; } draw_order;
layout(scalar, set = 0, binding = 7) readonly buffer Meshes { MeshRow at[]; } meshes;
layout(scalar, set = 1, binding = 4) uniform MaterialBlock { MaterialRow row; } material;

layout(location = 0) out vec3 from_eye;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uv_base_color_and_roughness;
layout(location = 4) out vec4 uv_normal_and_emission;
layout(location = 5) out vec4 color;
layout(location = 6) flat out uint instance_row;

vec2 textureCoordinate(MeshRow mesh, int slot) {
  uint first = mesh.first_uv[slot];
  vec2 uv = first == kAbsent ? vec2(0.0) : uvs.at[first + gl_VertexIndex];
  vec4 m = material.row.texture_from_uv[slot];
  return m.xy * uv.x + m.zw * uv.y + material.row.texture_offset[slot];
}

void main() {
  instance_row = draw_order.at[gl_InstanceIndex];
  mat4x3 world_from_object = instances.at[instance_row].world_from_object;
  MeshRow mesh = meshes.at[instances.at[instance_row].mesh];
  uint vertex = instances.at[instance_row].first_vertex + gl_VertexIndex;

  vec3 world = world_from_object * vec4(positions.at[vertex], 1.0);
  gl_Position = frame_view.view.clip_from_world * vec4(world, 1.0);
  from_eye = world - frame_view.view.eye;
  normal = normalize(instances.at[instance_row].world_from_normal * normals.at[vertex]);
  // What the fragment shader does not read is neither fetched nor made.
  tangent = uv_base_color_and_roughness = uv_normal_and_emission = vec4(0.0);
  if (textured) {
    vec4 t = tangents.at[vertex];
    vec3 world_tangent = mat3(world_from_object) * t.xyz;
    float len = length(world_tangent);
    tangent = vec4(len > 0.0 ? world_tangent / len : vec3(0.0), t.w * instances.at[instance_row].handedness);
    uv_base_color_and_roughness = vec4(textureCoordinate(mesh, 0), textureCoordinate(mesh, 1));
    uv_normal_and_emission = vec4(textureCoordinate(mesh, 2), textureCoordinate(mesh, 3));
  }
  color = vec4(1.0);
  if (vertex_colors && mesh.first_color != kAbsent) {
    uvec2 c = colors.at[mesh.first_color + gl_VertexIndex];
    color = vec4(unpackUnorm2x16(c.x), unpackUnorm2x16(c.y));
  }
}
