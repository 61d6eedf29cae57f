// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Ramamoorthi and Hanrahan 2001, "An efficient representation for irradiance environment maps": E(n) = sum of
// A_l L_lm y_lm(n), rows SH-2, SH-5, SH-9. Differs from the paper: any order from 2 to 6 (3 is the paper's),
// a window against ringing, and normals from the G-buffer, so that normal maps show.
#include "techniques/irradiance/irradiance.h"

#include "shaders/irradiance_shaders.h"
#include "techniques/irradiance/irradiance_shared.h"

namespace gloam::irradiance {

namespace {

/// Window "auto" damps the irradiance, not the light, as little as keeps it non-negative: the cosine itself
/// is a window.
sh::ShRgb irradianceOf(const sh::ShRgb& light, int order, const std::string& window) {
  using frame::Window;
  const sh::Zh cosine = sh::clampedCosine(order);
  if (window == "hann") return sh::convolve(frame::windowed(light, order, Window::kHann), cosine);
  if (window == "lanczos") return sh::convolve(frame::windowed(light, order, Window::kLanczos), cosine);
  const sh::ShRgb irradiance = sh::convolve(sh::truncated(light, order), cosine);
  return window == "auto" ? frame::windowed(irradiance, order, Window::kAuto) : irradiance;
}

}  // namespace

const TechniqueInfo& info() {
  static const std::vector<Option> options = {
      {.name = "order",
       .default_value = 3,
       .minimum = 2,
       .maximum = 6,
       .help = "bands of spherical harmonics"},
      {.name = "window",
       .default_value = std::string("auto"),
       .choices = {"none", "hann", "lanczos", "auto"},
       .help = "damping of ringing around small bright lights; auto: as little as keeps light non-negative"}};
  static const TechniqueInfo info = {.name = "irradiance",
                                     .summary = "unshadowed irradiance of distant light: the baseline",
                                     .covers = {.environment_direct = true, .local_direct = true},
                                     .options = options};
  return info;
}

frame::Lighting Irradiance::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                   const Settings& settings) {
  if (inputs.environment.empty()) return {};
  const int order = settings.integer("order");
  const sh::ShRgb sh = irradianceOf(inputs.environment.sh(), order, settings.choice("window"));
  IrradianceRow row{};
  for (int i = 0; i < sh.size(); ++i) row.sh[i] = sh[i];

  const auto irradiance =
      graph.create("irradiance.irradiance", gpu::ImageDesc{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                           .width = inputs.gbuffer.width,
                                                           .height = inputs.gbuffer.height});
  graph.compute("irradiance.evaluate", irradiance_evaluate_spv)
      .specialize("order", order)
      .read("light", graph.uploadOne("irradiance.light", row))
      .read("ids", inputs.gbuffer.ids)
      .read("normals", inputs.gbuffer.normals)
      .write("irradiance", irradiance)
      .dispatchOver(irradiance);
  return {.irradiance = {{.image = irradiance, .path = frame::Path::kDirect}}};
}

}  // namespace gloam::irradiance
