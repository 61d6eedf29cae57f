// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// For the tests of frame/: scenes of a few shapes, and frames of which every image can be looked at.
#pragma once

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "frame/frame.h"
#include "frame/view.h"
#include "gpu/test_device.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam::frame {

inline PosedCamera cameraAt(const glm::vec3& eye, const glm::vec3& target, float fov_deg = 40.0f) {
  PosedCamera camera;
  camera.camera.vertical_fov_rad = glm::radians(fov_deg);
  camera.world_from_view = glm::inverse(glm::lookAt(eye, target, glm::vec3(0.0f, 1.0f, 0.001f)));
  return camera;
}

/// A grey ground of 20 x 20 under a sky, and a look at it from above.
inline Scene planeScene(const char* sky) {
  SceneBuilder builder("plane");
  builder.place("ground", shapes::ground(20, 20, 1, 1), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.sky(sky);
  return builder.finish();
}
inline const PosedCamera kAbove = cameraAt({0, 9, 0.01f}, {0, 0, 0}, 40);

/// A scene on the device and the frames drawn of it.
struct TestFrame {
  explicit TestFrame(const Scene& scene)
      : graph(gpu::testDevice()),
        gpu_scene(gpu::testDevice(), scene),
        environment(gpu::testDevice(), scene.environment) {}

  /// Draws with a technique that sees all inputs; by default one that adds no light.
  FrameImages draw(
      const PosedScene& posed, const PosedCamera& camera, const FrameOptions& options,
      const LightingStep& technique = [](gpu::FrameGraph&, const FrameInputs&) { return Lighting{}; }) {
    graph.begin();
    const FrameImages images = recordFrame(
        graph, gpu_scene, environment, posed, camera, options,
        [&](gpu::FrameGraph& g, const FrameInputs& inputs) {
          gbuffer = inputs.gbuffer;
          return technique(g, inputs);
        },
        memory, warnings);
    graph.execute();
    graph.wait();
    return images;
  }
  std::vector<float> floats(const std::string& name) { return graph.find(name).image().downloadFloats(); }
  std::vector<glm::uvec2> ids() { return graph.find("frame.ids").image().download<glm::uvec2>(); }

  gpu::FrameGraph graph;
  GpuScene gpu_scene;
  EnvironmentLight environment;
  FrameMemory memory;
  Warnings warnings;
  GBuffer gbuffer;
};

inline glm::vec3 pixelOf(const std::vector<float>& rgba, int width, int x, int y) {
  const std::size_t i = (std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4;
  return {rgba[i], rgba[i + 1], rgba[i + 2]};
}

}  // namespace gloam::frame
