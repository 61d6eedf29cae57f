// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007, "Image-based proxy accumulation for real-time soft global illumination",
// Figure 2: the pipeline. Differs from the paper: receivers within proxies follow the rule of spheres/receiver_rule.h, and lists
// of tiles stand beside splats.
#include "techniques/proxies/proxies.h"

#include <cstring>

#include "frame/lanes.h"
#include "frame/quad_lists.h"
#include "math/sh_log_exp.h"
#include "shaders/proxies_shaders.h"
#include "techniques/proxies/proxies_accumulate.h"
#include "techniques/proxies/proxies_tables.h"
#include "techniques/sphere_options.h"

namespace gloam::proxies {

namespace {

int indirectKind(const std::string& name) {
  if (name == "point") return kIndirectPoint;
  if (name == "averaged") return kIndirectAveraged;
  return name == "exact" ? kIndirectExact : kIndirectOff;
}

int exponentialKind(const std::string& name) {
  if (name == "ps") return kExpSeries;
  if (name == "ol") return kExpLinear;
  return name == "hyb" ? kExpHybrid : kExpQuadratic;
}

const std::vector<Option>& options() {
  static const std::vector<Option> options = {
      spheresOption(),
      divisorOption(),
      {.name = "upsample",
       .default_value = std::string("normal"),
       .choices = {"normal", "field", "shaded", "bilinear"},
       .help = "what is brought to every pixel: shaded light with its change by the normal, or visibility, "
               "along surfaces, pixels without a fitting receiver computed from scratch; or shaded light "
               "along surfaces, or plainly"},
      {.name = "indirect",
       .default_value = std::string("averaged"),
       .choices = {"averaged", "point", "exact", "off"},
       .help =
           "light that proxies send back: averaged over their disc, sampled at one point, exact, or none"},
      {.name = "exponential",
       .default_value = std::string("quadratic"),
       .choices = {"quadratic", "hyb", "ol", "ps"},
       .help = "of the sum of logs: scaling and squaring with a quadratic or linear core, linear, or series"},
      {.name = "accumulate",
       .default_value = std::string("tiles"),
       .choices = {"tiles", "splat"},
       .help =
           "sums over proxies: gathered by a list of them a tile of receivers, or splatted with blending"},
      {.name = "coverage",
       .default_value = std::string("fixed"),
       .choices = {"fixed", "light", "all"},
       .help =
           "how far a proxy counts: 15 (shadow) and 10 (indirect) radii, as far as this light asks for, or "
           "everywhere"},
      {.name = "normalise",
       .default_value = true,
       .help = "scale light of proxies that overlap by the solid angle that they fill together"},
      {.name = "flats",
       .default_value = true,
       .help = "what has no spheres (ground, walls, rooms) stands in the distant light, too, as rectangles"},
      partsOption(),
      windowOption()};
  return options;
}

std::vector<ProxyRow> rowsOf(std::span<const frame::Proxy> proxies) {
  std::vector<ProxyRow> rows;
  for (const frame::Proxy& proxy : proxies)
    rows.push_back({proxy.center, proxy.radius, proxy.albedo, proxy.bulge});
  if (rows.empty()) rows.push_back({});
  return rows;
}

std::vector<PatchRow> flatRowsOf(std::span<const frame::Patch> flats) {
  std::vector<PatchRow> rows;
  for (const frame::Patch& flat : flats)
    rows.push_back({flat.center, flat.half_u, flat.half_v, flat.normal, flat.albedo});
  if (rows.empty()) rows.push_back({});
  return rows;
}

constexpr std::uint32_t kFewProxies =
    128;  // up to which pixels from scratch cost less than finding a way round them
constexpr std::uint32_t kMostGroups = 65535;  // of a dispatch, on any device

/// What receivers get, and the field O_p.
struct Received {
  gpu::ImageRef field, planes, direct, indirect;
};

Received recordReceivers(const Step& step, const Sums& sums) {
  const Received received{step.image("proxies.visibility_packed", kHalves, 4),
                          step.image("proxies.planes_packed", kHalves, 3),
                          step.image("proxies.direct", kHalves), step.image("proxies.indirect", kHalves)};
  step.graph.compute("proxies.shade", proxies_shade_spv)
      .specialize("exponential", step.exponential)
      .specialize("normalise", step.normalise)
      .specialize("has_indirect", step.indirect != kIndirectOff)
      .specialize("by_lanes", step.by_lanes)
      .read("receiver_position", step.level.position)
      .read("receiver_normal", step.level.normal_depth)
      .read("flats", step.flats)
      .read("log_table", step.log_table)
      .read("log_visibility", sums.log_visibility)
      .read("indirect_sum", sums.sent)
      .read("light", step.light)
      .write("field", received.field)
      .write("planes", received.planes)
      .write("direct", received.direct)
      .write("indirect", received.indirect)
      .write("optical_depth", step.image("proxies.log_visibility", VK_FORMAT_R32_SFLOAT))
      .write("visibility", step.image("proxies.visibility", VK_FORMAT_R32_SFLOAT))
      .write("normalisation", step.image("proxies.normalisation", VK_FORMAT_R32_SFLOAT))
      .push(ShadeParams{step.flat_count})
      .dispatchOver(received.direct);
  return received;
}

/// Receivers' fields brought to all pixels: "proxies.upsample"; beside silhouettes from more receivers, "proxies.extend"; and
/// pixels that none fits from scratch: "proxies.repair".
Received recordUpsampling(const Step& step, const Received& coarse) {
  const frame::GBuffer& gbuffer = step.inputs.gbuffer;
  const auto full = [&](const char* name) {
    return step.graph.create(
        name, gpu::ImageDesc{.format = kHalves, .width = gbuffer.width, .height = gbuffer.height});
  };
  const Received received{{}, {}, full("proxies.direct_full"), full("proxies.indirect_full")};
  const frame::QuadPlan quads = frame::planQuads(gbuffer, step.level, kRepairGroup * kMostGroups);
  const gpu::BufferRef misfits = frame::emptyQuadList(step.graph, "proxies.misfits", quads.misfits),
                       repairs = frame::emptyQuadList(step.graph, "proxies.repairs", quads.repairs);
  const gpu::ImageRef field = step.whole_field ? coarse.field : coarse.planes;
  step.graph.compute("proxies.upsample", proxies_upsample_spv)
      .specialize("whole_field", step.whole_field)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("receiver_normal", step.level.normal_depth)
      .read("field", field)
      .read("indirect", coarse.indirect)
      .read("light", step.light)
      .readWrite("misfits", misfits)
      .write("direct_full", received.direct)
      .write("indirect_full", received.indirect)
      .push(quads.upsampleParams())
      .dispatchOver(quads.columns, quads.rows);
  step.graph.compute("proxies.extend", proxies_extend_spv)
      .specialize("whole_field", step.whole_field)
      .specialize("lends", step.proxy_count > kFewProxies)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("receiver_normal", step.level.normal_depth)
      .read("field", field)
      .read("visibility", coarse.field)
      .read("indirect", coarse.indirect)
      .read("light", step.light)
      .read("misfits", misfits)
      .readWrite("repairs", repairs)
      .readWrite("direct_full", received.direct)
      .readWrite("indirect_full", received.indirect)
      .push(quads.widenParams())
      .dispatchIndirect(misfits);
  const RepairTiles tiles = recordRepairTiles(step, repairs, quads.repairs);
  step.graph.compute("proxies.repair", proxies_repair_spv)
      .specialize("indirect_kind", step.indirect)
      .specialize("exponential", step.exponential)
      .specialize("normalise", step.normalise)
      .specialize("by_lanes", step.by_lanes)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("repairs", repairs)
      .read("proxies", step.proxies)
      .read("flats", step.flats)
      .read("bits", tiles.bits)
      .read("log_table", step.log_table)
      .read("alone_table", step.alone_table)
      .read("operator_table", step.operator_table)
      .read("light", step.light)
      .readWrite("direct_full", received.direct)
      .readWrite("indirect_full", received.indirect)
      .push(RepairParams{step.params, tiles.columns, quads.repairs, quads.divisor, step.flat_count})
      .dispatchIndirect(repairs);
  return received;
}

Coverage coverage(const Settings& settings) {
  return {.environment_direct = true,
          .environment_indirect = indirectKind(settings.choice("indirect")) != kIndirectOff,
          .local_direct = true};
}

}  // namespace

const TechniqueInfo& info() {
  static const TechniqueInfo info = {
      .name = "proxies",
      .summary = "soft shadows and colour from moving things, by spheres in their place",
      .covers = {.environment_direct = true, .environment_indirect = true, .local_direct = true},
      .options = options(),
      .needs_spheres = true,
      .covers_with = coverage};
  return info;
}

Proxies::Proxies(gpu::Device& device)
    : log_table_(device, "proxies.log_table", logVisibilityTable()),
      alone_table_(device, "proxies.alone_table", blockedAloneTable()),
      operator_table_(device, "proxies.operator_table", exactOperatorTable()) {}

const Reach& Proxies::reachFor(const ProxyLight& light) {
  if (light_ && std::memcmp(&*light_, &light, sizeof light) == 0) return reach_;
  reach_ = reachOf(light);
  light_ = light;
  return reach_;
}

frame::Lighting Proxies::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                const Settings& settings) {
  if (inputs.environment.empty()) return {};
  const frame::Window window = frame::windowNamed(settings.choice("window"));
  const sh::ShRgb bands = frame::windowed(inputs.environment.sh(), kShadowOrder, window);
  const ProxyLight light = settings.flag("parts") && window == frame::Window::kNone
                               ? proxyLight(bands, sh::lightParts(inputs.environment.sh(), kShadowOrder))
                               : proxyLight(bands);
  const std::string upsample = settings.choice("upsample");
  const std::string coverage = settings.choice("coverage");
  const Reach reach = coverage == "light" ? reachFor(light) : kFixedReach;
  const Fade shadow = coverage == "all" ? Fade{} : fadeOf(reach.shadow);
  const Fade indirect = coverage == "all" ? Fade{} : fadeOf(reach.indirect);
  const auto proxy_count = std::uint32_t(inputs.proxies.size());
  const std::uint32_t words = std::max(1u, (proxy_count + 31) / 32);
  const Step step{.graph = graph,
                  .inputs = inputs,
                  .level = inputs.receivers.at(std::stoi(settings.choice("divisor"))),
                  .proxies = graph.upload("proxies.proxies", rowsOf(inputs.proxies)),
                  .flats = graph.upload("proxies.flats", flatRowsOf(inputs.flats)),
                  .light = graph.uploadOne("proxies.light", light),
                  .log_table = log_table_,
                  .alone_table = alone_table_,
                  .operator_table = operator_table_,
                  .proxy_count = proxy_count,
                  .flat_count = settings.flag("flats") ? std::uint32_t(inputs.flats.size()) : 0u,
                  .params = {words, shadow.from, shadow.to, indirect.from, indirect.to,
                             sh::logBlockerAlpha(std::min(shadow.from, indirect.from))},
                  .indirect = indirectKind(settings.choice("indirect")),
                  .exponential = exponentialKind(settings.choice("exponential")),
                  .normalise = settings.flag("normalise"),
                  .whole_field = upsample == "field",
                  .by_lanes = frame::readsByLanes(graph.device())};
  const bool splat = settings.choice("accumulate") == "splat";
  Received received = recordReceivers(step, splat ? accumulateBySplats(step) : accumulateByTiles(step));
  int divisor = step.level.divisor;
  if ((upsample == "field" || upsample == "normal") && divisor > 1) {
    received = recordUpsampling(step, received);
    divisor = 1;
  }
  const bool along = upsample != "bilinear";
  frame::Lighting lighting;
  lighting.irradiance.push_back({received.direct, frame::Path::kDirect, divisor, along});
  if (step.indirect != kIndirectOff)
    lighting.irradiance.push_back({received.indirect, frame::Path::kIndirect, divisor, along});
  return lighting;
}

}  // namespace gloam::proxies
