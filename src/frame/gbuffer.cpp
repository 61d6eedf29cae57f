// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/gbuffer.h"

#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

constexpr std::array<const char*, kTextureSlots> kMapNames = {"base_color_map", "metallic_roughness_map",
                                                              "normal_map", "emission_map"};

}  // namespace

void drawSurface(gpu::RasterPass& pass, const GpuScene& scene, std::uint32_t mesh_index,
                 std::uint32_t first_place, std::uint32_t count) {
  const GpuMesh& mesh = scene.meshes()[mesh_index];
  auto& draw = pass.draw()
                   .specialize("textured", mesh.textured)
                   .specialize("alpha_mask", mesh.alpha_mask)
                   .specialize("vertex_colors", mesh.vertex_colors)
                   .read("material", scene.material(mesh.row.material));
  for (int slot = 0; slot < kTextureSlots; ++slot) {
    const Textures::Bound map = scene.textures().map(static_cast<int>(mesh.row.material), slot);
    draw.sample(kMapNames[std::size_t(slot)], *map.image, map.sampler);
  }
  draw.indexed(scene.indices(), mesh.index_count, count, mesh.row.first_index, 0, first_place);
}

GBuffer recordGBuffer(gpu::FrameGraph& graph, const GpuScene& scene, gpu::BufferRef view, int width,
                      int height, int supersample, const std::string& key) {
  bool stands = true;
  GBuffer gbuffer{.width = width * supersample, .height = height * supersample, .supersample = supersample};
  const auto image = [&](const char* name, VkFormat format) {
    const gpu::KeptImage kept = graph.keep(
        name, gpu::ImageDesc{.format = format, .width = gbuffer.width, .height = gbuffer.height}, key);
    stands &= kept.holds;
    return kept.image;
  };
  gbuffer.depth = image("frame.depth", VK_FORMAT_D32_SFLOAT);
  gbuffer.ids = image("frame.ids", VK_FORMAT_R32G32_UINT);
  gbuffer.normals = image("frame.normals_packed", VK_FORMAT_R32G32_UINT);
  gbuffer.diffuse = image("frame.diffuse", VK_FORMAT_R16G16B16A16_SFLOAT);
  gbuffer.specular = image("frame.specular", VK_FORMAT_R16G16B16A16_SFLOAT);
  gbuffer.emission = image("frame.emission", VK_FORMAT_R16G16B16A16_SFLOAT);
  if (stands) return gbuffer;

  const std::array<std::uint32_t, 4> nothing = {0, 0, 0, 0};
  const std::array<float, 4> black = {0.0f, 0.0f, 0.0f, 0.0f};
  auto& pass = graph.raster("frame.gbuffer", frame_gbuffer_vert_spv, frame_gbuffer_frag_spv)
                   .state({.depth_compare = VK_COMPARE_OP_GREATER})
                   .depth(gbuffer.depth, 0.0f)
                   .color("ids", gbuffer.ids, nothing)
                   .color("normals", gbuffer.normals, nothing)
                   .color("diffuse", gbuffer.diffuse, black)
                   .color("specular", gbuffer.specular, black)
                   .color("emission", gbuffer.emission, black)
                   .read("frame_view", view);
  scene.bindSurface(scene.bindPlaces(pass));
  for (const DrawRange& range : scene.draws())
    drawSurface(pass, scene, range.mesh, range.first_place, range.count);
  return gbuffer;
}

gpu::ImageRef recordMotion(gpu::FrameGraph& graph, const GpuScene& scene, const GBuffer& gbuffer,
                           gpu::BufferRef view) {
  const auto motion = graph.create(
      "frame.motion",
      gpu::ImageDesc{.format = VK_FORMAT_R16G16_SFLOAT, .width = gbuffer.width, .height = gbuffer.height});
  auto& pass = graph.compute("frame.motion", frame_motion_spv)
                   .read("frame_view", view)
                   .read("ids", gbuffer.ids)
                   .write("motion", motion);
  scene.bindTriangles(pass).dispatchOver(motion);
  return motion;
}

}  // namespace gloam::frame
