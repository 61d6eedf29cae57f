// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, "Real-time indirect illumination and soft shadows in dynamic scenes using spherical lights", Figures
// 7 (balls grown into each other), 8 (four scenes of rising complexity), 9 (a cylinder bent), 10 (a box by one sphere and by eight) and
// 11 (what no order sorts), made again in kind.
#include "bench_figures.h"

#include <fmt/core.h>
#include <gloam/metrics.h>

#include <algorithm>
#include <filesystem>

#include "compare_run.h"
#include "verb.h"

namespace gloam::cli {
namespace {

constexpr int kSamples = 256;

struct Experiment {
  const char *name, *what, *scene, *option, *value;
  float time_s = 0.0f;
};
constexpr Experiment kExperiments[] = {
    {"7a", "two balls apart, one object", "builtin:pair?overlap=-0.3", "spheres", "2"},
    {"7b", "two balls grown into each other", "builtin:pair?overlap=0.5", "spheres", "2"},
    {"8a", "one ball", "builtin:balls?count=1", "spheres", "1"},
    {"8b", "five balls", "builtin:balls", "spheres", "5"},
    {"8c", "squirrel", "builtin:squirrel", "spheres", "14"},
    {"8d", "robot", "builtin:robot", "spheres", "26"},
    {"9a", "cylinder, bent by 90 degrees", "builtin:bend?angle=90", "spheres", "12", 2.0f},
    {"9b", "cylinder, bent by 180 degrees", "builtin:bend?angle=180", "spheres", "12", 2.0f},
    {"10a", "box, one sphere", "builtin:box", "spheres", "1"},
    {"10b", "box, eight spheres", "builtin:box", "spheres", "8"},
    {"11a", "links, per object", "builtin:links", "blocking", "per_object"},
    {"11b", "links, per sphere", "builtin:links", "blocking", "per_sphere"},
    {"11c", "bars, per object", "builtin:bars", "blocking", "per_object"},
    {"11d", "bars, per sphere", "builtin:bars", "blocking", "per_sphere"},
};

/// Comparisons behind it say nothing.
class Silent : public Console {
 public:
  Silent() { quiet = true; }
  void remark(const std::string&) override {}
};

void writeStrip(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const auto colorOf = [&](const char* name) {
    const std::filesystem::path from = folder / name;
    return readExr(from).image("", {"R", "G", "B"}, from.string());
  };
  const Image ours = colorOf("spherical_lights.exr"), truth = colorOf("reference_spherical_lights.exr");
  const DisplayOptions display;
  const Image parts[] = {toneMapped(ours, display), toneMapped(truth, display),
                         absoluteDifferencePicture(ours, truth, 2.0, display)};
  Image strip(3 * ours.width, ours.height, 3);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < ours.height; ++y)
      std::copy_n(parts[p].at(0, y), 3 * ours.width, strip.at(p * ours.width, y));
  }
  writePng(strip, file);
}

/// Percent; of one technique's part of results.json.
double errorOf(const Json& result, const char* part) {
  return 100.0 * result.at(part).at("relative_squared_error").get<double>();
}

}  // namespace

int benchFigures(const BenchChoice& choice, Console& console) {
  if (choice.subject != "spherical_lights")
    throw Error("--figures",
                fmt::format("no experiments are kept of '{}'; expected spherical_lights", choice.subject));
  const std::filesystem::path directory = choice.figures;
  std::filesystem::create_directories(directory);
  Json rows = Json::array();
  const Progress progress = console.progress();
  double done = 0.0;
  for (const Experiment& experiment : kExperiments) {
    if (interrupted()) throw Interrupted("interrupted: no figures");
    progress.report(done++ / double(std::size(kExperiments)), experiment.what);
    CompareChoice compare{.scene = {.name = experiment.scene}, .view = choice.view, .size_given = true};
    compare.view.time_s = experiment.time_s;
    compare.options = choice.technique;
    compare.techniques = "spherical_lights";
    compare.options.values["spherical_lights"].try_emplace(experiment.option, experiment.value);
    compare.bounces = 1;
    compare.samples = kSamples;
    compare.frames = 1;
    compare.device = choice.device;
    const std::filesystem::path folder = directory / experiment.name;
    compare.output = folder.string();
    Silent silent;
    const Json result = compareQuietly(compare, silent).at("techniques").at(0);
    writeStrip(folder, directory / fmt::format("figure_{}.png", experiment.name));
    rows.push_back({{"figure", experiment.name},
                    {"what", experiment.what},
                    {"scene", experiment.scene},
                    {"settings", fmt::format("{}={}", experiment.option, experiment.value)},
                    {"direct", errorOf(result, "direct")},
                    {"indirect", errorOf(result, "indirect")},
                    {"all", 100.0 * result.at("relative_squared_error").get<double>()},
                    {"energy", result.at("indirect").at("mean_signed_error")}});
  }
  console.endProgress();
  if (console.json) {
    console.print(jsonText({{"unit", "% relative squared error"}, {"rows", rows}}));
    return kDone;
  }
  console.print(fmt::format("{:<6}  {:<34}  {:>8}  {:>8}  {:>8}  {:>10}", "figure", "", "direct", "indirect",
                            "all", "energy"));
  for (const Json& row : rows)
    console.print(fmt::format("{:<6}  {:<34}  {:>6.2f} %  {:>6.2f} %  {:>6.2f} %  {:>+10.4f}",
                              row.at("figure").get<std::string>(), row.at("what").get<std::string>(),
                              row.at("direct").get<double>(), row.at("indirect").get<double>(),
                              row.at("all").get<double>(), row.at("energy").get<double>()));
  console.print(
      fmt::format("relative squared error, energy of indirect light; pictures in {}", directory.string()));
  return kDone;
}

}  // namespace gloam::cli
