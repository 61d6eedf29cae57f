// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/shadow_maps.h"

#include <algorithm>

#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

bool anyDrawn(const GpuScene& scene, bool masked) {
  return std::any_of(scene.draws().begin(), scene.draws().end(),
                     [&](const DrawRange& range) { return scene.meshes()[range.mesh].alpha_mask == masked; });
}

void addDraws(gpu::RasterPass& pass, const GpuScene& scene, const glm::mat4& clip_from_world, bool masked) {
  for (const DrawRange& range : scene.draws()) {
    const GpuMesh& mesh = scene.meshes()[range.mesh];
    if (mesh.alpha_mask != masked || isOutside(range, clip_from_world)) continue;
    auto& draw = pass.draw();
    if (masked) {
      const Textures::Bound map = scene.textures().map(static_cast<int>(mesh.row.material), 0);
      draw.sample("base_color_map", *map.image, map.sampler)
          .read("material", scene.material(mesh.row.material));
    }
    draw.indexed(scene.indices(), mesh.index_count, range.count, mesh.row.first_index, 0, range.first_place);
  }
}

}  // namespace

ShadowMaps recordShadowMaps(gpu::FrameGraph& graph, const GpuScene& scene, const LightPlan& plan,
                            const std::string& key) {
  ShadowMaps result;
  result.lights = plan.lights;
  result.light_rows = graph.upload("frame.lights", plan.lights);
  result.view_rows = graph.upload("frame.shadow_views", plan.shadow_views);
  const int layers = std::max(static_cast<int>(plan.shadow_views.size()), 1);
  const int size = plan.shadow_views.empty() ? 1 : plan.map_size;
  const gpu::KeptImage kept = graph.keep(
      "frame.shadow_maps",
      gpu::ImageDesc{.format = VK_FORMAT_D32_SFLOAT, .width = size, .height = size, .layers = layers}, key);
  result.maps = kept.image;
  if (kept.holds) return result;
  if (plan.shadow_views.empty()) {
    graph.clear("frame.shadow_maps", result.maps);
    return result;
  }
  const gpu::RasterState state{.depth_compare = VK_COMPARE_OP_GREATER, .depth_clamp = true};
  const bool has_masked = anyDrawn(scene, true);
  for (std::size_t i = 0; i < plan.shadow_views.size(); ++i) {
    const gpu::ImageRef map = result.maps.layer(static_cast<int>(i));
    const glm::mat4& clip_from_world = plan.shadow_views[i].clip_from_world;
    auto& pass = graph.raster("frame.shadow_maps", frame_depth_vert_spv)
                     .state(state)
                     .depth(map, 0.0f)
                     .push(clip_from_world);
    addDraws(scene.bindPlaces(pass), scene, clip_from_world, false);
    if (!has_masked) continue;
    auto& masked =
        graph.raster("frame.shadow_maps_masked", frame_depth_masked_vert_spv, frame_depth_masked_frag_spv)
            .state(state)
            .depth(map)
            .push(clip_from_world);
    addDraws(scene.bindMask(scene.bindPlaces(masked)), scene, clip_from_world, true);
  }
  return result;
}

}  // namespace gloam::frame
