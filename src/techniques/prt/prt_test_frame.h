// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What tests of prt's run time draw, and how.
#pragma once

#include <initializer_list>
#include <utility>

#include "frame/test_frame.h"
#include "techniques/prt/prt.h"

namespace gloam::prt {

using Values = std::initializer_list<std::pair<const char*, const char*>>;

/// Without a window unless asked for: transfer in closed form is then light in closed form.
inline Settings settings(Values values = {}) {
  Settings result(info().options);
  result.set("window", "none");
  for (const auto& [name, value] : values) result.set(name, value);
  return result;
}

struct Picture {
  std::vector<float> direct, indirect, normal;
  std::vector<glm::uvec2> ids;
  PosedCamera camera;
  frame::FrameView view;
  Warnings warnings;
};
inline Picture draw(const Scene& scene, int size, const PosedCamera& camera, const Settings& settings,
                    std::size_t chunk_bytes = 0) {
  const PosedScene posed = pose(scene, 0.0f);
  frame::TestFrame frame(scene);
  Prt technique(gpu::testDevice(), chunk_bytes);
  const frame::FrameImages images = frame.draw(posed, camera, {.width = size, .height = size},
                                               [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                                                 return technique.record(graph, inputs, settings);
                                               });
  return {images.direct.image().downloadFloats(),
          images.indirect.image().downloadFloats(),
          images.normal.image().downloadFloats(),
          frame.ids(),
          camera,
          frame::makeView(camera, size, size, posed.bounds_min, posed.bounds_max),
          frame.warnings};
}

}  // namespace gloam::prt
