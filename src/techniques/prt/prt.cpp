// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, "Precomputed radiance transfer for real-time rendering in dynamic, low-frequency
// lighting environments", sections 3 and 4: E_p = M_p . L, the light rotated into the object's axes. Differs
// from the paper: transfer is stored without the receiver's albedo, the direct and the interreflected part
// apart, and vertices' light is interpolated by a compute pass over the G-buffer. Rows PRT-1, PRT-4.
#include "techniques/prt/prt.h"

#include <fmt/format.h>

#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_glossy.h"
#include "techniques/prt/prt_relight.h"

namespace gloam::prt {

namespace {

/// Of the whole light; "auto" damps vertex by vertex (prt_relight.cpp).
frame::Window windowOf(const std::string& name) {
  return name == "auto" ? frame::Window::kNone : frame::windowNamed(name);
}

bool onHost(const gpu::Device& device, const Settings& settings) {
  const std::string choice = settings.choice("relight");
  return choice == "host" || (choice == "auto" && device.info().software);
}

UnbakedRow unbakedRow(const sh::ShRgb& light) {
  const sh::ShRgb irradiance = sh::convolve(light, sh::clampedCosine(light.order));
  UnbakedRow row{};
  for (int i = 0; i < irradiance.size(); ++i) row.sh[i] = irradiance[i];
  return row;
}

}  // namespace

const TransferBuffers& Prt::transferFor(const frame::FrameInputs& inputs, const TransferOptions& options) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  if (transfer_ && layout_revision_ == revision && transfer_->options() == options) return *transfer_;
  transfer_.reset();
  transfer_.emplace(device_, inputs.scene, options);
  layout_revision_ = revision;
  return *transfer_;
}

const NeighbourhoodBuffers& Prt::neighbourhoodFor(const frame::FrameInputs& inputs, int order, bool on_host) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  if (neighbourhood_ && neighbourhood_revision_ == revision && neighbourhood_->orderAskedFor() == order &&
      neighbourhood_->onHost() == on_host)
    return *neighbourhood_;
  neighbourhood_.reset();
  neighbourhood_.emplace(device_, inputs.scene, order, on_host);
  neighbourhood_revision_ = revision;
  return *neighbourhood_;
}

const VolumeBuffers& Prt::volumesFor(const frame::FrameInputs& inputs, int order) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  if (volumes_ && volumes_revision_ == revision && volumes_->orderAskedFor() == order) return *volumes_;
  volumes_.reset();
  volumes_.emplace(device_, inputs.scene, order, chunk_bytes_);
  volumes_revision_ = revision;
  return *volumes_;
}

const GlossyBuffers& Prt::glossyFor(const frame::FrameInputs& inputs, const GlossyOptions& options) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  if (glossy_ && glossy_revision_ == revision && glossy_->options() == options) return *glossy_;
  gloss_fields_ = {};
  glossy_.reset();
  glossy_.emplace(device_, inputs.scene, options);
  glossy_revision_ = revision;
  return *glossy_;
}

void Prt::addGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Settings& settings,
                   frame::Lighting& lighting) {
  const std::string choice = settings.choice("glossy");
  const bool local = settings.choice("local_light") != "off";
  if (choice == "unshadowed") return;
  const GlossyBuffers& glossy = glossyFor(inputs, {.order = settings.integer("order"),
                                                   .cheap = choice == "cheap" && !local,
                                                   .half_float = settings.flag("half_float"),
                                                   .on_host = onHost(device_, settings),
                                                   .chunk_bytes = chunk_bytes_});
  if (glossy.empty()) return;
  const sh::ShRgb light =
      frame::windowed(inputs.environment.sh(), glossy.lightOrder(), windowOf(settings.choice("window")));
  const bool damped = settings.choice("window") == "auto";
  LocalGloss of_probes;
  if (local) {
    if (glossy.lightOrder() > transfer_->order()) return;
    std::vector<std::uint32_t> first_outputs;
    for (const GlossRow& row : glossy.instanceRows(inputs.scene)) first_outputs.push_back(row.first_vertex);
    of_probes = {
        .lights = local_->lights(),
        .lamp_lights = local_->lampLights(),
        .places = local_->places(),
        .trust = local_->trust(),
        .rows = graph.upload("prt.local_gloss_rows", local_->rowsOf(inputs.scene, *transfer_, first_outputs)),
        .lamps = settings.choice("local_light") == "all",
        .points = local_->points(),
        .order = transfer_->order()};
    if (choice == "cheap")
      inputs.warnings.push_back("prt.glossy cheap: under local light it is drawn by matrices");
  }
  lighting.gloss = recordGloss(graph, inputs, glossy, light, damped, settings.flag("indirect"), gloss_fields_,
                               local ? &of_probes : nullptr);
  lighting.has_environment_gloss = true;
}

gpu::BufferRef Prt::lightVerticesLocally(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                         const TransferBuffers& transfer, const Settings& settings) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  const int points = settings.integer("local_points");
  if (!local_ || local_revision_ != revision || local_->points() != points) {
    local_.emplace(inputs.scene, transfer, points);
    local_revision_ = revision;
  }
  if (local_->objects().size() == 1 && transfer.litInstances().size() == inputs.scene.instances().size() &&
      transfer.litInstances().size() > 1)
    inputs.warnings.push_back(
        "prt.local_light: all was baked as one object, around which there is only sky; `gloam bake --apart` "
        "makes objects that light one another");
  const bool damped = settings.choice("window") == "auto";
  return local_->record(graph, inputs, transfer, probe_tables_,
                        {.lamps = settings.choice("local_light") == "all",
                         .size = settings.integer("local_size"),
                         .bounces = settings.integer("local_bounces"),
                         .damped = damped,
                         .window = windowOf(settings.choice("window"))});
}

frame::Lighting Prt::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                            const Settings& settings) {
  const TransferBuffers& transfer = transferFor(inputs, {.order = settings.integer("order"),
                                                         .half_float = settings.flag("half_float"),
                                                         .on_host = onHost(device_, settings),
                                                         .chunk_bytes = chunk_bytes_});
  if (!transfer.unbakedMeshes().empty())
    inputs.warnings.push_back(fmt::format("lit without shadows, as they move or are not baked: {}",
                                          fmt::join(transfer.unbakedMeshes(), ", ")));
  if (settings.integer("order") > transfer.order())
    inputs.warnings.push_back(fmt::format("prt.order {}: the scene is baked with {} bands",
                                          settings.integer("order"), transfer.order()));
  const bool local = settings.choice("local_light") != "off";
  if (inputs.environment.empty() && !local) return {};
  const sh::ShRgb light =
      frame::windowed(inputs.environment.sh(), transfer.order(), windowOf(settings.choice("window")));
  const gpu::BufferRef vertex_light =
      local ? lightVerticesLocally(graph, inputs, transfer, settings)
            : lightVertices(graph, inputs.scene, transfer, light, inputs.environment.sh(),
                            settings.choice("window") == "auto");

  std::optional<NeighbourhoodPasses> neighbourhood;
  // Local light sees the other objects in the way by itself.
  if (settings.flag("neighbourhood") && !local && !inputs.scene.carriers().shown().empty()) {
    const NeighbourhoodBuffers& buffers =
        neighbourhoodFor(inputs, settings.integer("order"), transfer.options().on_host);
    neighbourhood.emplace(
        graph, inputs, buffers, transfer,
        frame::windowed(inputs.environment.sh(), buffers.lightOrder(), windowOf(settings.choice("window"))),
        settings.choice("window") == "auto");
    neighbourhood->lightVertices(transfer, vertex_light);
  }

  const gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                            .width = inputs.gbuffer.width,
                            .height = inputs.gbuffer.height};
  const auto direct = graph.create("prt.irradiance_direct", desc);
  const auto indirect = graph.create("prt.irradiance_indirect", desc);
  auto& pixels = graph.compute("prt.pixels", prt_pixels_spv)
                     .specialize("order", transfer.order())
                     .read("frame_view", inputs.view)
                     .read("ids", inputs.gbuffer.ids)
                     .read("normals", inputs.gbuffer.normals)
                     .read("output_rows", transfer.outputRows())
                     .read("lightmap_uvs", inputs.scene.uvs())
                     .read("vertex_light", vertex_light)
                     .read("unbaked", graph.uploadOne("prt.unbaked", unbakedRow(light)))
                     .write("direct", direct)
                     .write("indirect", indirect);
  inputs.scene.bindTriangles(pixels).dispatchOver(direct);
  frame::Lighting lighting{.irradiance = {{.image = direct, .path = frame::Path::kDirect}}};
  lighting.has_local_direct = settings.choice("local_light") == "all";
  if ((transfer.hasIndirect() || local || neighbourhood) && settings.flag("indirect"))
    lighting.irradiance.push_back({.image = indirect, .path = frame::Path::kIndirect});
  addGloss(graph, inputs, settings, lighting);
  if (neighbourhood) neighbourhood->lightPixels(lighting, settings.flag("indirect"));
  if (!inputs.scene.volumes().empty()) {
    const std::string& window = settings.choice("window");
    lighting.volumes = volumesFor(inputs, settings.integer("order"))
                           .record(graph, inputs, frame::windowNamed(window), settings.flag("indirect"));
  }
  return lighting;
}

}  // namespace gloam::prt
