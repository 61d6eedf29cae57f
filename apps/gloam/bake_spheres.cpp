// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bake spheres: fits spheres to a model and writes them.
#include <fmt/core.h>
#include <gloam/spheres.h>
#include <image/atomic_file.h>

#include "json.h"
#include "output.h"
#include "scene_inputs.h"
#include "verb.h"

namespace gloam::cli {
namespace {

constexpr const char* kEnding = ".spheres.json";

struct SpheresChoice {
  SceneChoice scene;
  SphereOptions options;
  int seed = 1;
  std::string output;
};

void checkOutput(const SpheresChoice& choice) {
  if (!choice.output.ends_with(".json")) throw Error(choice.output, "expected a name that ends in .json");
  refuseOverwriting(choice.output, choice.scene.name);
  AtomicFile probe(choice.output);
}

std::string spheresText(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "sphere" : "spheres");
}

std::string setText(const SphereSet& set) {
  if (!set.receive_only.empty()) return fmt::format("{}: only receives ({})", set.name, set.receive_only);
  const SphereFigures& f = set.figures;
  const std::string places = set.nodes.size() > 1 ? fmt::format(", at {} nodes", set.nodes.size()) : "";
  return fmt::format(
      "{}: {}{}; outside {:.2f} % of its volume (overlaps once: {:.2f} %); {:.3f} % of its "
      "surface covered",
      set.name, spheresText(set.spheres.size()), places, 100.0 * f.relativeSum(), 100.0 * f.relativeUnion(),
      100.0 * f.coverage);
}

Json setJson(const SphereSet& set) {
  Json json{{"name", set.name}, {"nodes", set.nodes.size()}, {"spheres", set.spheres.size()}};
  if (!set.receive_only.empty()) {
    json["receive_only"] = set.receive_only;
    return json;
  }
  json["volume"] = set.figures.volume;
  json["outside_sum"] = set.figures.relativeSum();
  json["outside_union"] = set.figures.relativeUnion();
  json["coverage"] = set.figures.coverage;
  return json;
}

void printResult(const SpheresChoice& choice, const SceneSpheres& spheres, double seconds, Console& console) {
  if (console.json) {
    Json sets = Json::array();
    for (const SphereSet& set : spheres.sets) sets.push_back(setJson(set));
    console.print(jsonText({{"scene", choice.scene.name},
                            {"output", choice.output},
                            {"count", choice.options.count > 0 ? Json(choice.options.count) : Json()},
                            {"spheres", spheres.count()},
                            {"seconds", seconds},
                            {"objects", sets},
                            {"warnings", spheres.warnings}}));
    return;
  }
  for (const SphereSet& set : spheres.sets) console.print(setText(set));
  console.remark(fmt::format("wrote {}: {} in {}", choice.output, spheresText(std::size_t(spheres.count())),
                             durationText(seconds)));
}

int runBakeSpheres(SpheresChoice choice, Console& console) {
  if (choice.output.empty()) choice.output = sceneStem(choice.scene.name) + kEnding;
  checkOutput(choice);
  choice.options.seed = std::uint32_t(choice.seed);
  const Scene scene = loadSceneToDraw(choice.scene, console);
  Progress progress = console.progress();
  if (progress.update) {  // the first report comes when scene and options have proved good
    progress.update = [&console, update = progress.update](double fraction, const std::string& what) {
      console.release();
      update(fraction, what);
    };
  }
  const auto started = std::chrono::steady_clock::now();
  const SceneSpheres spheres = bakeSpheres(scene, choice.options, progress);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  console.endProgress();
  for (const std::string& warning : spheres.warnings) {
    if (console.json || warning.find("only receives") == std::string::npos) console.remark(warning);
  }
  writeSpheres(spheres, choice.output);
  printResult(choice, spheres, took.count(), console);
  return kDone;
}

std::function<int()> declareBakeSpheres(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<SpheresChoice>();
  addSceneOptions(app, choice->scene);
  addOutput(app, choice->output, "FILE", "a .json; by default the scene's name and .spheres.json");
  SphereOptions& options = choice->options;
  addInteger(app, "-k,--count", options.count, {1, 4096}, "N",
             "spheres of the whole scene; at least one each object that casts (default: by size and shape, "
             "26 to 128)")
      ->group("Search");
  addNumber(app, "--effort", options.effort, {0.01, 100.0}, "FACTOR",
            "moves of the search, relative to the default")
      ->default_str("1")
      ->group("Search");
  addInteger(app, "--samples", options.samples, {500, 50000}, "N",
             "points of each surface that lead the search; what they miss is found and added")
      ->default_str(std::to_string(options.samples))
      ->group("Search");
  addInteger(app, "--seed", choice->seed, {0, 1 << 30}, "N", "another number, another search")
      ->default_str("1")
      ->group("Search");
  addInteger(app, "--threads", options.threads, {0, 1024}, "N", "0: all cores; the result is the same")
      ->default_str("0");
  addConsoleOptions(app, console, true);
  return [choice, &console] { return runBakeSpheres(*choice, console); };
}

}  // namespace

extern const Verb kBakeSpheresVerb;
const Verb kBakeSpheresVerb = {
    "bake spheres", "fits spheres to each object, which cast shadows and colour for it while it moves",
    "gloam bake spheres bunny.obj -k 26 -o bunny.spheres.json | how much air they hold, how much they cover\n"
    "gloam bake spheres builtin:walker -k 40 | ground and walls only receive; the figure gets most\n"
    "gloam bake spheres statue.glb --effort 4 | a longer search\n"
    "gloam render bunny.obj --show spheres -o spheres.png | what they look like\n",
    declareBakeSpheres};

}  // namespace gloam::cli
