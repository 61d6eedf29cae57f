// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, "Radiance filtering": figures 2 and 4 as numbers, and section 4.1, which expects but does not measure: the
// filter of three bands against one shadow ray a pixel, and two to three times the bytes.
#include <fmt/core.h>
#include <gloam/metrics.h>
#include <gloam/reference.h>

#include <algorithm>
#include <cmath>

#include "bench_paper.h"
#include "surface_mask.h"

namespace gloam::cli {
namespace {

using Better = PaperRow::Better;
using Values = std::vector<std::pair<const char*, std::string>>;

constexpr int kSides[] = {2, 4, 8, 16};
// What is drawn: pictures of the technique, the two classical filters, all sets at every pixel by three bands and by the lobes themselves.
struct Kind {
  const char *name, *mode, *beams;
};
constexpr Kind kKinds[] = {{"radiance", "radiance", "on"},
                           {"radiance, three bands alone", "radiance", "off"},
                           {"irradiance", "irradiance", "on"},
                           {"irradiance_normals", "irradiance_normals", "on"},
                           {"brute", "brute", "on"},
                           {"brute, three bands alone", "brute", "off"},
                           {"brute_exact", "brute_exact", "on"}};
enum KindIndex : std::size_t {
  kOurs,
  kOurBands,
  kClassical,
  kClassicalNormals,
  kBrute,
  kBruteBands,
  kExact,
  kCount
};
constexpr int kReferenceSamples = 1024;
// What this project asks of 8 x 8 sets, of which the paper prints pictures.
constexpr int kAskedSide = 8;
constexpr double kMostOverBrute = 1.5, kLeastLead = 6.0;

// Bytes a pixel: what all modes read (frame/gbuffer.h), three bands in halves, one irradiance in halves (RGBA).
constexpr double kGBufferBytes = 44.0, kFieldBytes = 56.0, kIrradianceBytes = 8.0;

RenderOptions with(const BenchStage& stage, const Values& values) {
  RenderOptions options = stage.options;
  for (const auto& [name, value] : values) options.settings.set(name, value);
  return options;
}

/// Pixels of a picture that show a surface which does not shine itself, one after another: what shines is the same in all pictures, and
/// so bright that errors beside it vanish.
struct Foreground {
  std::vector<std::size_t> pixels;

  Image of(const LayeredImage& layers) const {
    const Image all = layers.image("", {"R", "G", "B"}, "frame");
    Image some(int(pixels.size()), 1, 3);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      std::copy_n(&all.pixels[3 * pixels[i]], 3, &some.pixels[3 * i]);
    return some;
  }
};

Foreground foregroundOf(const LayeredImage& reference) {
  const Image mask = surfaceMask(reference, "reference");
  Foreground result;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (mask.pixels[i] > 0.0f) result.pixels.push_back(i);
  }
  if (result.pixels.empty()) throw Error("--paper", "the camera sees no surface");
  return result;
}

LayeredImage drawn(BenchStage& stage, const Values& values) {
  if (interrupted()) throw Interrupted("interrupted: no figures");
  return stage.renderer.render(stage.posed, stage.camera, with(stage, values)).layers;
}

LayeredImage reference(const BenchStage& stage, const BenchChoice& choice, Console& console) {
  ReferenceOptions options;
  options.width = choice.view.size.x, options.height = choice.view.size.y;
  options.supersample = choice.view.supersample;
  options.bounces = stage.options.settings.integer("bounces");
  return renderReference(stage.scene, stage.posed, stage.camera, stage.environment, options,
                         {.samples = kReferenceSamples}, true, console.progress());
}

double relativeRmse(const Image& a, const Image& b) {
  return std::sqrt(relativeSquaredError(a, b));
}

/// Pictures of one number of sets: against the path tracer, and, as the paper compares (Figure 2), against brute force by the same
/// virtual lights.
void addErrors(PaperTable& table, BenchStage& stage, const Foreground& foreground, const Image& truth,
               int side) {
  Image pictures[kCount];
  for (std::size_t k = 0; k < kCount; ++k)
    pictures[k] = foreground.of(
        drawn(stage, {{"mode", kKinds[k].mode}, {"beams", kKinds[k].beams}, {"sets", std::to_string(side)}}));
  const auto asked = [&](double value) { return side == kAskedSide ? std::optional(value) : std::nullopt; };
  const std::string at = fmt::format("{}x{}", side, side);
  const auto add = [&](const std::string& name, double value, const char* unit, Better better,
                       std::optional<double> target = std::nullopt) {
    table.rows.push_back({fmt::format("{}: {}", at, name), value, target, unit, better});
  };
  double to_truth[kCount], to_exact[kCount];
  for (std::size_t k = 0; k < kCount; ++k) {
    to_truth[k] = psnr(pictures[k], truth);
    to_exact[k] = psnr(pictures[k], pictures[kExact]);
    table.plot.curves[k].values.push_back(to_truth[k]);
    add(fmt::format("{} against the path tracer, relative RMSE", kKinds[k].name),
        100.0 * relativeRmse(pictures[k], truth), "%", Better::kLower);
    add(fmt::format("{} against the path tracer, PSNR", kKinds[k].name), to_truth[k], "dB", Better::kHigher);
    if (k != kExact)
      add(fmt::format("{} against brute_exact, the same virtual lights, PSNR", kKinds[k].name), to_exact[k],
          "dB", Better::kHigher);
  }
  const auto lead = [](const double* decibels) {
    return decibels[kOurs] - std::max(decibels[kClassical], decibels[kClassicalNormals]);
  };
  add("radiance over the better classical filter, against the path tracer", lead(to_truth), "dB",
      Better::kHigher, asked(kLeastLead));
  add("radiance over the better classical filter, against brute_exact", lead(to_exact), "dB", Better::kHigher,
      asked(kLeastLead));
  add("radiance against brute: interleaving alone, PSNR", psnr(pictures[kOurs], pictures[kBrute]), "dB",
      Better::kHigher);
  add("brute, three bands alone, against brute_exact: what they cut off, relative RMSE",
      100.0 * relativeRmse(pictures[kBruteBands], pictures[kExact]), "%", Better::kLower);
  add("brute against brute_exact: what beams leave of that, relative RMSE",
      100.0 * relativeRmse(pictures[kBrute], pictures[kExact]), "%", Better::kLower);
  add("error of radiance over that of brute, both against the path tracer",
      relativeRmse(pictures[kOurs], truth) / relativeRmse(pictures[kBrute], truth), "ratio", Better::kLower,
      asked(kMostOverBrute));
}

/// Milliseconds of the passes of one frame whose names end so.
double timeOf(const RenderedFrame& frame, std::initializer_list<const char*> verbs) {
  double sum = 0.0;
  for (const PassTime& pass : frame.passes) {
    for (const char* verb : verbs)
      sum += pass.name == fmt::format("radiance_filter.{}", verb) ? pass.milliseconds : 0.0;
  }
  return sum;
}

void addCosts(PaperTable& table, BenchStage& stage, const BenchChoice& choice) {
  const Values eight = {{"sets", "8"}, {"apart", "off"}};
  Values one_ray = eight, classical = eight;
  one_ray.insert(one_ray.end(), {{"direct", "1"}, {"indirect", "0"}});
  classical.emplace_back("mode", "irradiance");
  std::vector<double> filter, ray, over, gathered;
  for (int round = -1; round < choice.frames; ++round) {  // one to warm up
    if (interrupted()) throw Interrupted("interrupted: no figures");
    const auto draw = [&](const Values& values) {
      return stage.renderer.render(stage.posed, stage.camera, with(stage, values));
    };
    const RenderedFrame ours = draw(eight), single = draw(one_ray), theirs = draw(classical);
    if (round < 0) continue;
    filter.push_back(timeOf(ours, {"weights", "filter", "shade"}));
    ray.push_back(timeOf(single, {"visibility"}));
    over.push_back(filter.back() / std::max(1e-9, ray.back()));
    gathered.push_back((timeOf(ours, {"gather"}) - timeOf(theirs, {"gather"}) + filter.back() -
                        timeOf(theirs, {"weights", "filter", "shade"})) /
                       std::max(1e-9, ray.back()));
  }
  const auto add = [&](const char* name, double ours, std::optional<double> paper, const char* unit,
                       Better better) {
    table.rows.push_back({name, ours, paper, unit, better});
  };
  add("filter and shading at 8x8", quantile(filter, 0.5), std::nullopt, "ms", Better::kLower);
  add("one shadow ray a pixel", quantile(ray, 0.5), std::nullopt, "ms", Better::kNone);
  add("filter and shading over one shadow ray a pixel", quantile(over, 0.5), 1.0, "ratio", Better::kLower);
  add("what three bands take more than irradiance, over one shadow ray a pixel", quantile(gathered, 0.5), 1.0,
      "ratio", Better::kLower);
  add("bytes a pixel", kGBufferBytes + kFieldBytes, std::nullopt, "bytes", Better::kLower);
  add("bytes a pixel over those of the classical filter",
      (kGBufferBytes + kFieldBytes) / (kGBufferBytes + kIrradianceBytes), 3.0, "ratio", Better::kLower);
}

}  // namespace

PaperTable measureRadianceFilterPaper(const BenchChoice& choice, Console& console) {
  BenchStage stage = prepareBench(choice, console);
  console.release();
  const LayeredImage traced = reference(stage, choice, console);
  const Foreground foreground = foregroundOf(traced);
  const Image truth = foreground.of(traced);
  PaperTable table;
  table.device = stage.renderer.device().name;
  table.plot = {.title = "PSNR against the path tracer by how many sets a side are interleaved",
                .across = "sets a side",
                .up = "PSNR, dB",
                .places = {std::begin(kSides), std::end(kSides)},
                .curves = {},
                .notes = {"gloam bench radiance_filter --paper -o FILE.svg"}};
  for (const Kind& kind : kKinds) table.plot.curves.push_back({kind.name, {}});
  const Progress progress = console.progress();
  for (const int side : kSides) {
    progress.report(double(side * side) / 340.0, fmt::format("{} x {} sets", side, side));
    addErrors(table, stage, foreground, truth, side);
  }
  console.endProgress();
  addCosts(table, stage, choice);
  const Settings& settings = stage.options.settings;
  table.notes = {
      fmt::format(
          "{} at {}x{}, {} + {} virtual lights a set, {} rounds of times, a path tracer of {} samples.",
          choice.scene.name, choice.view.size.x, choice.view.size.y, settings.integer("direct"),
          settings.integer("indirect"), choice.frames, kReferenceSamples),
      "Errors are those of surfaces that do not shine themselves (gloam diff --foreground); beside leads and "
      "ratios of 8x8 stands what this project asks.",
      "The paper prints pictures (Figures 2 and 4); of costs it says what it expects: less than one shadow "
      "ray, two to "
      "three times the bytes."};
  return table;
}

}  // namespace gloam::cli
