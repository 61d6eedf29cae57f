// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/standing.h"

#include <functional>
#include <string_view>

#include "gpu/shader_reload.h"
#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

template <class T>
void append(std::string& key, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  key.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Shaders may be edited while a program runs.
void append(std::string& key, std::initializer_list<const gpu::ShaderCode*> shaders) {
  for (const gpu::ShaderCode* shader : shaders) append(key, &gpu::currentShader(*shader));
}

template <class T>
void appendHash(std::string& key, const std::vector<T>& values) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  append(key, std::hash<std::string_view>{}(bytes));
}

}  // namespace

std::string sceneKey(const GpuScene& scene, const PosedScene& posed) {
  std::string key;
  append(key, scene.layoutRevision());
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    InstanceRow row = scene.instances()[i];  // what it was before is no matter
    row.previous_world_from_object = row.world_from_object;
    if (scene.deformed(i)) {  // the vertices' places in their buffer take turns
      row.first_vertex = 0;
      const Instance& instance = posed.instances[i];
      appendHash(key, instance.deformed_positions);
      appendHash(key, instance.deformed_normals);
      appendHash(key, instance.deformed_tangents);
    }
    row.previous_first_vertex = row.first_vertex;
    append(key, row);
  }
  return key;
}

std::string gbufferKey(const std::string& scene_key, const FrameView& view) {
  std::string key = scene_key;
  append(key, {&frame_gbuffer_vert_spv, &frame_gbuffer_frag_spv});
  FrameView now = view;
  now.previous_clip_from_world = now.clip_from_world;
  append(key, now);
  return key;
}

std::string shadowKey(const std::string& scene_key, const LightPlan& plan) {
  std::string key = scene_key;
  append(key, {&frame_depth_vert_spv, &frame_depth_masked_vert_spv, &frame_depth_masked_frag_spv});
  for (const ShadowView& view : plan.shadow_views) append(key, view);
  return key;
}

}  // namespace gloam::frame
