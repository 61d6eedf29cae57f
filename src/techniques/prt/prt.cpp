// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, "Precomputed radiance transfer for real-time rendering in dynamic, low-frequency
// lighting environments", sections 3 and 4: E_p = M_p . L, the light rotated into the object's axes. Differs
// from the paper: transfer is stored without the receiver's albedo, the direct and the interreflected part
// apart, and vertices' light is interpolated by a compute pass over the G-buffer. Rows PRT-1, PRT-4.
#include "techniques/prt/prt.h"

#include <fmt/format.h>

#include <algorithm>

#include "math/sampling.h"
#include "math/sh_light_parts.h"
#include "scene/transforms.h"
#include "shaders/prt_shaders.h"
#include "techniques/prt/prt_glossy.h"

namespace gloam::prt {

namespace {

/// Of the whole light; "auto" damps vertex by vertex (prt_vertices.comp.glsl).
frame::Window windowOf(const std::string& name) {
  return name == "auto" ? frame::Window::kNone : frame::windowNamed(name);
}

/// The light in each lit instance's axes is added, end to end.
void addRotatedLights(const sh::ShRgb& light, const frame::GpuScene& scene, const TransferBuffers& transfer,
                      std::vector<glm::vec3>& lights) {
  for (const std::uint32_t i : transfer.litInstances()) {
    const glm::mat3 world_from_object = rotationFactor(glm::mat3(scene.instances()[i].world_from_object));
    const sh::ShRgb turned = sh::rotate(glm::transpose(world_from_object), light);
    lights.insert(lights.end(), turned.coefficients().begin(), turned.coefficients().end());
  }
}

/// How far the light rings, 0 to 1: where in some direction a colour falls short of half of its windowed self, by a share of its
/// mean. A vertex gathers the light's bands by a weight that is nowhere negative, so that light which is high enough everywhere
/// leaves no vertex dark: soft skies are 0 and cost nothing. It grows from there, so that light that changes changes no picture at once.
float ringing(const sh::ShRgb& light) {
  constexpr float kFull = 0.1f;  // of the mean
  static const std::vector<glm::vec3> directions = sampling::fibonacciSphere(600);
  const sh::ShRgb soft = sh::windowHann(light, float(light.order));
  const glm::vec3 mean = glm::max(light[0] * sh::evaluate(1, {0, 1, 0})[0], glm::vec3(1e-9f));
  glm::vec3 lack(0.0f);
  for (const glm::vec3& d : directions) {
    const glm::vec3 least = kLeastOfDamped * glm::max(sh::valueAt(soft, d), glm::vec3(0.0f));
    lack = glm::max(lack, (least - sh::valueAt(light, d)) / mean);
  }
  return std::min(1.0f, std::max({lack.r, lack.g, lack.b}) / kFull);
}

/// Light that is damped vertex by vertex: its sharpest peak, as much of it as the light rings, and the rest.
sh::LightParts partsOf(const sh::ShRgb& all_bands, const sh::ShRgb& light, float share) {
  sh::LightParts parts = sh::lightParts(all_bands, light.order);
  parts.peak *= share;
  parts.rest = light;
  const sh::Sh there = sh::directionalLight(light.order, parts.direction);
  for (int i = 0; i < there.size(); ++i) parts.rest[i] -= parts.peak * there[i];
  return parts;
}

/// Adds "prt.vertices", once a chunk; every vertex's irradiance.
gpu::BufferRef lightVertices(gpu::FrameGraph& graph, const frame::GpuScene& scene,
                             const TransferBuffers& transfer, const sh::ShRgb& light,
                             const sh::ShRgb& all_bands, bool damping) {
  const float share = damping ? ringing(light) : 0.0f;
  const bool in_parts = share > 0.0f;
  std::vector<glm::vec3> lights;
  VerticesParams params{};
  if (in_parts) {
    const sh::LightParts parts = partsOf(all_bands, light, share);
    addRotatedLights(parts.rest, scene, transfer, lights);
    params.first_peak = static_cast<std::uint32_t>(lights.size());
    addRotatedLights(sh::colored(sh::directionalLight(light.order, parts.direction), parts.peak), scene,
                     transfer, lights);
  } else {
    addRotatedLights(light, scene, transfer, lights);
  }
  const gpu::BufferRef light_buffer = graph.upload("prt.lights", lights);
  const auto output = graph.create("prt.vertex_light",
                                   gpu::BufferDesc{.bytes = transfer.outputVertices() * sizeof(VertexLight)});
  const gpu::Limits& limits = graph.device().limits();
  for (const TransferChunk& chunk : transfer.chunks()) {
    params.block_count = chunk.block_count;
    const std::uint32_t groups = (chunk.block_count + kBlocksTogether - 1) / kBlocksTogether;
    const std::uint32_t columns = std::min(groups, limits.max_group_count[0]);
    const std::uint32_t rows = (groups + columns - 1) / columns;
    graph.compute("prt.vertices", prt_vertices_spv)
        .specialize("coefficients", transfer.order() * transfer.order())
        .specialize("has_indirect", transfer.hasIndirect())
        .specialize("half_float", transfer.options().half_float)
        .specialize("in_parts", in_parts)
        .read("blocks", chunk.blocks)
        .read("transfer_direct", chunk.direct)
        .read("transfer_indirect", chunk.indirect)
        .read("lights", light_buffer)
        .write("vertex_light", output)
        .push(params)
        .dispatch(columns, rows);
  }
  return output;
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

const NeighbourhoodBuffers& Prt::neighbourhoodFor(const frame::FrameInputs& inputs, int order) {
  const std::uint64_t revision = inputs.scene.layoutRevision();
  if (neighbourhood_ && neighbourhood_revision_ == revision && neighbourhood_->orderAskedFor() == order)
    return *neighbourhood_;
  neighbourhood_.reset();
  neighbourhood_.emplace(device_, inputs.scene, order);
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
  lighting.gloss = recordGloss(graph, inputs, glossy, light, damped, settings.flag("indirect"),
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
    const NeighbourhoodBuffers& buffers = neighbourhoodFor(inputs, settings.integer("order"));
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
