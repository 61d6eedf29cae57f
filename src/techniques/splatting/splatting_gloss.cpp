// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, section 4.1, refine a list of subsplats a light where surfaces are glossy. Differs: pixels with gloss are the
// list, all lights theirs: what is mirrored changes from pixel to pixel with the normal.
#include "techniques/splatting/splatting_gloss.h"

#include "shaders/splatting_shaders.h"
#include "techniques/splatting/splatting_shared.h"

namespace gloam::splatting {

gpu::ImageRef recordGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const vpls::Vpls& vpls,
                          int bound_kind) {
  const int width = inputs.gbuffer.width, height = inputs.gbuffer.height;
  const auto gloss =
      graph.create("splatting.gloss",
                   gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = width, .height = height});
  const auto shiny =
      graph.create("splatting.shiny", gpu::BufferDesc{.bytes = 4 * std::size_t(width) * std::size_t(height)});
  const auto count = graph.create("splatting.shiny_count", gpu::BufferDesc{.bytes = sizeof(std::uint32_t)});
  const auto groups = graph.create("splatting.shiny_groups", gpu::BufferDesc{.bytes = sizeof(Groups)});
  graph.clear("splatting.gloss", gloss);
  graph.clear("splatting.shiny", count);
  graph.compute("splatting.shiny", splatting_shiny_spv)
      .read("depth", inputs.gbuffer.depth)
      .read("specular", inputs.gbuffer.specular)
      .readWrite("count", count)
      .write("shiny", shiny)
      .dispatchOver((width + 1) / 2, (height + 1) / 2);
  graph.compute("splatting.shiny", splatting_shiny_groups_spv)
      .read("count", count)
      .write("groups", groups)
      .dispatch(1);
  for (std::uint32_t i = 0; i < vpls.chunks(); ++i)
    graph.compute("splatting.gloss", splatting_gloss_spv)
        .specialize("first", i == 0)
        .specialize("bound_kind", bound_kind)
        .read("vpls", vpls.chunk(i))
        .read("frame_view", inputs.view)
        .read("depth", inputs.gbuffer.depth)
        .read("normals", inputs.gbuffer.normals)
        .read("diffuse", inputs.gbuffer.diffuse)
        .read("count", count)
        .read("shiny", shiny)
        .readWrite("gloss", gloss)
        .dispatchIndirect(groups);
  return gloss;
}

}  // namespace gloam::splatting
