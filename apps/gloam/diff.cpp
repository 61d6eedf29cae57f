// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam diff: how far a picture is from its reference (REF-2), by all measures, and pictures of where. Options of bounds,
// lines of the table and keys of the JSON come from the one table of measures.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <image/measure_table.h>

#include "arguments.h"
#include "diff_inputs.h"
#include "diff_pictures.h"
#include "json.h"
#include "verb.h"

namespace gloam::cli {
namespace {

struct DiffChoice {
  DiffInputs inputs;
  DiffPictures pictures;
  float peak = 0.0f, pixels_per_degree = float(MetricOptions{}.pixels_per_degree);
  std::string exposure, tone_map;        ///< empty: as suits the pictures
  std::map<std::string, double> bounds;  ///< by the measure's key
};

/// "--max-relative-squared-error", "--min-psnr".
std::string boundOption(const Measure& measure) {
  std::string name = measure.key;
  if (name.starts_with("max_")) name.erase(0, 4);
  std::ranges::replace(name, '_', '-');
  return (measure.better == Measure::Better::kHigher ? "--min-" : "--max-") + name;
}

// Pictures that are light of a display already are shown as they are.
DisplayOptions displayOf(const DiffChoice& choice, bool display) {
  DisplayOptions options;
  const bool plain = choice.tone_map.empty() ? display : choice.tone_map == "none";
  options.tone_map = plain ? ToneMap::kNone : ToneMap::kAces;
  options.auto_exposure = choice.exposure.empty() ? !display : choice.exposure == "auto";
  if (!choice.exposure.empty() && choice.exposure != "auto") {
    options.exposure_stops = float(parseNumber("--exposure", choice.exposure, {-50.0, 50.0}));
  }
  return options;
}

std::vector<const Measure*> exceededMeasures(const DiffChoice& choice, const Metrics& metrics) {
  std::vector<const Measure*> exceeded;
  for (const Measure& measure : measureTable()) {
    const auto bound = choice.bounds.find(measure.key);
    if (bound != choice.bounds.end() && exceeds(measure, metrics, bound->second))
      exceeded.push_back(&measure);
  }
  return exceeded;
}

std::string valueText(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : fmt::format("{}", value);
}

void printTable(const DiffChoice& choice, const DiffPair& pair, const Metrics& metrics, Console& console) {
  const std::string layer = choice.inputs.layer.empty() ? "" : fmt::format(", layer {}", choice.inputs.layer);
  const std::size_t all = pair.reference.pixelCount();
  const std::string part = metrics.pixels == all
                               ? ""
                               : fmt::format(", {} of {} pixels", countText(metrics.pixels), countText(all));
  console.print(
      singleLine(fmt::format("{} against {}{}, {}x{}{}", choice.inputs.picture, choice.inputs.reference,
                             layer, pair.reference.width, pair.reference.height, part)));
  for (const Measure& measure : measureTable()) {
    std::string line = fmt::format("  {:<24}{:>13} {:<4}{}", measure.title, valueText(metrics.*measure.value),
                                   measure.unit, measure.meaning);
    console.print(line);
  }
}

Json resultJson(const DiffChoice& choice, const DiffPair& pair, const Metrics& metrics,
                const std::vector<const Measure*>& exceeded,
                const std::vector<std::filesystem::path>& files) {
  Json json = {{"picture", choice.inputs.picture},
               {"reference", choice.inputs.reference},
               {"layer", choice.inputs.layer.empty() ? Json() : Json(choice.inputs.layer)},
               {"size", fmt::format("{}x{}", pair.reference.width, pair.reference.height)},
               {"pixels", metrics.pixels}};
  for (const Measure& measure : measureTable()) json[measure.key] = metrics.*measure.value;
  json["exceeded"] = Json::array();
  for (const Measure* measure : exceeded) json["exceeded"].push_back(measure->key);
  json["outputs"] = Json::array();
  for (const auto& file : files) json["outputs"].push_back(file.string());
  return json;
}

/// The listener for a part of the work.
Progress partOf(const Progress& whole, double begin, double end) {
  Progress part = whole;
  part.update = [whole, begin, end](double fraction, const std::string& what) {
    whole.report(begin + fraction * (end - begin), what);
  };
  return part;
}

/// Options of pictures that nobody asked for.
void refuseIdleOptions(const CLI::App& app, const DiffPictures& pictures) {
  if (!pictures.folder.empty()) return;  // all pictures are there
  if (app.get_option("--factor")->count() > 0 && pictures.difference.empty() &&
      pictures.signed_difference.empty())
    throw Error("--factor", "--difference, --signed-difference or -o was expected with it");
  if (app.get_option("--top")->count() > 0 && pictures.false_color.empty())
    throw Error("--top", "--false-color or -o was expected with it");
}

int runDiff(const DiffChoice& choice, const CLI::App& app, Console& console) {
  refuseIdleOptions(app, choice.pictures);
  displayOf(choice, false);  // what is typed wrong is said before any work
  DiffOutput output(choice.pictures, choice.inputs);
  std::string remark;
  DiffPair pair = readPair(choice.inputs, remark);
  if (!remark.empty()) console.remark(remark);

  MetricOptions options;
  options.mask = pair.mask;
  options.peak = double(choice.peak);
  options.pixels_per_degree = double(choice.pixels_per_degree);
  options.display = displayOf(choice, pair.display);
  const Progress progress = console.progress();
  const Metrics metrics = measure(pair.picture, pair.reference, options, partOf(progress, 0.0, 0.5));
  const std::vector<std::filesystem::path> files = output.write(pair, options, partOf(progress, 0.5, 1.0));
  console.endProgress();

  const std::vector<const Measure*> exceeded = exceededMeasures(choice, metrics);
  if (console.json) {
    console.print(jsonText(resultJson(choice, pair, metrics, exceeded, files)));
  } else {
    printTable(choice, pair, metrics, console);
    for (const auto& file : files) console.remark(fmt::format("wrote {}", file.string()));
  }
  console.release();
  for (const Measure* measure : exceeded) {
    fmt::print(stderr, "gloam: {} is {}, the bound {} is {}\n", measure->title,
               valueText(boundedValue(*measure, metrics)), boundOption(*measure),
               valueText(choice.bounds.at(measure->key)));
  }
  return exceeded.empty() ? kDone : kBoundExceeded;
}

void addComparisonOptions(CLI::App& app, DiffChoice& choice) {
  const auto group = "Comparison";
  addText(app, "--layer", choice.inputs.layer, "NAME",
          "a layer of OpenEXR files: direct, indirect, albedo and so on, instead of the picture")
      ->group(group);
  addName(app, "--mask", choice.inputs.mask, "FILE", "a picture that is black where pixels do not count")
      ->group(group);
  app.add_flag("--foreground", choice.inputs.foreground,
               "only pixels where the reference shows a surface, by its layer object.id or its alpha")
      ->group(group);
  addNumber(app, "--peak", choice.peak, {1e-30, 1e30}, "VALUE",
            "what counts as white for PSNR and SSIM [brightest value of the reference]")
      ->group(group);
  addNumber(app, "--pixels-per-degree", choice.pixels_per_degree, {1.0, 1000.0}, "N",
            "for FLIP: pixels that stand for a degree of the eye")
      ->default_str("67.0206")
      ->group(group);
  addText(
      app, "--exposure", choice.exposure, "STOPS|auto",
      "for LDR-FLIP and difference pictures, of both alike; auto finds it in the reference [auto; 0 for PNG "
      "and JPEG]")
      ->group(group);
  addChoice(app, "--tone-map", choice.tone_map, {"none", "aces"},
            "the curve for the same [aces; none for PNG and JPEG]")
      ->group(group);
}

void addPictureOptions(CLI::App& app, DiffPictures& pictures) {
  addName(app, "--difference", pictures.difference, "FILE", "size of the difference, black where equal")
      ->group("Output");
  addName(app, "--signed-difference", pictures.signed_difference, "FILE",
          "grey plus the difference: light where the picture is too bright")
      ->group("Output");
  addNumber(app, "--factor", pictures.factor, {1e-3, 1e6}, "N", "of both differences")
      ->default_str("2")
      ->group("Output");
  addName(app, "--false-color", pictures.false_color, "FILE",
          "size of the difference relative to the reference's mean, black to pale yellow")
      ->group("Output");
  addNumber(app, "--top", pictures.top, {1e-6, 1e6}, "X", "what of the mean false colour ends at")
      ->default_str("1")
      ->group("Output");
  addName(app, "--flip", pictures.flip, "FILE", "the map of HDR-FLIP")->group("Output");
  addName(app, "--ldr-flip", pictures.ldr_flip, "FILE", "the map of LDR-FLIP")->group("Output");
}

void addBoundOptions(CLI::App& app, DiffChoice& choice) {
  for (const Measure& measure : measureTable()) {
    const std::string name = boundOption(measure);
    const bool size = measure.better == Measure::Better::kNearerZero;
    const bool least = measure.better == Measure::Better::kHigher;
    Range range;
    if (!least) range.minimum = 0.0;
    const auto parse = [&choice, name, range, key = measure.key](const std::string& text) {
      choice.bounds[key] = parseNumber(name, text, range);
    };
    app.add_option_function<std::string>(
           name, parse,
           fmt::format("{}{} of at {} X", measure.title, size ? ", gained or lost," : "",
                       least ? "least" : "most"))
        ->type_name("X")
        ->group("Bounds: exit code 1 where one is exceeded");
  }
}

std::function<int()> declareDiff(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<DiffChoice>();
  addName(app, "PICTURE", choice->inputs.picture, "FILE", "what is measured: .exr, .hdr, .png or .jpg")
      ->required();
  addName(app, "REFERENCE", choice->inputs.reference, "FILE", "what it should be, of the same size")
      ->required();
  addComparisonOptions(app, *choice);
  addOutput(app, choice->pictures.folder, "FOLDER",
            "writes difference.png, signed_difference.png, false_color.png, flip.png and ldr_flip.png there");
  addPictureOptions(app, choice->pictures);
  addConsoleOptions(app, console, true);
  addBoundOptions(app, *choice);
  return [choice, &app, &console] { return runDiff(*choice, app, console); };
}

}  // namespace

extern const Verb kDiffVerb;
const Verb kDiffVerb = {
    "diff", "measures how far a picture is from its reference, and draws where",
    "gloam diff frame.exr reference.exr | all measures\n"
    "gloam diff frame.exr reference.exr --layer indirect --foreground | bounced light, on surfaces only\n"
    "gloam diff frame.exr reference.exr -o where | with where/difference.png and four more pictures\n"
    "gloam diff frame.exr reference.exr --max-relative-squared-error 0.001 --min-ssim 0.98 | for scripts: "
    "exit "
    "code 1 where it is worse\n",
    declareDiff};

}  // namespace gloam::cli
