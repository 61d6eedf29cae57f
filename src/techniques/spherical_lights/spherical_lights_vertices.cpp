// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 7.4 (SL-10): receivers are the vertices of the scene, wherever they are; pixels lie between those of
// their triangle.
#include <fmt/format.h>

#include "shaders/spherical_lights_shaders.h"
#include "techniques/spherical_lights/spherical_lights_step.h"

namespace gloam::spherical_lights {

VertexPoints recordVertices(const Step& step) {
  const frame::GpuScene& scene = step.inputs.scene;
  std::vector<std::uint32_t> first;
  std::uint64_t count = 0;
  for (const frame::InstanceRow& instance : scene.instances()) {
    first.push_back(std::uint32_t(count));
    count += scene.meshes()[instance.mesh].vertex_count;
  }
  const std::uint64_t most = std::uint64_t(kVertexColumns) * step.graph.device().limits().max_image_size;
  if (count > most)
    throw Error("spherical_lights.receivers", fmt::format("{} vertices, expected {} at most", count, most));
  const int rows = std::max(1, int((count + kVertexColumns - 1) / kVertexColumns));
  const auto image = [&](const char* name) {
    return step.graph.create(
        name, gpu::ImageDesc{
                  .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = int(kVertexColumns), .height = rows});
  };
  const auto instances = std::uint32_t(first.size());
  const VertexPoints points{image("spherical_lights.vertex_position"),
                            image("spherical_lights.vertex_normal"),
                            uploadRows(step.graph, "spherical_lights.first_points", std::move(first))};
  step.graph.compute("spherical_lights.vertices", spherical_lights_vertices_spv)
      .read("positions", scene.positions())
      .read("normals", scene.normals())
      .read("instances", scene.instanceRows())
      .read("first_points", points.first)
      .write("point_position", points.position)
      .write("point_normal", points.normal)
      .push(VertexParams{instances, std::uint32_t(count)})
      .dispatchOver(points.position);
  return points;
}

void recordInterpolation(const Step& step, const VertexPoints& vertices, gpu::ImageRef vertex_direct,
                         gpu::ImageRef vertex_indirect, gpu::ImageRef direct, gpu::ImageRef indirect) {
  auto& pass = step.graph.compute("spherical_lights.interpolate", spherical_lights_interpolate_spv)
                   .read("frame_view", step.inputs.view)
                   .read("ids", step.inputs.gbuffer.ids)
                   .read("first_points", vertices.first)
                   .read("vertex_direct", vertex_direct)
                   .read("vertex_indirect", vertex_indirect)
                   .write("direct", direct)
                   .write("indirect", indirect);
  step.inputs.scene.bindTriangles(pass).dispatchOver(direct);
}

}  // namespace gloam::spherical_lights
