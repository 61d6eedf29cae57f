// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_suites.h"

#include <fmt/core.h>
#include <math/sh_batch.h>
#include <math/sh_bench.h>
#include <techniques/prt/prt_bake_bench.h>

#include <thread>

#include "json.h"
#include "scene_inputs.h"
#include "verb.h"

namespace gloam::cli {
namespace {

int benchSphericalHarmonics(const std::string&, Console& console) {
  const std::vector<sh::BenchRow> rows = sh::bench(9, 0.01, console.progress());
  console.endProgress();
  if (!console.json) {
    fmt::print("{}", sh::benchTable(rows));
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
  console.print(jsonText({{"device", fmt::format("CPU, one thread, {}", sh::simdTarget())}, {"rows", json}}));
  return kDone;
}

int benchBaking(const std::string& scene_name, Console& console) {
  const Scene scene = loadSceneToDraw({.name = scene_name}, console);
  console.release();
  const PrtBakeBench result = benchBake(scene, {});
  if (!console.json) {
    console.print(fmt::format("{}: {} triangles, {} points, {:.3g} rays a round, {} rounds, all cores",
                              scene_name, countText(result.triangles), countText(result.points),
                              double(result.rays), result.rounds));
    console.print(fmt::format("Embree alone    {:8.2f} Mrays/s", result.bare_mrays_s));
    console.print(fmt::format("first pass      {:8.2f} Mrays/s", result.bake_mrays_s));
    console.print(fmt::format("ratio           {:8.3f}", result.ratio));
    return kDone;
  }
  console.print(jsonText({{"device", fmt::format("CPU, {} threads", std::thread::hardware_concurrency())},
                          {"scene", scene_name},
                          {"triangles", result.triangles},
                          {"points", result.points},
                          {"rays", result.rays},
                          {"rounds", result.rounds},
                          {"bare_mrays_s", result.bare_mrays_s},
                          {"bake_mrays_s", result.bake_mrays_s},
                          {"ratio", result.ratio}}));
  return kDone;
}

constexpr BenchSuite kSuites[] = {
    {"sh", "spherical harmonics on the CPU", benchSphericalHarmonics},
    {"bake", "the baker's ray rate against that of the tracing library alone", benchBaking},
};

}  // namespace

std::span<const BenchSuite> benchSuites() {
  return kSuites;
}

}  // namespace gloam::cli
