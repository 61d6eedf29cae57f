// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_rays.h"

#include "frame/test_frame.h"

namespace gloam::visibility {
namespace {

/// Two facing points, one behind a wall that stands between.
TEST(HostRays, WallsAreInTheWayAndMove) {
  SceneBuilder builder("wall");
  const int white = builder.diffuse("white", glm::vec3(0.7f));
  builder.place("floor", shapes::ground(10, 10, 2, 2), white);
  const int wall = builder.place("wall", shapes::roundedBox({1, 1, 0.05f}, 0.01f, 0.5f, 1), white, {0, 1, 0});
  Scene scene = builder.finish();
  frame::TestFrame frame(scene);
  HostRays rays;
  const std::vector<Place> from = {{{0, 0, 2}, {0, 1, 0}, 1e-4f}, {{3, 0, 2}, {0, 1, 0}, 1e-4f}};
  const std::vector<Place> to = {{{0, 0.5f, -2}, {0, 0, 1}, 1e-4f},   // behind the wall from the first
                                 {{0, 0.5f, 4}, {0, 0, -1}, 1e-4f},   // on the first's side
                                 {{0, 0.5f, 4}, {0, 0, 1}, 1e-4f},    // turned away
                                 {{0, -1.0f, 4}, {0, 1, 0}, 1e-4f}};  // under the floor
  const auto seen = [&] {
    std::vector<std::uint64_t> bits(from.size());
    frame.draw(pose(scene, 0.0f), frame::cameraAt({0, 3, 6}, {0, 0, 0}), {.width = 8, .height = 8},
               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                 auto& pass = graph.host("test.rays");
                 HostRays::reads(pass, inputs.scene);
                 pass.run([&, gpu_scene = &inputs.scene](gpu::HostAccess& access) {
                   rays.update(access, *gpu_scene);
                   rays.trace(from, to, bits);
                 });
                 return frame::Lighting{};
               });
    return bits;
  };
  EXPECT_EQ(seen(), (std::vector<std::uint64_t>{0b0010, 0b0011}));
  EXPECT_EQ(rays.tracedRays(), 4u);
  scene.nodes[std::size_t(wall)].translation.y = 5.0f;
  EXPECT_EQ(seen(), (std::vector<std::uint64_t>{0b0011, 0b0011}));
}

}  // namespace
}  // namespace gloam::visibility
