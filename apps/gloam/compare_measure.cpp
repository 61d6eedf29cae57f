// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_measure.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "surface_mask.h"

namespace gloam::cli {
namespace {

const std::vector<std::string> kRgb = {"R", "G", "B"};

/// Measures of one layer of a pair of files, and the FLIP map for the page, which calls it `name`.
LayerError measureLayer(const LayeredImage& a, const LayeredImage& reference, const std::string& layer,
                        const char* name, const Image& mask, const Progress& progress, PagePicture& picture) {
  const Image ours = a.image(layer, kRgb, "picture"), truth = reference.image(layer, kRgb, "reference");
  MetricOptions options;
  options.mask = mask;
  // As `gloam diff` takes numbers from its command line: its answers are to be the same to the last digit.
  options.pixels_per_degree = double(float(options.pixels_per_degree));
  const Metrics metrics = measure(ours, truth, options, stretch(progress, 0.0, 0.6));
  picture.flip[name] = flipMap(ours, truth, options.pixels_per_degree, stretch(progress, 0.6, 1.0));
  return metrics;
}

PagePicture lightPicture(const LayeredImage& light, const std::string& label) {
  PagePicture picture;
  picture.label = label;
  picture.direct = light.image("direct", kRgb, label);
  picture.indirect = light.image("indirect", kRgb, label);
  return picture;
}

std::string bouncesText(int bounces) {
  return fmt::format("{} {}", bounces, bounces == 1 ? "bounce" : "bounces");
}

/// To how many bounces a technique is held: its own, where the reference tells them from further ones; else says so. With none at
/// all, to no indirect light.
void holdBounces(const Comparison& work, const Contender& contender, TechniqueResult& result) {
  if (!anyIndirect(coverageOf(contender))) return;
  const int own = bouncesOf(contender, work.stage.baked_bounces), there = work.stage.bounces;
  result.bounces = there, result.own_bounces = own;
  if (own > 0 && there == 0) {
    result.direct_alone = true;
    result.notes.push_back("the reference has no bounces: direct light alone is measured");
  } else if (own > there) {
    result.notes.push_back(fmt::format("its light has {}, the reference {}: what is more counts as error",
                                       bouncesText(own), there));
  } else if (own < there && (own == 0 || tellsBounces(work.reference, result.covers, own))) {
    result.bounces = own;
  } else if (own < there) {
    result.notes.push_back(
        fmt::format("its light has {}, the reference {} in one sum: what is missing counts as error",
                    bouncesText(own), there));
  }
  if (result.bounces > 0) return;
  result.covers = directOf(result.covers);
  result.missing = without(work.stage.in_scene, result.covers);
}

using Held = std::pair<Coverage, int>;
Held heldTo(const TechniqueResult& technique) {
  return {technique.covers, technique.bounces};
}

/// Who is held to that light: a technique's name where all of its settings are, else their labels.
std::string namesOf(const std::vector<TechniqueResult>& techniques, const Held& held) {
  std::vector<std::string> names;
  for (const TechniqueResult& technique : techniques) {
    if (heldTo(technique) != held) continue;
    const bool all = std::ranges::all_of(techniques, [&](const TechniqueResult& other) {
      return other.name != technique.name || heldTo(other) == held;
    });
    const std::string& name = all ? technique.name : technique.label;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

/// A stretch of the whole work.
Progress stretch(const Progress& whole, double from, double to) {
  Progress part{{}, whole.should_stop};
  if (whole.update) {
    part.update = [whole, from, to](double fraction, const std::string& what) {
      whole.update(from + (to - from) * fraction, what);
    };
  }
  return part;
}

void measureAll(Comparison& work, const Progress& progress) {
  work.results.reference_relative_noise = relativeNoise(work.reference, work.stage.glowing);
  const double count = double(work.contenders.size());
  for (std::size_t i = 0; i < work.contenders.size(); ++i) {
    if (progress.stopRequested()) {
      throw Interrupted(fmt::format("interrupted; the pictures are in {}", work.folder.path().string()));
    }
    TechniqueResult& result = work.results.techniques[i];
    holdBounces(work, work.contenders[i], result);
    writeExr(lightForPart(work.reference, result.covers, result.bounces, work.stage.glowing),
             result.reference_file);
    const LayeredImage ours = readExr(result.file), truth = readExr(result.reference_file);
    const Image mask = surfaceMask(truth, result.reference_file.string());
    if (std::ranges::none_of(mask.pixels, [](float value) { return value > 0.0f; }))
      throw Error(work.reference.file.string(), "shows no surface: nothing to compare");
    PagePicture picture = lightPicture(ours, result.label);
    picture.technique = int(i);
    const auto measured = [&](const char* layer, const char* name, double from, double to) {
      return measureLayer(ours, truth, layer, name, mask,
                          stretch(progress, (double(i) + from) / count, (double(i) + to) / count), picture);
    };
    const char* all = result.direct_alone ? "direct" : "";
    if (result.direct_alone) std::ranges::fill(picture.indirect.pixels, 0.0f);
    result.sum = measured(all, "sum", 0.0, 0.34);
    result.reference_noise = relativeNoise(work.reference, result.covers, result.bounces,
                                           truth.image(all, kRgb, "reference"), mask);
    if (anyDirect(result.covers)) result.direct = measured("direct", "direct", 0.34, 0.67);
    if (anyIndirect(result.covers)) result.indirect = measured("indirect", "indirect", 0.67, 1.0);
    result.command =
        fmt::format("gloam diff {} {} --foreground{}", shellWord(result.file.string()),
                    shellWord(result.reference_file.string()), result.direct_alone ? " --layer direct" : "");
    work.page.pictures.push_back(std::move(picture));
  }
}

void addReferencePictures(Comparison& work) {
  std::vector<PagePicture>& pictures = work.page.pictures;
  const std::vector<TechniqueResult>& techniques = work.results.techniques;
  std::vector<std::pair<Held, std::size_t>> known;
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    const Held held = heldTo(techniques[i]);
    auto found = std::ranges::find(known, held, &std::pair<Held, std::size_t>::first);
    if (found == known.end()) {
      found = known.insert(known.end(), {held, pictures.size()});
      pictures.push_back(lightPicture(readExr(techniques[i].reference_file), namesOf(techniques, held)));
    }
    pictures[i].reference = int(found->second);
  }
  const Held all{both(work.stage.in_scene, coverageOf(work.reference.layers, work.reference.file.string())),
                 work.stage.bounces};
  const bool all_is_there =
      std::ranges::find(known, all, &std::pair<Held, std::size_t>::first) != known.end();
  for (const auto& [part, index] : known) {
    std::string& label = pictures[index].label;
    label = known.size() == 1 && all_is_there ? "Reference" : "Reference for " + label;
  }
  if (!all_is_there) pictures.push_back(lightPicture(work.reference.layers, "Reference, all light"));
}

}  // namespace gloam::cli
