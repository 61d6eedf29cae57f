// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, "Multiresolution splatting for indirect illumination", section 3: the pipeline. Differs: refinement by
// compute with indirect dispatches; a subsplat sums its lights in registers.
#include "techniques/splatting/splatting.h"

#include <fmt/format.h>

#include "shaders/splatting_shaders.h"
#include "techniques/splatting/splatting_gloss.h"
#include "techniques/splatting/splatting_host_pass.h"
#include "techniques/splatting/splatting_lamps.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {

namespace {

const std::vector<Option>& options() {
  static const std::vector<Option> options = {
      {.name = "vpls",
       .default_value = 256,
       .minimum = 0,
       .maximum = 100000,
       .help = "virtual point lights, of all lamps together"},
      {.name = "sampling",
       .default_value = std::string("grid"),
       .choices = {"grid", "quasi", "importance"},
       .help = "where they are taken from what lamps light: a regular grid, quasi-random points, or these by "
               "flux"},
      {.name = "map_size",
       .default_value = 256,
       .minimum = 16,
       .maximum = 4096,
       .help = "texels a side of a lamp's reflective shadow map"},
      {.name = "mode",
       .default_value = std::string("multiresolution"),
       .choices = {"multiresolution", "full", "cutoff"},
       .help = "where light is gathered: coarsely where nothing varies; at every pixel; or at pixels within "
               "a radius of each light, "
               "splat by splat"},
      {.name = "radius",
       .default_value = 1.0f,
       .minimum = 1e-4,
       .maximum = 1e6,
       .help = "metres that a virtual light reaches; mode cutoff"},
      {.name = "bound",
       .default_value = std::string("area"),
       .choices = {"area", "disc", "none"},
       .help = "what keeps light near to a virtual light finite: a least distance by its area, the light of "
               "a disc of that area, "
               "or nothing"},
      {.name = "visibility",
       .default_value = std::string("off"),
       .choices = {"off", "rays"},
       .help = "whether what stands in the way hides virtual lights: rays on the host from every subsplat to "
               "every light; not in mode cutoff"},
      {.name = "normal_threshold",
       .default_value = 0.1f,
       .minimum = 0.0,
       .maximum = 2.0,
       .help = "difference of a component of the normal from which on a texel is split; 0: all"},
      {.name = "depth_threshold",
       .default_value = 0.03f,
       .minimum = 0.0,
       .maximum = 1000.0,
       .help = "difference of depth, in parts of it, from which on a texel is split; 0: all"},
      {.name = "light_threshold",
       .default_value = 0.03f,
       .minimum = 0.0,
       .maximum = 1000.0,
       .help = "size of a texel on its surface, in parts of the mean distance of its light, from which on it "
               "is split; 0: whatever "
               "its size"},
      {.name = "cluster_threshold",
       .default_value = 0.006f,
       .minimum = 0.0,
       .maximum = 1000.0,
       .help = "what merging virtual lights may change of a texel's light, as estimated, in parts of it; 0: "
               "none are merged"},
      {.name = "normals",
       .default_value = std::string("shading"),
       .choices = {"shading", "geometric"},
       .help = "normals whose differences split texels"},
      {.name = "coarsest",
       .default_value = 16,
       .minimum = 4,
       .maximum = 1024,
       .help = "texels on the picture's shorter side at the coarsest level, or up to twice as many"},
      {.name = "resolution",
       .default_value = 0,
       .minimum = 0,
       .maximum = 16384,
       .help = "texels on the picture's shorter side at the finest level, at most; 0: pixels"},
      {.name = "upsample",
       .default_value = std::string("surfaces"),
       .choices = {"surfaces", "paper", "naive", "blocks", "levels"},
       .help = "how levels become pixels: interpolated along surfaces, or as the paper has it; to look at: "
               "with gaps as "
               "darkness, not at all, or a colour a level"},
      {.name = "detail",
       .default_value = 0.0f,
       .minimum = 0.0,
       .maximum = 1.0,
       .help =
           "darkening of what is turned away from the eye, which stands for detail that coarse texels lose"},
      {.name = "gather",
       .default_value = std::string("auto"),
       .choices = {"auto", "host", "device"},
       .help = "who refines, gathers and interpolates: the host between two passes, or compute passes; auto: "
               "the host for "
               "software drivers. Rays, detail, levels to look at, coarser resolutions and other modes take "
               "compute passes"},
      {.name = "gloss",
       .default_value = false,
       .help = "virtual lights in gloss, too: at every pixel that has some, from every light, seen or not"},
      {.name = "debug",
       .default_value = false,
       .help = "keeps images to look at with --show: splatting.least_K, splatting.greatest_K, "
               "splatting.light_0"}};
  return options;
}

int boundKind(const std::string& name) {
  return name == "none" ? 0 : (name == "area" ? 1 : 2);
}

/// Pictures that are made for `debug` alone: who asks for one by name has asked for it.
bool isOfDebug(std::string_view show) {
  return show.starts_with("splatting.least_") || show.starts_with("splatting.greatest_") ||
         show == "splatting.light_0";
}

vpls::VplOptions vplOptions(const Settings& settings) {
  const std::string& sampling = settings.choice("sampling");
  return {.count = settings.integer("vpls"),
          .map_size = settings.integer("map_size"),
          .sampling = sampling == "grid"    ? vpls::Sampling::kGrid
                      : sampling == "quasi" ? vpls::Sampling::kQuasi
                                            : vpls::Sampling::kImportance};
}

/// MS-5 at every pixel.
gpu::ImageRef recordFull(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const vpls::Vpls& vpls,
                         int bound) {
  const frame::ReceiverLevel& receivers = inputs.receivers.at(1);
  const auto light =
      graph.create("splatting.irradiance", gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                          .width = inputs.gbuffer.width,
                                                          .height = inputs.gbuffer.height});
  for (std::uint32_t i = 0; i < vpls.chunks(); ++i) {
    auto& pass = graph.compute("splatting.full", splatting_full_spv);
    (i == 0 ? pass.write("light", light) : pass.readWrite("light", light))
        .specialize("first", i == 0)
        .specialize("bound_kind", bound)
        .read("vpls", vpls.chunk(i))
        .read("receiver_position", receivers.position)
        .read("receiver_normal", receivers.normal_depth)
        .dispatchOver((inputs.gbuffer.width + kEach - 1) / kEach, inputs.gbuffer.height);
  }
  return light;
}

/// The earlier splatting: rectangles blended one over the other.
gpu::ImageRef recordCutoff(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const vpls::Vpls& vpls,
                           int bound, float radius) {
  const frame::ReceiverLevel& receivers = inputs.receivers.at(1);
  const auto light =
      graph.create("splatting.irradiance", gpu::ImageDesc{.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                          .width = inputs.gbuffer.width,
                                                          .height = inputs.gbuffer.height});
  const std::array<float, 4> nothing = {0.0f, 0.0f, 0.0f, 0.0f};
  auto& pass = graph.raster("splatting.cutoff", splatting_cutoff_vert_spv, splatting_cutoff_frag_spv)
                   .state({.blend = gpu::Blend::kAdd})
                   .specialize("bound_kind", bound)
                   .read("frame_view", inputs.view)
                   .read("vpls", vpls.rows)
                   .read("receiver_position", receivers.position)
                   .read("receiver_normal", receivers.normal_depth)
                   .color("light", light, nothing)
                   .push(radius);
  pass.draw().vertices(6, vpls.capacity);
  return light;
}

/// True: the host does all between virtual lights and irradiance.
bool isOnHost(const gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Settings& settings,
              const Plan& plan) {
  const std::string& gather = settings.choice("gather");
  const std::string& upsample = settings.choice("upsample");
  const bool can = plan.finest == 0 && settings.choice("visibility") == "off" &&
                   (upsample == "surfaces" || upsample == "paper") && settings.number("detail") <= 0.0f &&
                   !settings.flag("debug") && !inputs.show.starts_with("splatting.");
  return can && (gather == "host" || (gather == "auto" && graph.device().info().software));
}

Coverage coverage(const Settings& settings) {
  return {.local_direct = true, .local_indirect = settings.integer("vpls") > 0};
}

}  // namespace

const TechniqueInfo& info() {
  static const TechniqueInfo info = {
      .name = "splatting",
      .summary = "light of lamps by way of one other surface: virtual point lights at many resolutions",
      .covers = {.local_direct = true, .local_indirect = true},
      .options = options(),
      .covers_with = coverage};
  return info;
}

frame::Lighting Splatting::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                  const Settings& settings) {
  // Distant light is not this technique's, its gloss neither.
  frame::Lighting lighting{.has_environment_gloss = true};
  const vpls::Vpls vpls = vpls::recordVpls(graph, inputs, vplOptions(settings));
  if (vpls.capacity == 0) {
    inputs.warnings.push_back(inputs.shadow_maps.lights.empty()
                                  ? "no lamp shines; splatting lights by lamps alone"
                                  : "no indirect light: no virtual lights were asked for (splatting.vpls)");
    return lighting;
  }
  tellLamps(inputs);
  const int bound = boundKind(settings.choice("bound"));
  const std::string& mode = settings.choice("mode");
  const bool shadowed = settings.choice("visibility") == "rays";
  // Rays are asked for by the list of subsplats: with them, every pixel is one.
  const bool all_pixels = mode == "full" && shadowed;
  const Plan plan = planLevels(inputs.gbuffer.width, inputs.gbuffer.height, settings.integer("coarsest"),
                               all_pixels ? 0 : settings.integer("resolution"));
  if (shadowed && (mode == "cutoff" || plan.coarsest == 0))
    inputs.warnings.push_back(
        mode == "cutoff" ? "indirect light is not shadowed: mode cutoff asks for no rays"
                         : "indirect light is not shadowed: rays begin at subsplats, and the picture "
                           "is smaller than two of splatting.coarsest");
  const int resolution = settings.integer("resolution"), coarsest = settings.integer("coarsest");
  if (!all_pixels && resolution > 0 && resolution < coarsest)
    inputs.warnings.push_back(
        fmt::format("splatting.resolution {} is taken as splatting.coarsest, {}: no "
                    "level is coarser",
                    resolution, coarsest));
  gpu::ImageRef irradiance;
  if (mode == "cutoff") {
    irradiance = recordCutoff(graph, inputs, vpls, bound, settings.number("radius"));
  } else if ((mode == "full" && !shadowed) || plan.coarsest == 0) {
    irradiance = recordFull(graph, inputs, vpls, bound);
  } else if (isOnHost(graph, inputs, settings, plan)) {
    irradiance =
        recordOnHost(graph, inputs, recordLightSets(graph, vpls), host_,
                     {.width = inputs.gbuffer.width,
                      .height = inputs.gbuffer.height,
                      .coarsest = plan.coarsest,
                      .thresholds = {settings.number("normal_threshold"), settings.number("depth_threshold")},
                      .light_threshold = settings.number("light_threshold"),
                      .cluster_threshold = settings.number("cluster_threshold"),
                      .bound_kind = bound,
                      .by_shading_normal = settings.choice("normals") == "shading",
                      .along_surfaces = settings.choice("upsample") == "surfaces"});
  } else {
    const Thresholds thresholds =
        all_pixels ? Thresholds{}
                   : Thresholds{settings.number("normal_threshold"), settings.number("depth_threshold")};
    const std::string& upsample = settings.choice("upsample");
    const Upsampling upsampling = upsample == "surfaces" ? Upsampling::kSurfaces
                                  : upsample == "paper"  ? Upsampling::kPaper
                                  : upsample == "naive"  ? Upsampling::kNaive
                                                         : Upsampling::kBlocks;
    const bool debug = settings.flag("debug") || isOfDebug(inputs.show);
    const float detail = settings.number("detail");
    const LightSets lights = recordLightSets(graph, vpls);
    std::vector<Level> levels = recordRanges(graph, inputs, plan, settings.choice("normals") == "shading");
    if (debug) recordRangesToLookAt(graph, inputs, levels);
    const Subsplats subsplats = recordRefinement(graph, inputs, plan, levels, thresholds, lights);
    const GatherOptions gathering{.paints_levels = upsample == "levels",
                                  .keeps_pixels = debug || (upsample != "surfaces" && upsample != "paper"),
                                  .world = shadowed ? &world_ : nullptr,
                                  .bound_kind = bound,
                                  .light_threshold = settings.number("light_threshold"),
                                  .cluster_threshold = settings.number("cluster_threshold")};
    recordGather(graph, inputs, plan, levels, subsplats, lights, gathering);
    irradiance =
        recordUpsampling(graph, levels, thresholds, upsampling, detail, inputs.view, inputs.gbuffer.normals);
    if (plan.finest == 0 && !gathering.keeps_pixels)
      recordPixels(graph, inputs, levels[0], subsplats, detail, irradiance);
  }
  lighting.irradiance.push_back({.image = irradiance, .path = frame::Path::kIndirect});
  if (settings.flag("gloss"))
    lighting.gloss.push_back(
        {.image = recordGloss(graph, inputs, vpls, bound), .path = frame::Path::kIndirect});
  return lighting;
}

}  // namespace gloam::splatting
