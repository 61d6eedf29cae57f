// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bake: precomputes radiance transfer and stores it in a .glb.
#include <fmt/core.h>

#include "bake_checkpoints.h"
#include "bake_choice.h"
#include "bake_run.h"
#include "json.h"
#include "output.h"
#include "verb.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

TransferKind kindOf(const std::string& kind) {
  if (kind == "du") return TransferKind::kUnshadowed;
  if (kind == "ds") return TransferKind::kShadowed;
  return TransferKind::kInterreflected;
}

GlossyMeshes glossyOf(const std::string& glossy) {
  if (glossy == "off") return GlossyMeshes::kNone;
  return glossy == "on" ? GlossyMeshes::kAll : GlossyMeshes::kShiny;
}

Json estimateJson(const BakeEstimate& estimate) {
  return {{"vertices", estimate.vertices},
          {"glossy_vertices", estimate.glossy_vertices},
          {"texels", estimate.texels},
          {"triangles", estimate.triangles},
          {"rays", estimate.rays},
          {"memory_bytes", estimate.memory_bytes},
          {"least_memory_bytes", estimate.least_memory_bytes},
          {"file_bytes", estimate.file_bytes}};
}

Scene bakeAsChosen(const Scene& scene, const BakeOptions& options, Console& console, BakeReport& report) {
  Progress progress = console.progress();
  if (progress.update) {  // the first report comes when scene, options and checkpoint have proved good
    progress.update = [&console, update = progress.update](double fraction, const std::string& what) {
      console.release();
      update(fraction, what);
    };
  }
  Scene baked = bakeTransfer(scene, options, progress, &report);
  console.endProgress();
  return baked;
}

void printResult(const BakeChoice& choice, const BakeReport& report, const TessellateReport& split,
                 const Json& neighbourhoods, const Json& volumes, const CompressReport& compressed,
                 Console& console) {
  const double rate = report.first_pass_s > 0.0 ? double(report.rays) / report.first_pass_s : 0.0;
  std::error_code ignored;
  const auto size = double(fs::file_size(choice.output, ignored));
  if (!console.json) {
    console.remark(fmt::format("wrote {} ({}): {} points; first pass {} ({:.1f} Mrays/s), bounces {}{}",
                               choice.output, bytesText(size), countText(report.vertices),
                               durationText(report.first_pass_s), rate / 1e6, durationText(report.bounces_s),
                               report.resumed ? "; resumed" : ""));
    remarkDirections(choice.options, report, console);
    if (report.glossy_points > 0) {
      console.remark(fmt::format("{} points have matrices; prt.glossy=cheap would err by {:.1f} %",
                                 countText(report.glossy_points), 100.0 * report.cheap_error));
    }
    remarkMissedBound(choice.surfaces, split, console);
    return;
  }
  const BakeOptions& options = choice.options;
  console.print(
      jsonText({{"scene", choice.scene.name},
                {"output", choice.output},
                {"kind", choice.kind},
                {"order", options.order},
                {"bounces", options.kind == TransferKind::kInterreflected ? options.bounces : 0},
                {"directions", options.directions},
                {"half_float", choice.half_float},
                {"pca", pcaJson(choice.pca, compressed)},
                {"points", report.vertices},
                {"rays", report.rays},
                {"bounce_rays", report.bounce_rays},
                {"bounce_directions", report.bounce_directions},
                {"first_pass_s", report.first_pass_s},
                {"bounces_s", report.bounces_s},
                {"rays_per_s", rate},
                {"bounce_s", report.bounce_s},
                {"adaptive", directionsJson(options, report)},
                {"resumed", report.resumed},
                {"apart", options.apart},
                {"texels", report.texels},
                {"tessellated", tessellateJson(choice.surfaces, split)},
                {"neighbourhoods", neighbourhoods},
                {"volumes", volumes},
                {"glossy_points", report.glossy_points},
                {"cheap_error", report.glossy_points > 0 ? Json(report.cheap_error) : Json(nullptr)},
                {"file_bytes", size}}));
}

/// Transfer with what grids and volumes add: memory is that of the greatest stage, and of writing all of it.
BakeEstimate withAll(BakeEstimate estimate, const BakeEstimate& as_floats, const Json& grids,
                     const Json& clouds, bool half_float) {
  constexpr std::size_t kWorkBytes = std::size_t(14) << 20;
  std::size_t kept = 0, stage = 0, largest = 0;  // floats of finished grids and volumes
  const std::size_t factor = half_float ? 2 : 1, before = kWorkBytes + 2 * as_floats.file_bytes;
  const auto add = [&](const Json& part) {
    const std::size_t file = part["file_bytes"].get<std::size_t>();
    stage = std::max(stage, before + kept + part["memory_bytes"].get<std::size_t>());
    kept += file * factor;
    largest = std::max(largest, file);
    estimate.file_bytes += file;
  };
  if (!clouds.is_null()) add(clouds);
  for (const Json& grid : grids) add(grid);
  if (kept == 0) return estimate;
  const std::size_t writing = before + kept + 2 * estimate.file_bytes + (half_float ? largest : 0);
  estimate.memory_bytes = std::max({estimate.memory_bytes + kept, stage, writing});
  estimate.least_memory_bytes = std::max({estimate.least_memory_bytes, stage, writing});
  return estimate;
}

/// All that --estimate says. Splitting triangles is work that it leaves out.
int printEstimate(const BakeChoice& choice, const BakeEstimate& estimate, const Json& grids,
                  const Json& clouds, Console& console) {
  Json json = estimateJson(estimate);
  json["neighbourhoods"] = grids;
  json["volumes"] = clouds;
  if (console.json) console.print(jsonText(json));
  if (choice.surfaces.tessellate > 0.0f)
    console.remark(
        fmt::format("that is of the vertices as they are: --tessellate adds some, up to {} in all "
                    "(--tessellate-max)",
                    countText(std::size_t(choice.surfaces.tessellate_max))));
  return kDone;
}

/// Each stage keeps what it has finished until the file is written.
void bakeAndWrite(Scene scene, const std::vector<int>& carriers, BakeChoice& choice,
                  const TessellateReport& split, Console& console) {
  const BakeCheckpoints checkpoints(choice.output);
  choice.options.checkpoint = checkpoints.transfer();
  choice.options.keep_checkpoint = true;
  if (!choice.resume) checkpoints.remove();
  Json volumes, neighbourhoods;
  BakeReport report;
  CompressReport compressed;
  Scene baked;
  checkpoints.guard([&] {
    scene = bakeVolumesAsChosen(std::move(scene), choice.volumes, checkpoints, console, volumes);
    baked = bakeAsChosen(scene, choice.options, console, report);
    neighbourhoods = bakeNeighbourhoods(baked, carriers, choice.neighbourhood, checkpoints, console);
    baked = compressedAsChosen(std::move(baked), choice.pca, choice.half_float, console, compressed);
  });
  writeGlb(baked, choice.output, {.half_float = choice.half_float});
  checkpoints.remove();
  remarkLostLight(baked, console);
  for (const std::string& warning : report.warnings) console.remark(warning);
  printResult(choice, report, split, neighbourhoods, volumes, compressed, console);
}

int runBake(BakeChoice choice, Console& console) {
  if (choice.output.empty()) choice.output = sceneStem(choice.scene.name) + "_prt.glb";
  choice.options.kind = kindOf(choice.kind);
  choice.options.glossy = glossyOf(choice.glossy);
  applyLimits(choice.options, choice.limits, console);
  checkBakeChoice(choice);
  Scene scene = loadSceneToDraw(choice.scene, console);
  const std::optional<Error> of_edges = manifoldFault(choice, scene);
  if (of_edges && !choice.estimate_only) throw *of_edges;
  remarkUnusedOptions(choice, scene, console);
  remarkUnusedSurfaceOptions(choice.options, choice.surfaces, console);
  const std::vector<int> carriers =
      chooseNeighbourhoods(scene, choice.neighbourhood, choice.options, console);
  if (!choice.options.apart) remarkMotion(scene, console);
  TessellateReport split;
  if (!choice.estimate_only)
    scene = tessellatedAsChosen(std::move(scene), choice.options, choice.surfaces, console, split);
  const BakeEstimate of_transfer = estimateBake(scene, choice.options, choice.fileForm());
  const Json grids = estimateNeighbourhoods(scene, carriers, choice.neighbourhood, choice.half_float, console,
                                            choice.estimate_only);
  const Json clouds = estimateVolumes(scene, choice.volumes, choice.options, choice.half_float, console,
                                      choice.estimate_only);
  const bool more = !grids.empty() || !clouds.is_null();
  const BakeEstimate estimate =
      more ? withAll(of_transfer, estimateBake(scene, choice.options), grids, clouds, choice.half_float)
           : of_transfer;
  const std::optional<Error> fault = memoryFault(choice.options, estimate, of_transfer, !grids.empty());
  if (choice.estimate_only && !console.json) console.print(estimateText(estimate));
  if (choice.estimate_only && of_edges) console.remark(of_edges->what());
  if (choice.estimate_only && fault) console.remark(fault->what());
  if (choice.estimate_only) return printEstimate(choice, estimate, grids, clouds, console);
  if (fault) throw *fault;
  console.remark(estimateText(estimate));
  bakeAndWrite(std::move(scene), carriers, choice, split, console);
  return kDone;
}

void addSimulatorOptions(CLI::App& app, BakeChoice& choice) {
  const BakeOptions defaults;
  BakeOptions& options = choice.options;
  const auto add = [&app](const char* name, int& value, Range range, const char* help) -> CLI::Option* {
    return addInteger(app, name, value, range, "N", help)
        ->default_str(std::to_string(value))
        ->group("Transfer");
  };
  addChoice(app, "--kind", choice.kind, {"du", "ds", "di"},
            "unshadowed, shadowed, or shadowed and interreflected")
      ->default_str(choice.kind)
      ->group("Transfer");
  add("--order", options.order, {3, 6}, "bands of spherical harmonics; N*N coefficients a vertex");
  choice.bounces_option = add("--bounces", options.bounces, {1, 64}, "interreflection passes of --kind di");
  choice.directions_option =
      add("--directions", options.directions, {256, 65536}, "rays a vertex in the first pass");
  choice.bounce_directions_option =
      add("--bounce-directions", options.bounce_directions, {64, 65536}, "rays a vertex in each later pass")
          ->default_str("1024, in rooms 256");
  app.add_flag(
         "--apart", options.apart,
         "each root node is an object of its own, which shadows itself alone: objects may move against one "
         "another (prt.local_light)")
      ->group("Transfer");
  choice.non_manifold_option =
      app.add_flag("--non-manifold", choice.non_manifold,
                   "bakes meshes, too, some of whose edges have more than two triangles, as they stand")
          ->group("Surfaces");
  choice.time_option =
      addNumber(app, "--time", options.time_s, {0.0, 1e6}, "SECONDS", "instant at which the scene is posed")
          ->default_str("0")
          ->group("Transfer");
}

void addGlossyOptions(CLI::App& app, BakeChoice& choice) {
  BakeOptions& options = choice.options;
  addChoice(app, "--glossy", choice.glossy, {"auto", "on", "off"},
            "matrices for gloss: of meshes that mirror 10 % of light or more, of all, or of none")
      ->default_str(choice.glossy)
      ->group("Gloss");
  const auto ofGloss = [&choice](CLI::Option* option) { choice.of_gloss.push_back(option->group("Gloss")); };
  ofGloss(addInteger(app, "--glossy-order", options.glossy_order, {3, 6}, "N",
                     "bands of the radiance that matrices give; by default --order"));
  ofGloss(
      addInteger(app, "--glossy-light-order", options.glossy_light_order, {3, 6}, "N",
                 "bands of the light that they take; by default as many. 3 with --glossy-order 5: 9 to 25"));
  ofGloss(addNumber(app, "--bake-gloss", options.glossy_exponent, {1.0, 1000.0}, "EXPONENT",
                    "bakes one Phong lobe in, not to be changed; by default each material's own"));
}

std::function<int()> declareBake(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<BakeChoice>();
  addSceneOptions(app, choice->scene);
  addOutput(app, choice->output, "FILE", "the baked scene, a .glb; by default the scene's name and _prt.glb");
  addSimulatorOptions(app, *choice);
  addGlossyOptions(app, *choice);
  addLimitOptions(app, choice->options, choice->limits);
  addSurfaceOptions(app, choice->options, choice->surfaces);
  addNeighbourhoodOptions(app, choice->neighbourhood);
  addVolumeOptions(app, choice->volumes);
  addPcaOption(app, choice->pca);
  app.add_flag("--half", choice->half_float, "store transfer as 16-bit floats: half the size")
      ->group("Output");
  addInteger(app, "--threads", choice->options.threads, {0, 1024}, "N",
             "0: all cores; the result is the same")
      ->default_str("0");
  app.add_flag("--resume,!--no-resume", choice->resume,
               "go on from an interrupted bake of the same output, or start anew [on]");
  app.add_flag("--estimate", choice->estimate_only, "say what the bake will take, and stop");
  addConsoleOptions(app, console, true);
  return [choice, &console] { return runBake(*choice, console); };
}

}  // namespace

extern const Verb kBakeVerb;
const Verb kBakeVerb = {
    "bake", "precomputes how a scene shadows and lights itself, for --technique prt",
    "gloam bake bunny.obj --ground -o bunny.glb | with a floor, two bounces, order 5\n"
    "gloam bake builtin:cornell --bounces 6 --order 4 --half -o cornell.glb | more bounces, a smaller file\n"
    "gloam bake teapot.glb --ground --glossy on --bounces 3 -o teapot.glb | gloss that is shadowed and "
    "reflects, too\n"
    "gloam bake builtin:gallery --texels-per-metre 16 -o gallery.glb | light kept in lightmaps\n"
    "gloam bake room.glb --tessellate 0.05 -o room_prt.glb | more vertices where shadows need them\n"
    "gloam bake builtin:passing --neighbourhood auto -o passing.glb | what moves shadows what passes it\n"
    "gloam bake builtin:cloud --scatterings 32 -o cloud.glb | smoke that light scatters in\n"
    "gloam bake statue.glb --estimate | how much memory and how large a file\n"
    "gloam bake spheres statue.glb | fits spheres instead, for what moves: gloam bake spheres --help\n"
    "gloam bake statue.glb -o statue_prt.glb | after Ctrl-C the same command goes on where it stopped\n",
    declareBake};

}  // namespace gloam::cli
