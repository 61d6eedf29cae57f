// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, "Radiance filtering: instant global illumination on glossy and normal-mapped surfaces", section 3: the
// four steps. Differs: they had no real-time version; punctual lamps may be shaded outside the field; direct and indirect light
// may be kept apart.
#include "techniques/radiance_filter/radiance_filter.h"

#include <cstring>

#include "math/brdf.h"
#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

/// Exponent of a material's lobe without its textures; 0 where it has none.
float exponentOf(const frame::MaterialRow& material) {
  const bool shines = material.metallic > 0.0f || material.specular > 0.0f;
  return shines ? brdf::phongExponent(material.roughness) : 0.0f;
}

}  // namespace

void RadianceFilter::remarkSharpMaterials(const frame::FrameInputs& inputs, bool beams) {
  if (looked_at_ == inputs.scene.layoutRevision()) return;
  looked_at_ = inputs.scene.layoutRevision();
  if (inputs.scene.meshes().empty()) return;
  const gpu::Buffer& buffer = inputs.scene.material(0).buffer();
  std::vector<std::byte> rows(buffer.bytes());
  buffer.downloadBytes(rows);
  float sharpest = 0.0f;
  for (const frame::GpuMesh& mesh : inputs.scene.meshes()) {
    frame::MaterialRow row;
    std::memcpy(&row, rows.data() + inputs.scene.material(mesh.row.material).offset(), sizeof(row));
    sharpest = std::max(sharpest, exponentOf(row));
  }
  if (sharpest > kSharpestLobe)
    inputs.warnings.push_back(
        fmt::format("radiance_filter: gloss of exponents up to {:.0f} is shown as that of {:.0f}; three "
                    "bands carry no sharper{}",
                    sharpest, kSharpestLobe, beams ? " (direct light from one or two places is)" : ""));
}

frame::Lighting RadianceFilter::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                       const Settings& settings) {
  Plan plan = planOf(settings, inputs.gbuffer.width, inputs.gbuffer.height, inputs.warnings);
  plan.views = plan.views || inputs.show.starts_with("radiance_filter.");
  frame::Lighting lighting{.has_local_direct = plan.lamps_in_field, .has_environment_gloss = true};
  const vpls::Walks walks = walker_.record(graph, inputs, plan.walks, visibility_.world());
  if (walks.set_count == 0) {
    // Without lamps there is no light at all, which is said by whoever compares coverage with the scene.
    if (!inputs.shadow_maps.lights.empty())
      inputs.warnings.emplace_back(
          "no virtual lights were asked for (radiance_filter.direct, radiance_filter.indirect): lamps "
          "light, by their maps, and nothing else does");
    return lighting;
  }
  if (plan.keepsField()) remarkSharpMaterials(inputs, plan.beams);
  const Light light = recordGather(graph, inputs, plan, walks, visibility_);
  if (plan.views) recordViews(graph, plan, light.values, light.exposure, "radiance_filter.raw", false);
  HostResult result;
  if (filtersOnHost(graph.device(), plan)) {
    result = recordOnHost(graph, inputs, plan, light, surfaces_);
  } else {
    result.filtered = recordFilter(graph, inputs, plan, light);
  }
  if (plan.views) recordViews(graph, plan, result.filtered, light.exposure, "radiance_filter.bands", true);
  if (result.shaded.empty())
    result.shaded = recordShading(graph, inputs, plan, result.filtered, light.exposure);
  for (std::size_t part = 0; part < plan.parts.size(); ++part) {
    lighting.irradiance.push_back({.image = result.shaded[part].irradiance, .path = plan.parts[part]});
    lighting.gloss.push_back({.image = result.shaded[part].gloss, .path = plan.parts[part]});
  }
  return lighting;
}

}  // namespace gloam::radiance_filter
