// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The order is: all that can go wrong quickly; every contender drawn; the reference, which takes longest; measures of the
// pictures as their files hold them; the page. What was written stays when interrupted.
#include "compare_run.h"

#include <fmt/core.h>
#include <image/tonemap.h>

#include <algorithm>
#include <cmath>

#include "compare_given.h"
#include "compare_measure.h"
#include "verb.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

/// Settings that change no light share one.
fs::path referenceFileOf(const Comparison& work, const Contender& contender) {
  const Contender usual{contender.technique, Settings(contender.technique->options)};
  const bool as_usual =
      coverageOf(contender) == coverageOf(usual) && bouncesOf(contender, 0) == bouncesOf(usual, 0);
  return work.folder.file(
      fmt::format("reference_{}.exr", as_usual ? contender.technique->name : contender.stem));
}

void haveSpheres(Comparison& work, Console& console) {
  for (const Contender& contender : work.contenders) {
    std::optional<SceneSpheres>& spheres = work.spheres.emplace_back();
    std::optional<SceneEmission>& emission = work.emission.emplace_back();
    BakeTime& time = work.sphere_times.emplace_back();
    if (!contender.technique->needs_spheres) continue;
    spheres = spheresForDrawing(work.stage.scene, work.choice.scene.name, work.choice.use_cache, console,
                                contender.settings.integer("spheres"), &time, work.choice.spheres);
    if (!contender.technique->needs_emission) continue;
    emission = emissionForDrawing(work.stage.scene, *spheres, work.choice.scene.name, work.choice.use_cache,
                                  console, &time);
    work.dark_emitters = emittersWithoutSpheres(work.stage.scene, *spheres);
  }
}

void drawAll(Comparison& work, const Progress& progress, Console& console) {
  const bool background = !work.choice.reference.empty() && work.reference.background;
  const double count = double(work.contenders.size());
  for (std::size_t i = 0; i < work.contenders.size(); ++i) {
    const Contender& contender = work.contenders[i];
    const ContenderSpheres given{work.spheres[i] ? &*work.spheres[i] : nullptr,
                                 work.emission[i] ? &*work.emission[i] : nullptr};
    Drawn drawn = drawContender(work.stage, work.choice, contender, given, background,
                                stretch(progress, double(i) / count, double(i + 1) / count));
    work.folder.make();
    TechniqueResult result{.name = contender.technique->name, .label = contender.label};
    result.file = work.folder.file(contender.stem + ".exr");
    result.reference_file = referenceFileOf(work, contender);
    writeExr(drawn.picture, result.file);
    console.release();
    result.settings = settingsJson(*contender.technique, contender.settings);
    result.device_ms = drawn.timings.medianPassesMs();
    result.frame_ms = drawn.timings.medianFrameMs();
    result.passes = drawn.timings.passesJson();
    result.memory_bytes = drawn.timings.memoryBytes();
    result.notes = std::move(drawn.warnings);
    if (contender.technique->needs_emission && coverageOf(contender).emitter_direct) {
      for (const std::string& name : work.dark_emitters)
        result.notes.push_back(fmt::format("light of '{}' is missing: it has no spheres, and deforms", name));
    }
    if (contender.technique->needs_bake) {
      const CompareStage::Bake* bake = work.stage.bakeFor(contender);
      if (bake) result.bake_seconds = bake->time.seconds;
      result.bake_note = bake ? bake->time.note : "the file was baked beforehand";
    } else if (contender.technique->needs_spheres) {
      result.bake_seconds = work.sphere_times[i].seconds;
      result.bake_note = work.sphere_times[i].note;
    }
    result.covers = both(coverageOf(contender), work.stage.in_scene);
    result.missing = without(work.stage.in_scene, coverageOf(contender));
    work.results.device = drawn.device;
    work.results.techniques.push_back(std::move(result));
  }
}

void writeAll(Comparison& work) {
  addReferencePictures(work);
  const Json json = resultsJson(work.results);
  work.page.title = sceneStem(work.choice.scene.name);
  work.page.results = json;
  const Image light = work.reference.layers.image("", {"R", "G", "B", "A"}, "reference");
  work.page.coverage = work.reference.layers.image("", {"A"}, "reference");
  const float found = std::round(4.0f * autoExposureStops(meanLog2Luminance(light))) / 4.0f;
  work.page.exposure_stops = std::clamp(work.choice.exposure_stops.value_or(found), -8.0f, 8.0f);
  std::vector<fs::path> kept = {work.choice.reference};
  for (const TechniqueResult& r : work.results.techniques)
    kept.insert(kept.end(), {r.file, r.reference_file});
  work.folder.removeStale(kept);
  work.folder.writeText("results.json", jsonText(json) + "\n");
  work.folder.writeText("results.csv", resultsCsv(work.results));
  writePage(work.page, work.folder.file("index.html"));
}

void haveReference(Comparison& work, const Progress& progress, Console& console) {
  const CompareChoice& choice = work.choice;
  if (choice.reference.empty()) {
    ReferenceOptions options;
    options.width = choice.view.size.x, options.height = choice.view.size.y;
    options.supersample = choice.view.supersample;
    options.bounces = work.stage.bounces;
    options.environment_order = choice.environment_order.value_or(0);
    options.background = false;
    options.seed = std::uint64_t(choice.seed.value_or(0));
    constexpr int kSamples = 64, kSamplesByNoise = 65536;
    const int samples = choice.samples.value_or(choice.noise > 0.0f ? kSamplesByNoise : kSamples);
    work.reference =
        traceReference({work.stage.scene, work.stage.posed, work.stage.camera, work.stage.environment},
                       options, samples, choice.noise, work.folder.file("reference.exr"), progress, console);
  }
  work.results.bounces = work.stage.bounces;
  work.results.environment_order = work.reference.environment_order;
  work.results.reference_file = work.reference.file;
  work.results.reference_text = work.reference.text;
  work.results.reference_samples = work.reference.samples;
  work.results.reference_noise = work.reference.noise;
}

Comparison compareAll(CompareChoice choice, Console& console) {
  std::vector<Contender> contenders = choice.techniques.empty()
                                          ? allContenders(choice.options)
                                          : planContenders(choice.techniques, choice.options);
  if (choice.output.empty()) choice.output = sceneStem(choice.scene.name) + "_compare";
  CompareFolder folder(choice.output);
  ReferencePicture given;
  if (!choice.reference.empty()) given = takeReference(choice);
  const std::optional<int> bounces =
      choice.reference.empty() ? std::nullopt : std::optional<int>(given.bounces);
  CompareStage stage = prepareCompareStage(choice, contenders, bounces, console);
  Comparison work{std::move(choice),
                  std::move(contenders),
                  std::move(stage),
                  std::move(folder),
                  std::move(given),
                  {},
                  {},
                  {}};
  if (!work.choice.reference.empty())
    checkGivenReference(work.reference, work.choice, work.stage, work.contenders, console);
  bakeCompareStage(work.stage, work.choice, work.contenders, console);
  haveSpheres(work, console);
  work.results.scene = work.choice.scene.name;
  work.results.environment = work.stage.environment.name;
  work.results.size = fmt::format("{}x{}", work.choice.view.size.x, work.choice.view.size.y);
  work.results.command = console.command;

  const bool traces = work.choice.reference.empty();
  const Progress whole = console.progress();
  const double drawn = traces ? 0.15 : 0.5, traced = traces ? 0.8 : 0.5;
  drawAll(work, stretch(whole, 0.0, drawn), console);
  haveReference(work, stretch(whole, drawn, traced), console);
  measureAll(work, stretch(whole, traced, 0.97));
  whole.report(0.97, "page");
  writeAll(work);
  console.endProgress();
  return work;
}

}  // namespace

Json compareQuietly(CompareChoice choice, Console& console) {
  return resultsJson(compareAll(std::move(choice), console).results);
}

int runCompare(CompareChoice choice, Console& console) {
  const Comparison work = compareAll(std::move(choice), console);
  if (console.json) {
    console.print(jsonText(resultsJson(work.results)));
  } else {
    for (const std::string& line : resultsTable(work.results)) console.print(line);
    console.remark(fmt::format("wrote {}", work.folder.file("index.html").string()));
  }
  for (const std::string& line : noteLines(work.results)) console.remark(line);
  if (const std::string remark = bouncesRemark(work.results); !remark.empty()) console.remark(remark);
  if (const std::string remark = noiseRemark(work.results); !remark.empty()) console.remark(remark);
  const double noise = work.results.reference_noise.value_or(0.0), asked = double(work.choice.noise);
  if (asked == 0.0 || noise <= asked) return kDone;
  console.remark(
      fmt::format("noise is still {:.2g} % after {} paths a pixel; {:.2g} % was asked for", 100.0 * noise,
                  countText(std::size_t(work.results.reference_samples.value_or(0))), 100.0 * asked));
  return kBoundExceeded;
}

}  // namespace gloam::cli
