// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bake: precomputes radiance transfer and stores it in a .glb.
#include <fmt/core.h>
#include <gloam/bake.h>
#include <image/atomic_file.h>

#include "bake_limits.h"
#include "bake_neighbourhood.h"
#include "bake_pca.h"
#include "bake_run.h"
#include "bake_surfaces.h"
#include "bake_volume.h"
#include "json.h"
#include "output.h"
#include "scene_inputs.h"
#include "verb.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

struct BakeChoice {
  SceneChoice scene;
  BakeOptions options;
  LimitChoice limits;
  SurfaceChoice surfaces;
  PcaChoice pca;
  NeighbourhoodChoice neighbourhood;
  VolumeChoice volumes;
  std::string output, kind = "di", glossy = "auto";
  bool half_float = false, resume = true, estimate_only = false;
  std::vector<const CLI::Option*> of_rays, of_bounces, of_gloss;  ///< options that not all bakes use
};

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

// Found before hours of work, not after.
void checkOutput(const BakeChoice& choice) {
  if (fs::path(choice.output).extension() != ".glb") {
    throw Error(choice.output, "expected a name that ends in .glb");
  }
  refuseOverwriting(choice.output, choice.scene.name);
  AtomicFile probe(choice.output);
}

void remarkUnusedOptions(const BakeChoice& choice, Console& console) {
  const auto remark = [&](const std::vector<const CLI::Option*>& options) {
    for (const CLI::Option* option : options) {
      if (option->count() == 0) continue;
      console.remark(fmt::format("{} has no effect on --kind {}", option->get_name(), choice.kind));
    }
  };
  for (const CLI::Option* option : choice.of_gloss) {
    if (choice.glossy == "off" && option->count() > 0)
      console.remark(fmt::format("{} has no effect with --glossy off", option->get_name()));
  }
  if (choice.kind != "di") remark(choice.of_bounces);
  if (choice.kind == "du") remark(choice.of_rays);
}

Scene bakeWithCheckpoint(const Scene& scene, const BakeChoice& choice, Console& console, BakeReport& report) {
  std::error_code ignored;
  const fs::path& checkpoint = choice.options.checkpoint;
  if (!choice.resume) fs::remove(checkpoint, ignored);
  Progress progress = console.progress();
  if (progress.update) {  // the first report comes when scene, options and checkpoint have proved good
    progress.update = [&console, update = progress.update](double fraction, const std::string& what) {
      console.release();
      update(fraction, what);
    };
  }
  try {
    return bakeTransfer(scene, choice.options, progress, &report);
  } catch (const Error& error) {
    const std::string text = error.what();
    if (!text.starts_with(checkpoint.string() + ":")) throw;
    throw Error(text.substr(0, text.find("; delete it")) + "; --no-resume starts anew");
  } catch (const Interrupted&) {
    const bool kept = fs::exists(checkpoint, ignored);
    throw Interrupted(kept ? fmt::format("interrupted; the same command goes on from {}", checkpoint.string())
                           : "interrupted before anything was finished");
  }
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

int runBake(BakeChoice choice, Console& console) {
  if (choice.output.empty()) choice.output = sceneStem(choice.scene.name) + "_prt.glb";
  choice.options.kind = kindOf(choice.kind);
  choice.options.glossy = glossyOf(choice.glossy);
  applyLimits(choice.options, choice.limits, console);
  if (!choice.estimate_only) checkOutput(choice);
  Scene scene = loadSceneToDraw(choice.scene, console);
  remarkUnusedOptions(choice, console);
  remarkUnusedSurfaceOptions(choice.options, choice.surfaces, console);
  const std::vector<int> carriers =
      chooseNeighbourhoods(scene, choice.neighbourhood, choice.options, console);
  if (!choice.options.apart) remarkMotion(scene, console);
  TessellateReport split;
  scene = tessellatedAsChosen(std::move(scene), choice.options, choice.surfaces, console, split);
  const BakeEstimate estimate = estimateBake(scene, choice.options);
  const std::optional<Error> fault = memoryFault(choice.options, estimate);
  if (choice.estimate_only && !console.json) console.print(estimateText(estimate));
  if (choice.estimate_only && fault) console.remark(fault->what());
  const Json grids =
      estimateNeighbourhoods(scene, carriers, choice.neighbourhood, console, choice.estimate_only);
  const Json clouds = estimateVolumes(scene, choice.volumes, choice.options, console, choice.estimate_only);
  if (choice.estimate_only) {
    Json json = estimateJson(estimate);
    json["neighbourhoods"] = grids;
    json["volumes"] = clouds;
    if (console.json) console.print(jsonText(json));
    return kDone;
  }
  if (fault) throw *fault;
  choice.options.checkpoint = choice.output + ".checkpoint";
  choice.neighbourhood.options.checkpoint = choice.options.checkpoint;
  console.remark(estimateText(estimate));
  Json volumes;
  scene = bakeVolumesAsChosen(std::move(scene), choice.volumes, console, volumes);
  BakeReport report;
  Scene baked = bakeWithCheckpoint(scene, choice, console, report);
  console.endProgress();
  const Json neighbourhoods =
      bakeNeighbourhoods(baked, carriers, choice.neighbourhood, choice.resume, console);
  CompressReport compressed;
  baked = compressedAsChosen(std::move(baked), choice.pca, choice.half_float, console, compressed);
  writeGlb(baked, choice.output, {.half_float = choice.half_float});
  remarkLostLight(baked, console);
  for (const std::string& warning : report.warnings) console.remark(warning);
  printResult(choice, report, split, neighbourhoods, volumes, compressed, console);
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
  choice.of_bounces.push_back(
      add("--bounces", options.bounces, {1, 64}, "interreflection passes of --kind di"));
  choice.of_rays.push_back(
      add("--directions", options.directions, {256, 65536}, "rays a vertex in the first pass"));
  choice.of_bounces.push_back(
      add("--bounce-directions", options.bounce_directions, {64, 65536}, "rays a vertex in each later pass"));
  app.add_flag(
         "--apart", options.apart,
         "each root node is an object of its own, which shadows itself alone: objects may move against one "
         "another (prt.local_light)")
      ->group("Transfer");
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
