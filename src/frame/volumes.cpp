// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/volumes.h"

#include <fmt/format.h>

#include <algorithm>

#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

VolumeRow rowOf(const VolumeLight& volume) {
  const glm::vec3 side = volume.bounds_max - volume.bounds_min;
  glm::mat4 node_from_box(1.0f);
  for (int c = 0; c < 3; ++c) node_from_box[c][c] = side[c];
  node_from_box[3] = glm::vec4(volume.bounds_min, 1.0f);
  const gpu::ImageDesc& desc = volume.direct.image().desc();
  const glm::vec3 cell = side / glm::vec3(desc.width, desc.height, desc.depth);
  return {.box_from_world = glm::mat4x3(glm::inverse(volume.world_from_node * node_from_box)),
          .side = side,
          .step = std::min({cell.x, cell.y, cell.z})};
}

/// From the eye to the middle of the box.
float distanceTo(const VolumeLight& volume, const glm::vec3& eye) {
  const glm::vec4 middle(0.5f * (volume.bounds_min + volume.bounds_max), 1.0f);
  return glm::length(glm::vec3(volume.world_from_node * middle) - eye);
}

}  // namespace

void recordVolumes(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                   const glm::vec3& eye, const Shaded& shaded) {
  const std::size_t in_scene = inputs.scene.volumes().size();
  if (lighting.volumes.size() < in_scene)
    inputs.warnings.push_back(
        fmt::format("{} of {} volume{} left out: --technique prt draws those that are baked",
                    in_scene - lighting.volumes.size(), in_scene, in_scene == 1 ? "" : "s"));
  std::vector<VolumeLight> volumes = lighting.volumes;
  std::ranges::stable_sort(volumes, [&](const VolumeLight& a, const VolumeLight& b) {
    return distanceTo(a, eye) > distanceTo(b, eye);
  });
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    graph.compute("frame.volume", frame_volume_spv)
        .read("frame_view", inputs.view)
        .read("volume", graph.uploadOne(fmt::format("frame.volume_row_{}", i), rowOf(volumes[i])))
        .read("depth", inputs.gbuffer.depth)
        .sample("volume_direct", volumes[i].direct, gpu::kLinearClamp)
        .sample("volume_indirect", volumes[i].indirect, gpu::kLinearClamp)
        .readWrite("direct", shaded.direct)
        .readWrite("indirect", shaded.indirect)
        .dispatchOver(shaded.direct);
  }
}

}  // namespace gloam::frame
