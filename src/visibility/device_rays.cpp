// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/device_rays.h"

#include "shaders/visibility_shaders.h"
#include "visibility/host_world.h"

namespace gloam::visibility {

namespace {

constexpr std::uint32_t kRow = 64 * 4096;  // points: groups stay within what any device takes

std::size_t triangleCount(const frame::GpuScene& scene) {
  std::size_t count = 0;
  for (const frame::InstanceRow& row : scene.instances()) count += scene.meshes()[row.mesh].index_count / 3;
  return count;
}

std::vector<BoxTriangle> worldTriangles(const HostWorld& world) {
  std::vector<BoxTriangle> triangles;
  for (const Instance& instance : world.posed().instances) {
    const Mesh& mesh = world.scene().meshes[std::size_t(instance.mesh)];
    const auto place = [&](std::uint32_t v) {
      return instance.deformed() ? instance.deformed_positions[v]
                                 : glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[v], 1.0f));
    };
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const glm::vec3 corner = place(mesh.indices[3 * t]);
      triangles.push_back(
          {corner, place(mesh.indices[3 * t + 1]) - corner, place(mesh.indices[3 * t + 2]) - corner});
    }
  }
  return triangles;
}

}  // namespace

void DeviceRays::update(const gpu::HostAccess& access, const HostWorld& world) {
  if (layout_ == world.layoutRevision() && pose_ == world.poseRevision()) return;
  const std::vector<BoxTriangle> triangles = worldTriangles(world);
  const bool same_tree = layout_ == world.layoutRevision() && tree_.triangles().size() == triangles.size();
  if (!same_tree || !tree_.refit(triangles)) tree_.build(triangles);
  layout_ = world.layoutRevision();
  pose_ = world.poseRevision();
  access.upload(nodes_, std::span<const BoxNode>(tree_.nodes()));
  if (!triangles.empty()) access.upload(triangles_, std::span<const BoxTriangle>(tree_.triangles()));
}

void DeviceRays::record(gpu::FrameGraph& graph, const std::string& name, const frame::GpuScene& scene,
                        HostWorld& world, const Question& question, gpu::BufferRef visible) {
  const std::size_t count = std::max<std::size_t>(triangleCount(scene), 1);
  if (count > capacity_) {
    nodes_ = gpu::Buffer(device_, "visibility.nodes",
                         gpu::BufferDesc{.bytes = BoxTree::mostNodes(count) * sizeof(BoxNode)});
    triangles_ =
        gpu::Buffer(device_, "visibility.triangles", gpu::BufferDesc{.bytes = count * sizeof(BoxTriangle)});
    capacity_ = count;
    layout_ = 0;
  }
  auto& pass = graph.host(name + "_hierarchy");
  HostWorld::reads(pass, scene);
  pass.write(nodes_).write(triangles_);
  pass.run([this, &world, &scene](gpu::HostAccess& access) {
    world.update(access, scene);
    update(access, world);
  });
  const std::uint32_t row = std::min(question.point_count, kRow);
  const SightParams params{question.point_count, question.words, question.light_bytes / 4, question.set_count,
                           row};
  graph.compute(name, visibility_trace_spv)
      .read("points", question.points)
      .read("lights", question.lights)
      .read("sets", question.sets)
      .read("nodes", nodes_)
      .read("triangles", triangles_)
      .write("visible", visible)
      .push(params)
      .dispatchOver(int(row), int((question.point_count + row - 1) / row), int(question.words));
}

}  // namespace gloam::visibility
