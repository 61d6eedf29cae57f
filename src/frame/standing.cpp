// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/standing.h"

#include <array>

#include "gpu/shader_reload.h"
#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

template <class T>
void append(std::string& key, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  key.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The instances where they are; what they were before is no matter. Shaders may be edited while a program runs.
std::string sceneKey(const GpuScene& scene, std::initializer_list<const gpu::ShaderCode*> shaders) {
  std::string key;
  append(key, scene.layoutRevision());
  for (const gpu::ShaderCode* shader : shaders) append(key, &gpu::currentShader(*shader));
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    if (scene.deformed(i)) return "";
    InstanceRow row = scene.instances()[i];
    row.previous_world_from_object = row.world_from_object;
    row.previous_first_vertex = row.first_vertex;
    append(key, row);
  }
  return key;
}

}  // namespace

std::string gbufferKey(const GpuScene& scene, const FrameView& view) {
  std::string key = sceneKey(scene, {&frame_gbuffer_vert_spv, &frame_gbuffer_frag_spv});
  if (key.empty()) return key;
  FrameView now = view;
  now.previous_clip_from_world = now.clip_from_world;
  append(key, now);
  return key;
}

std::string shadowKey(const GpuScene& scene, const LightPlan& plan) {
  std::string key =
      sceneKey(scene, {&frame_depth_vert_spv, &frame_depth_masked_vert_spv, &frame_depth_masked_frag_spv});
  if (key.empty()) return key;
  for (const ShadowView& view : plan.shadow_views) append(key, view);
  return key;
}

}  // namespace gloam::frame
