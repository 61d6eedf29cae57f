// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/shade.h"

#include <fmt/format.h>

#include "shaders/frame_shaders.h"

namespace gloam::frame {

namespace {

/// Halves, as in the EXR files that hold it: 0.05 % steps; radiance above 65504 is clipped.
constexpr VkFormat kRadianceFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

gpu::ImageRef imageLike(gpu::FrameGraph& graph, const std::string& name, const GBuffer& gbuffer) {
  return graph.create(
      name, gpu::ImageDesc{.format = kRadianceFormat, .width = gbuffer.width, .height = gbuffer.height});
}

/// One black pixel, for inputs of a shader that this frame does not have.
gpu::ImageRef black(gpu::FrameGraph& graph) {
  const auto image = graph.create("frame.black", gpu::ImageDesc{.format = kRadianceFormat});
  graph.clear("frame.black", image);
  return image;
}

gpu::ImageRef upsample(gpu::FrameGraph& graph, const FrameInputs& inputs, const Irradiance& term,
                       const std::string& name) {
  if (term.divisor == 1) return term.image;
  const ReceiverLevel& coarse = inputs.receivers.at(term.divisor);
  const auto full = imageLike(graph, name, inputs.gbuffer);
  graph.compute("frame.upsample", frame_upsample_spv)
      .specialize("along_surfaces", term.along_surfaces)
      .read("frame_view", inputs.view)
      .read("depth", inputs.gbuffer.depth)
      .read("normals", inputs.gbuffer.normals)
      .read("receiver_normal", coarse.normal_depth)
      .read("coarse", term.image)
      .write("full", full)
      .push(static_cast<std::uint32_t>(term.divisor))
      .dispatchOver(full);
  return full;
}

/// Empty where there is no term.
gpu::ImageRef sumOf(gpu::FrameGraph& graph, const GBuffer& gbuffer, const std::vector<gpu::ImageRef>& terms,
                    const std::string& name) {
  if (terms.empty()) return {};
  gpu::ImageRef sum = terms[0];
  for (std::size_t i = 1; i < terms.size(); ++i) {
    const auto both = imageLike(graph, fmt::format("{}_sum_{}", name, i), gbuffer);
    graph.compute("frame.add", frame_add_spv)
        .read("a", sum)
        .read("b", terms[i])
        .write("both", both)
        .dispatchOver(both);
    sum = both;
  }
  return sum;
}

}  // namespace

gpu::ImageRef recordLocalLight(gpu::FrameGraph& graph, const FrameInputs& inputs) {
  const ShadowMaps& shadows = inputs.shadow_maps;
  if (shadows.lights.empty()) return {};
  // Sums of many lamps are kept in floats.
  const auto local_light =
      graph.create("frame.local_light", gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                       .width = inputs.gbuffer.width,
                                                       .height = inputs.gbuffer.height});
  for (std::size_t i = 0; i < shadows.lights.size(); ++i) {
    auto& pass = graph.compute("frame.local_light", frame_local_light_spv);
    (i == 0 ? pass.write("local_light", local_light) : pass.readWrite("local_light", local_light))
        .specialize("first", i == 0)
        .read("frame_view", inputs.view)
        .read("light", shadows.lightRow(i))
        .read("shadow_views", shadows.viewRows(i))
        .sample("shadow_maps", shadows.maps, gpu::kNearestClamp)
        .read("depth", inputs.gbuffer.depth)
        .read("normals", inputs.gbuffer.normals)
        .read("diffuse", inputs.gbuffer.diffuse)
        .read("specular", inputs.gbuffer.specular)
        .dispatchOver(local_light);
  }
  return local_light;
}

gpu::ImageRef gatherIrradiance(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                               Path path) {
  const std::string name = path == Path::kDirect ? "frame.irradiance_direct" : "frame.irradiance_indirect";
  std::vector<gpu::ImageRef> terms;
  for (const Irradiance& term : lighting.irradiance) {
    if (term.path != path) continue;
    terms.push_back(upsample(graph, inputs, term, fmt::format("{}_{}", name, terms.size())));
  }
  return sumOf(graph, inputs.gbuffer, terms, name);
}

gpu::ImageRef gatherGloss(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                          Path path) {
  std::vector<gpu::ImageRef> terms;
  for (const Gloss& term : lighting.gloss) {
    if (term.path == path) terms.push_back(term.image);
  }
  return sumOf(graph, inputs.gbuffer, terms,
               path == Path::kDirect ? "frame.gloss_direct" : "frame.gloss_indirect");
}

Shaded recordShade(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                   gpu::ImageRef local_light, bool background) {
  const gpu::ImageRef direct = gatherIrradiance(graph, inputs, lighting, Path::kDirect);
  const gpu::ImageRef indirect = gatherIrradiance(graph, inputs, lighting, Path::kIndirect);
  const gpu::ImageRef gloss_direct = gatherGloss(graph, inputs, lighting, Path::kDirect);
  const gpu::ImageRef gloss_indirect = gatherGloss(graph, inputs, lighting, Path::kIndirect);
  // Where each sample is a pixel, these are the pictures already.
  const std::string suffix = inputs.gbuffer.supersample == 1 ? "" : "_samples";
  const Shaded shaded{imageLike(graph, "frame.direct" + suffix, inputs.gbuffer),
                      imageLike(graph, "frame.indirect" + suffix, inputs.gbuffer)};
  const gpu::ImageRef none = black(graph);
  const auto or_black = [&](gpu::ImageRef image) { return image ? image : none; };
  const EnvironmentLight& environment = inputs.environment;
  const bool mirrors = !lighting.has_environment_gloss && !environment.empty();
  const bool shown = background && !environment.empty();
  const EnvironmentPicture& picture = environment.picture();
  std::vector<DiscRow> discs = picture.discs();
  if (discs.empty()) discs.emplace_back();
  graph.compute("frame.shade", frame_shade_spv)
      .specialize("environment_gloss", mirrors)
      .specialize("technique_gloss", bool(gloss_direct) || bool(gloss_indirect))
      .specialize("background", shown)
      .specialize("background_alpha", background ? 1.0f : 0.0f)
      .read("frame_view", inputs.view)
      .read("environment", graph.uploadOne("frame.environment_row", picture.row()))
      .read("discs", graph.upload("frame.discs", discs))
      .sample("environment_map", shown ? picture.map() : picture.anyMap(), gpu::kLinearEquirect)
      .sample("gloss", mirrors ? environment.gloss() : environment.anyGloss())
      .read("depth", inputs.gbuffer.depth)
      .read("normals", inputs.gbuffer.normals)
      .read("diffuse", inputs.gbuffer.diffuse)
      .read("specular", inputs.gbuffer.specular)
      .read("emission", inputs.gbuffer.emission)
      .read("local_light", or_black(local_light))
      .read("irradiance_direct", or_black(direct))
      .read("irradiance_indirect", or_black(indirect))
      .read("gloss_direct", or_black(gloss_direct))
      .read("gloss_indirect", or_black(gloss_indirect))
      .write("direct", shaded.direct)
      .write("indirect", shaded.indirect)
      .dispatchOver(shaded.direct);
  return shaded;
}

FrameImages recordResolve(gpu::FrameGraph& graph, const FrameInputs& inputs, const Shaded& shaded,
                          bool layers) {
  const GBuffer& gbuffer = inputs.gbuffer;
  const int supersample = gbuffer.supersample;
  const auto image = [&](const char* name, VkFormat format) {
    return graph.create(name, gpu::ImageDesc{.format = format,
                                             .width = gbuffer.width / supersample,
                                             .height = gbuffer.height / supersample});
  };
  FrameImages images;
  images.color = image("frame.color", kRadianceFormat);
  if (supersample == 1) {
    images.direct = shaded.direct;
    images.indirect = shaded.indirect;
    graph.compute("frame.resolve", frame_add_spv)
        .read("a", images.direct)
        .read("b", images.indirect)
        .write("both", images.color)
        .dispatchOver(images.color);
  } else {
    images.direct = image("frame.direct", kRadianceFormat);
    images.indirect = image("frame.indirect", kRadianceFormat);
    graph.compute("frame.resolve", frame_resolve_spv)
        .read("direct_samples", shaded.direct)
        .read("indirect_samples", shaded.indirect)
        .write("color", images.color)
        .write("direct", images.direct)
        .write("indirect", images.indirect)
        .push(static_cast<std::uint32_t>(supersample))
        .dispatchOver(images.color);
  }
  if (!layers) return images;
  images.normal = image("frame.normal", VK_FORMAT_R16G16B16A16_SFLOAT);
  images.depth = image("frame.eye_depth", VK_FORMAT_R32_SFLOAT);
  images.albedo = image("frame.albedo", VK_FORMAT_R16G16B16A16_SFLOAT);
  images.object = image("frame.object", VK_FORMAT_R32_UINT);
  graph.compute("frame.layers", frame_layers_spv)
      .read("frame_view", inputs.view)
      .read("depth", gbuffer.depth)
      .read("ids", gbuffer.ids)
      .read("normals", gbuffer.normals)
      .read("diffuse", gbuffer.diffuse)
      .write("normal_layer", images.normal)
      .write("depth_layer", images.depth)
      .write("albedo_layer", images.albedo)
      .write("object_layer", images.object)
      .push(static_cast<std::uint32_t>(supersample))
      .dispatchOver(images.normal);
  return images;
}

}  // namespace gloam::frame
