// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, "Real-time indirect illumination and soft shadows in dynamic scenes using spherical lights",
// Figure 2: the pipeline. Differs from the paper: receivers are those of a picture, not vertices; receivers within spheres follow
// spheres/receiver_rule.h; visibility of a sphere is by default exp of a mean log, not a difference of exponentials; ground and walls
// take part as rectangles.
#include "techniques/spherical_lights/spherical_lights.h"

#include <algorithm>

#include "frame/field_shade.h"
#include "frame/lanes.h"
#include "frame/light_peak.h"
#include "shaders/spherical_lights_shaders.h"
#include "techniques/sphere_options.h"
#include "techniques/spherical_lights/spherical_lights_prepare.h"
#include "techniques/spherical_lights/spherical_lights_step.h"
#include "techniques/spherical_lights/spherical_lights_tables.h"

namespace gloam::spherical_lights {

namespace {

const std::vector<Option>& options() {
  static const std::vector<Option> options = {
      spheresOption(),
      divisorOption(),
      {.name = "receivers",
       .default_value = std::string("pixels"),
       .choices = {"pixels", "vertices"},
       .help = "where light is found: at pixels, one in a square, or at the vertices of the scene (the "
               "paper's), which are to be dense enough"},
      {.name = "hierarchy",
       .default_value = 0.0f,
       .minimum = 0.0,
       .maximum = 1.0,
       .help = "sine of a half-angle: spheres of one object that look smaller together, from a cluster of "
               "8 x 8 receivers, count as one; 0: never. With blocking per_object and visibility mean"},
      {.name = "blocking",
       .default_value = std::string("per_object"),
       .choices = {"per_object", "per_sphere"},
       .help =
           "a sphere's light is blocked by whole objects that are nearer, or by every single sphere that is"},
      {.name = "reuse",
       .default_value = true,
       .help = "per_sphere: what nearer spheres block is summed once for all, not for each sphere again"},
      {.name = "visibility",
       .default_value = std::string("mean"),
       .choices = {"mean", "product", "difference"},
       .help = "of a sphere behind others: by the mean log over its disc; its disc times what they leave; or "
               "the difference of two exponentials (the paper's)"},
      {.name = "average",
       .default_value = std::string("solid_angle"),
       .choices = {"solid_angle", "area"},
       .help = "over which of a sphere's points its radiance is averaged: by how large they look, or how "
               "they face (the paper's)"},
      {.name = "lamp_radius",
       .default_value = 0.0f,
       .minimum = 0.0,
       .maximum = 1000.0,
       .help =
           "metres: point lamps shine as balls of that radius, with soft shadows of spheres; 0: as points, "
           "by shadow maps"},
      {.name = "flats",
       .default_value = true,
       .help = "what has no spheres (ground, walls, rooms) stands in the light, too, and sends it, as "
               "rectangles"},
      {.name = "repair",
       .default_value = true,
       .help =
           "pixels that no receiver fits, or between receivers of one surface that disagree, are lit from "
           "scratch"},
      {.name = "indirect",
       .default_value = true,
       .help = "light that spheres send; without it, shadows alone"},
      partsOption(),
      windowOption()};
  return options;
}

int blockingOf(const Settings& settings) {
  if (settings.choice("blocking") == "per_object") return kPerObject;
  return settings.flag("reuse") ? kPerSphereReused : kPerSphere;
}

int visibilityOf(const Settings& settings) {
  const std::string& name = settings.choice("visibility");
  return name == "mean" ? kMean : name == "product" ? kProduct : kDifference;
}

bool lampsAreBalls(const frame::FrameInputs& inputs, const Settings& settings) {
  const std::vector<frame::LightRow>& lamps = inputs.shadow_maps.lights;
  if (settings.number("lamp_radius") == 0.0f) return false;
  if (lamps.empty()) {
    inputs.warnings.push_back("spherical_lights.lamp_radius: there are no lamps; meshes that glow need none");
    return false;
  }
  const bool points =
      std::ranges::all_of(lamps, [](const frame::LightRow& lamp) { return lamp.kind == frame::kLightPoint; });
  if (!points)
    inputs.warnings.push_back(
        "spherical_lights.lamp_radius: there are lamps that are not points; all shine by shadow maps");
  return points;
}

std::vector<float> cellRows() {
  std::vector<float> rows;
  for (const sh::Sh& cell : voronoiSums()) {
    for (int i = 0; i < 16; ++i) rows.push_back(cell[i]);
  }
  return rows;
}

Coverage coverage(const Settings& settings) {
  const bool indirect = settings.flag("indirect");
  return {true, indirect, true, indirect, true, indirect};
}

}  // namespace

const TechniqueInfo& info() {
  static const TechniqueInfo info = {
      .name = "spherical_lights",
      .summary = "soft shadows and shadowed colour between moving things, by spheres that light and block",
      .covers = kAllLight,
      .options = options(),
      .needs_spheres = true,
      .needs_emission = true,
      .covers_with = coverage};
  return info;
}

SphericalLights::SphericalLights(gpu::Device& device)
    : cells_(device, "spherical_lights.cells", cellRows()),
      area_fit_(averageFit(Average::kArea)),
      solid_angle_fit_(averageFit(Average::kSolidAngle)) {}

LightRows SphericalLights::lightRows(const sh::ShRgb& light, const Settings& settings) const {
  LightRows row{};
  const frame::Window window = frame::windowNamed(settings.choice("window"));
  if (settings.flag("parts") && window == frame::Window::kNone && light.order >= kEmissionOrder) {
    const sh::LightParts parts = sh::lightParts(light, kEmissionOrder);
    frame::shadeRows(parts.rest, row.shade);
    row.peak = frame::lightPeak(parts);
  } else {
    frame::shadeRows(frame::windowed(light, kEmissionOrder, window), row.shade);
  }
  std::ranges::copy(settings.choice("average") == "area" ? area_fit_ : solid_angle_fit_, row.average_fit);
  return row;
}

/// First pass: light at surface samples, then what each sphere sends.
Sending SphericalLights::recordSending(const Step& step) {
  gpu::FrameGraph& graph = step.graph;
  const Rows& rows = step.rows;
  const auto point_count = std::uint32_t(rows.points.size()), count = step.params.spheres;
  const gpu::BufferRef points = uploadRows(graph, "spherical_lights.points", rows.points);
  const gpu::BufferRef arriving =
      graph.create("spherical_lights.arriving", gpu::BufferDesc{.bytes = point_count * sizeof(glm::vec3)});
  graph.compute("spherical_lights.samples", spherical_lights_samples_spv)
      .specialize("blocking", step.blocking)
      .specialize("visibility_kind", step.visibility)
      .specialize("glows", !rows.glow.empty())
      .read("points", points)
      .read("spheres", step.spheres)
      .read("objects", step.objects)
      .read("glow", step.glow)
      .read("meets", step.meets)
      .read("blocking_patches", step.blocking_patches)
      .read("sending_patches", step.sending_patches)
      .read("light", step.light)
      .write("arriving", arriving)
      .push(SampleParams{step.params, point_count})
      .dispatchOver(int(point_count));
  const frame::ShadowMaps& shadows = step.inputs.shadow_maps;
  for (std::size_t i = 0; i < (step.lamps_are_balls ? 0 : shadows.lights.size()); ++i) {
    graph.compute("spherical_lights.lamps", spherical_lights_lamps_spv)
        .read("light", shadows.lightRow(i))
        .read("shadow_views", shadows.viewRows(i))
        .sample("shadow_maps", shadows.maps, gpu::kNearestClamp)
        .read("points", points)
        .readWrite("arriving", arriving)
        .push(point_count)
        .dispatchOver(int(point_count));
  }
  if (const auto patches = step.params.sending_patches; patches > 0) {
    graph.compute("spherical_lights.flats", spherical_lights_flats_spv)
        .read("arriving", arriving)
        .read("sending_patches", step.sending_patches)
        .write("patch_radiance", step.patch_radiance)
        .push(FlatParams{patches, point_count - patches * kPatchPoints})
        .dispatchOver(int(patches));
  }
  if (count == 0) return {.sent = step.glow};
  const gpu::BufferRef sent = graph.create(
      "spherical_lights.sent", gpu::BufferDesc{.bytes = (count + step.params.coarse) * sizeof(SentRow)});
  graph.compute("spherical_lights.emit", spherical_lights_emit_spv)
      .read("arriving", arriving)
      .read("cells", cells_)
      .read("senders", uploadRows(graph, "spherical_lights.senders", rows.senders))
      .write("sent", sent)
      .dispatch(count);
  recordCoarse(step, sent);
  return {.sent = sent, .points = points, .arriving = arriving};
}

frame::Lighting SphericalLights::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                        const Settings& settings) {
  if (inputs.emission == nullptr) throw Error("spherical_lights", "what spheres send was not set");
  Rows rows = rowsOf(inputs.proxies, *inputs.emission);
  warnOfMeetingObjects(rows, inputs.warnings);
  const bool balls = lampsAreBalls(inputs, settings);
  if (balls) addLamps(rows, inputs.shadow_maps.lights, settings.number("lamp_radius"), inputs.warnings);
  addGlowing(rows, inputs.emission->glowing_patches);
  if (!settings.flag("flats"))
    rows.sending_patches.clear(), rows.blocking_patches.clear(), rows.enclosed_patches = 0;
  const bool send = settings.flag("indirect");
  if (send)
    addPatchPoints(rows);
  else
    rows.sending_patches.resize(rows.enclosed_patches);
  listNeighbours(rows, blockingOf(settings));
  const auto count = std::uint32_t(rows.spheres.size());
  const auto patches = send ? std::uint32_t(rows.sending_patches.size()) : 0u;
  const bool hierarchy = settings.number("hierarchy") > 0.0f && settings.flag("indirect") &&
                         quick(blockingOf(settings), visibilityOf(settings), rows.objects.size()) &&
                         blockingOf(settings) == kPerObject;
  if (hierarchy) addCoarse(rows, *inputs.emission);
  const gpu::BufferRef patch_radiance =
      graph.create("spherical_lights.patch_radiance",
                   gpu::BufferDesc{.bytes = (patches + kPatchesPast) * sizeof(glm::vec3)});
  if (patches == 0) graph.clear("spherical_lights.patch_radiance", patch_radiance);
  const Step step{
      .graph = graph,
      .inputs = inputs,
      .rows = rows,
      .blocking = blockingOf(settings),
      .visibility = visibilityOf(settings),
      .divisor = std::stoi(settings.choice("divisor")),
      .repair = settings.flag("repair"),
      .lamps_are_balls = balls,
      .indirect = settings.flag("indirect") && count + patches > 0,
      .at_vertices = settings.choice("receivers") == "vertices",
      .by_lanes = frame::readsByLanes(graph.device()),
      .coarse_limit = settings.number("hierarchy"),
      .light = graph.uploadOne("spherical_lights.light", lightRows(inputs.environment.sh(), settings)),
      .spheres = uploadRows(graph, "spherical_lights.spheres", rows.spheres),
      .objects = uploadRows(graph, "spherical_lights.objects", rows.objects),
      .meets = uploadRows(graph, "spherical_lights.meets", rows.meets),
      .listed = uploadRows(graph, "spherical_lights.listed", rows.listed),
      .glow = uploadRows(graph, "spherical_lights.glow", rows.glow),
      .levels = uploadRows(graph, "spherical_lights.levels", rows.levels),
      .coarse = uploadRows(graph, "spherical_lights.coarse", rows.coarse),
      .leaves = uploadRows(graph, "spherical_lights.leaves", rows.leaves),
      .blocking_patches = uploadRows(graph, "spherical_lights.blocking_patches", rows.blocking_patches),
      .sending_patches = uploadRows(graph, "spherical_lights.sending_patches", rows.sending_patches),
      .patch_radiance = patch_radiance,
      .params = {count, std::uint32_t(rows.objects.size()), std::uint32_t(rows.words),
                 std::uint32_t(rows.blocking_patches.size()), patches, rows.enclosed_patches,
                 std::uint32_t(rows.coarse.size())}};
  const Sending sending = step.indirect ? recordSending(step) : Sending{.sent = step.glow};
  if (sending.arriving) recordView(step, sending);
  return recordGathering(step, sending.sent);
}

}  // namespace gloam::spherical_lights
