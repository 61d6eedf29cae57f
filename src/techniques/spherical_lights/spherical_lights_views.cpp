// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures to look at: what spheres send, and what their samples have. `--show spherical_lights.NAME` draws them.
#include <algorithm>
#include <array>

#include "shaders/spherical_lights_shaders.h"
#include "techniques/spherical_lights/spherical_lights_step.h"

namespace gloam::spherical_lights {

namespace {

/// In the order of kViewSamples …
constexpr std::array<const char*, 3> kViews = {"spherical_lights.samples", "spherical_lights.emission",
                                               "spherical_lights.average"};

}  // namespace

void recordView(const Step& step, const Sending& sending) {
  const auto found = std::ranges::find(kViews, step.inputs.show);
  if (found == kViews.end()) return;
  const frame::GBuffer& gbuffer = step.inputs.gbuffer;
  const gpu::ImageRef view = step.graph.create(
      *found, gpu::ImageDesc{.format = kHalves, .width = gbuffer.width, .height = gbuffer.height});
  step.graph.compute("spherical_lights.view", spherical_lights_view_spv)
      .specialize("what", int(found - kViews.begin()))
      .specialize("glows", !step.rows.glow.empty())
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("points", sending.points)
      .read("arriving", sending.arriving)
      .read("spheres", step.spheres)
      .read("sent", sending.sent)
      .read("glow", step.glow)
      .read("light", step.light)
      .write("view", view)
      .push(step.params.spheres)
      .dispatchOver(view);
}

}  // namespace gloam::spherical_lights
