// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_suites.h"

#include <fmt/core.h>
#include <math/sh_batch.h>
#include <math/sh_bench.h>
#include <math/sh_exp_errors.h>
#include <reference/reference_bench.h>
#include <scene/environment.h>
#include <techniques/prt/prt_bake_bench.h>
#include <techniques/prt/prt_gloss_bench.h>

#include <thread>

#include "bench_relight.h"
#include "bench_visibility.h"
#include "json.h"
#include "scene_inputs.h"
#include "verb.h"

namespace gloam::cli {
namespace {

/// Errors are parts of full visibility.
Json exponentialErrors(const std::vector<sh::ExpErrorRow>& rows) {
  Json json = Json::array();
  for (const sh::ExpErrorRow& row : rows) {
    json.push_back({{"order", row.order},
                    {"arrangement", sh::arrangementName(row.arrangement)},
                    {"spheres", row.blockers},
                    {"norm", row.norm},
                    {"products", {{"hybrid", row.hybrid_products}, {"quadratic", row.quadratic_products}}},
                    {"against_numeric",
                     {{"series4", row.series4},
                      {"series9", row.series9},
                      {"linear", row.linear},
                      {"hybrid", row.hybrid},
                      {"quadratic", row.quadratic}}},
                    {"against_visibility",
                     {{"numeric", row.visible_numeric},
                      {"pointwise", row.visible_pointwise},
                      {"product", row.visible_product},
                      {"linear", row.visible_linear},
                      {"hybrid", row.visible_hybrid},
                      {"quadratic", row.visible_quadratic}}}});
  }
  return json;
}

int benchSphericalHarmonics(const BenchChoice&, Console& console) {
  const std::vector<sh::BenchRow> rows = sh::bench(9, 0.01, console.progress());
  const std::vector<sh::ExpErrorRow> errors = sh::expErrors(console.progress());
  console.endProgress();
  if (!console.json) {
    fmt::print("{}\n{}", sh::benchTable(rows), sh::expErrorTable(errors));
    return kDone;
  }
  Json json = Json::array();
  for (const sh::BenchRow& row : rows) {
    json.push_back({{"name", row.name},
                    {"order", row.order},
                    {"median_ns", row.ns},
                    {"best_ns", row.ns_best},
                    {"bar_ns", row.bar_ns > 0.0 ? Json(row.bar_ns) : Json(nullptr)},
                    {"bar_source", row.bar_source}});
  }
  console.print(jsonText({{"device", fmt::format("CPU, one thread, {}", sh::simdTarget())},
                          {"rows", json},
                          {"exponential_errors", exponentialErrors(errors)}}));
  return kDone;
}

int benchBaking(const BenchChoice& choice, Console& console) {
  const Scene scene = loadSceneToDraw(choice.scene, console);
  console.release();
  const PrtBakeBench result = benchBake(scene, {});
  const PrtBakeBench glossy =
      benchBake(scene, {.kind = TransferKind::kShadowed, .glossy = GlossyMeshes::kAll});
  if (!console.json) {
    console.print(fmt::format("{}: {} triangles, {} points, {:.3g} rays a round, {} rounds, all cores",
                              choice.scene.name, countText(result.triangles), countText(result.points),
                              double(result.rays), result.rounds));
    console.print(fmt::format("Embree alone    {:8.2f} Mrays/s", result.bare_mrays_s));
    console.print(fmt::format("first pass      {:8.2f} Mrays/s", result.bake_mrays_s));
    console.print(fmt::format("ratio           {:8.3f}", result.ratio));
    console.print(fmt::format("first bounce    {:8.3f} of the first pass's time, {} directions",
                              result.first_bounce, countText(std::size_t(result.bounce_directions))));
    console.print(fmt::format("later bounces   {:8.3f} of it, each", result.later_bounce));
    console.print(fmt::format("with matrices   {:8.2f} Mrays/s", glossy.bake_mrays_s));
    console.print(fmt::format("ratio           {:8.3f}", glossy.ratio));
    return kDone;
  }
  console.print(jsonText({{"device", fmt::format("CPU, {} threads", std::thread::hardware_concurrency())},
                          {"scene", choice.scene.name},
                          {"triangles", result.triangles},
                          {"points", result.points},
                          {"rays", result.rays},
                          {"rounds", result.rounds},
                          {"bare_mrays_s", result.bare_mrays_s},
                          {"bake_mrays_s", result.bake_mrays_s},
                          {"ratio", result.ratio},
                          {"bounce_directions", result.bounce_directions},
                          {"first_bounce", result.first_bounce},
                          {"later_bounce", result.later_bounce},
                          {"glossy_bake_mrays_s", glossy.bake_mrays_s},
                          {"glossy_ratio", glossy.ratio}}));
  return kDone;
}

int benchGlossyTransfer(const BenchChoice& choice, Console& console) {
  constexpr int kOrder = 5;
  const Scene scene = loadSceneToDraw(choice.scene, console);
  const Environment environment = chooseEnvironment(scene, choice.light, console, 0.0f);
  if (environment.empty()) throw Error("bench gloss", "no light to reflect; expected --env or --light");
  console.release();
  const PrtGlossBench result = benchGloss(scene, projectEnvironment(environment, kOrder), {});
  if (console.json) {
    Json rows = Json::array();
    for (const PrtGlossRow& row : result.rows) {
      rows.push_back({{"exponent", row.exponent},
                      {"shown_exponent", row.shown},
                      {"matrix_error", row.matrix},
                      {"cheap_error", row.cheap},
                      {"unshadowed_error", row.unshadowed},
                      {"truncation", row.truncation}});
    }
    console.print(jsonText({{"scene", choice.scene.name},
                            {"environment", environment.name},
                            {"order", result.order},
                            {"directions", result.directions},
                            {"points", result.points},
                            {"truth_directions", result.truth_directions},
                            {"rows", rows}}));
    return kDone;
  }
  console.print(fmt::format("{}, {}: order {}, {} directions, {} points, each against {} directions",
                            choice.scene.name, environment.name, result.order,
                            countText(std::size_t(result.directions)), countText(result.points),
                            countText(std::size_t(result.truth_directions))));
  console.print(
      "relative RMSE against the same lobe in the same bands; what the bands leave of the lobe, apart");
  console.print("exponent   shown    matrix     cheap   unshadowed   truncation");
  for (const PrtGlossRow& row : result.rows) {
    console.print(fmt::format("{:8g} {:7g} {:7.2f} % {:7.2f} % {:10.1f} % {:10.1f} %", row.exponent,
                              row.shown, 100.0 * row.matrix, 100.0 * row.cheap, 100.0 * row.unshadowed,
                              100.0 * row.truncation));
  }
  return kDone;
}

int benchRelighting(const BenchChoice& choice, Console& console) {
  return benchRelight(choice.scene, console);
}

int benchReferencePaths(const BenchChoice& choice, Console& console) {
  const ViewChoice& view = choice.view;
  const Scene scene = loadSceneToDraw(choice.scene, console);
  const Environment environment = chooseEnvironment(scene, choice.light, console, view.time_s);
  const PosedScene posed = pose(scene, view.time_s);
  const PosedCamera camera = chooseCamera(posed, view, console);
  console.release();
  ReferenceOptions options;
  options.width = view.size.x;
  options.height = view.size.y;
  options.supersample = view.supersample;
  const ReferenceBench result = benchReference(scene, posed, camera, environment, options);
  const std::string size = fmt::format("{}x{}", view.size.x, view.size.y);
  if (!console.json) {
    console.print(
        fmt::format("{}, {}: {} triangles, {} points, {} samples, {:.3g} rays a round, {} rounds, all cores",
                    choice.scene.name, size, countText(result.triangles), countText(result.points),
                    result.samples, double(result.rays), result.rounds));
    console.print(fmt::format("Embree alone    {:8.2f} Mrays/s a core", result.bare_mrays_s));
    console.print(fmt::format("paths           {:8.2f} Mrays/s a core", result.paths_mrays_s));
    console.print(fmt::format("ratio           {:8.3f}", result.ratio));
    return kDone;
  }
  console.print(jsonText({{"device", fmt::format("CPU, {} threads", std::thread::hardware_concurrency())},
                          {"scene", choice.scene.name},
                          {"environment", environment.empty() ? "none" : environment.name},
                          {"size", size},
                          {"triangles", result.triangles},
                          {"points", result.points},
                          {"samples", result.samples},
                          {"rays", result.rays},
                          {"rounds", result.rounds},
                          {"bare_mrays_s", result.bare_mrays_s},
                          {"paths_mrays_s", result.paths_mrays_s},
                          {"ratio", result.ratio}}));
  return kDone;
}

constexpr BenchSuite kSuites[] = {
    {"sh", "spherical harmonics on the CPU", false, false, false, benchSphericalHarmonics},
    {"reference", "the path tracer's ray rate against that of the tracing library alone", true, true, true,
     benchReferencePaths},
    {"bake", "the baker's ray rate against that of the tracing library alone", true, false, false,
     benchBaking},
    {"gloss", "matrices of shadowed gloss against plain integrals, the lobe's truncation apart", true, true,
     false, benchGlossyTransfer},
    {"relight", "what a change of light costs, against the device's own copies", true, false, false,
     benchRelighting},
    {"visibility", "rays to virtual lights, host and device, against the tracing library alone", true, true,
     true, benchVisibility},
};

bool takes(const BenchSuite& suite, const CLI::Option& option) {
  const std::string name = option.get_name(), group = option.get_group();
  if (group == "Light") return suite.takes_light;
  if (group == "View") return suite.takes_view;
  if (name == "SCENE" || name == "--ground") return suite.takes_scene;
  return name == "TECHNIQUE" || name == "--settings" || name == "--quiet" || name == "--json";
}

}  // namespace

std::span<const BenchSuite> benchSuites() {
  return kSuites;
}

void refuseUnused(const BenchSuite& suite, const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || takes(suite, *option)) continue;
    throw Error(option->get_name(), fmt::format("means nothing to what measures '{}'", suite.name));
  }
}

}  // namespace gloam::cli
