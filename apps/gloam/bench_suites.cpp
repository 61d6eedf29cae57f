// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_suites.h"

#include <fmt/core.h>
#include <math/sh_batch.h>
#include <math/sh_bench.h>

#include "json.h"

namespace gloam::cli {
namespace {

int benchSphericalHarmonics(Console& console) {
  const std::vector<sh::BenchRow> rows = sh::bench(9, 0.01, console.progress());
  console.endProgress();
  if (!console.json) {
    fmt::print("{}", sh::benchTable(rows));
    return 0;
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
  return 0;
}

constexpr BenchSuite kSuites[] = {
    {"sh", "spherical harmonics on the CPU", benchSphericalHarmonics},
};

}  // namespace

std::span<const BenchSuite> benchSuites() { return kSuites; }

}  // namespace gloam::cli
