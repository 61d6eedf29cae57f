// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/reference_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "scene/coverage.h"

namespace gloam {

namespace reference {

static_assert(std::size(kCoverageMembers) == kSeen);

std::string nameOf(LightPath path) {
  if (path == kSeen) return "seen";
  const std::string name = kCoverageMembers[memberOf(path)].name;
  return bouncesOf(path) > 1 ? fmt::format("{}_{}", name, bouncesOf(path)) : name;
}

bool isDirect(LightPath path) {
  return path == kSeen || kCoverageMembers[memberOf(path)].direct;
}

bool covers(const Coverage& light, LightPath path) {
  return path == kSeen || light.*kCoverageMembers[memberOf(path)].member;
}

std::string coverageText(const Coverage& light) {
  const std::vector<std::string> names = coverageNames(light);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, " "));
}

bool isPartOf(const Coverage& part, const Coverage& whole) {
  return without(part, whole) == Coverage{};
}

}  // namespace reference

using namespace reference;

namespace {

constexpr const char* kLight = "gloam.light";
constexpr const char* kSources = "gloam.sources";
constexpr const char* kBounces = "gloam.bounces";

const std::string* attribute(const LayeredImage& image, const char* name) {
  const auto found = image.attributes.find(name);
  return found == image.attributes.end() ? nullptr : &found->second;
}

Coverage parseCoverage(const std::string& text, const std::string& place) {
  Coverage light;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    bool known = word == "none";
    for (const CoverageMember& m : kCoverageMembers) {
      if (word == m.name) light.*m.member = known = true;
    }
    if (!known) throw Error(place, fmt::format("'{}' is no kind of light", word));
  }
  return light;
}

/// Which sources the scene had of those that were followed; all of them where the file does not say.
Coverage sourcesOf(const LayeredImage& file, const Coverage& whole, const std::string& place) {
  const std::string* text = attribute(file, kSources);
  return text ? both(whole, parseCoverage(*text, place + ": attribute gloam.sources")) : whole;
}

/// Bounces of paths that a file holds; nothing where it does not say.
std::optional<int> bouncesIn(const LayeredImage& file) {
  const std::string* text = attribute(file, kBounces);
  int bounces = 0;
  if (!text || std::sscanf(text->c_str(), "%d", &bounces) != 1 || bounces < 0) return std::nullopt;
  return bounces;
}

bool hasParts(const LayeredImage& file) {
  return std::ranges::any_of(kCoverageMembers,
                             [&](const CoverageMember& m) { return file.find(m.name) != nullptr; });
}

/// From how many bounces on light is one sum in a file with parts: of all where an earlier revision traced it.
int bouncesApart(const LayeredImage& file, const Coverage& there, int bounces) {
  if (bounces < 2 || !hasParts(file)) return kBouncesApart;
  for (const LightPath direct : {kEnvironmentDirect, kLocalDirect, kEmitterDirect}) {
    if (covers(there, pathAfter(direct, 1)) && file.find(nameOf(pathAfter(direct, 2)))) return kBouncesApart;
  }
  return 1;
}

/// What is asked of a file's light, and what it has.
struct Asked {
  Coverage part, there;
  int bounces = kMaxBounces;        ///< at most
  int bounces_there = kMaxBounces;  ///< the same where the file does not say
  int apart = kBouncesApart;        ///< light of so many bounces and more is one sum
  Asked(const LayeredImage& file, const Coverage& of, const Coverage& in_file, int most)
      : part(of), there(in_file) {
    if (most >= 0) bounces = most;
    bounces_there = bouncesIn(file).value_or(kMaxBounces);
    apart = bouncesApart(file, there, bounces_there);
  }
  bool has(LightPath path) const {
    return covers(there, path) && bouncesOf(path) <= std::min(bounces_there, apart);
  }
  bool takes(LightPath path) const { return covers(part, path) && bouncesOf(path) <= bounces; }
  bool all() const {
    for (int p = 0; p < kLightPathCount; ++p) {
      if (has(LightPath(p)) && !takes(LightPath(p))) return false;
    }
    return !cutsASum();
  }
  bool cutsASum() const { return bounces >= apart && bounces < bounces_there; }
};

/// Direct or indirect light of a part: the file's own layer where it is all of that, 0 where it is nothing, else the sum of
/// the parts' layers.
Image lightOfPart(const LayeredImage& file, const Asked& asked, bool direct, const std::string& place) {
  bool all = true, nothing = !direct;  // what is seen is always direct
  for (int p = 0; p < kLightPathCount; ++p) {
    const LightPath path{p};
    if (path == kSeen || isDirect(path) != direct || !asked.has(path)) continue;
    (asked.takes(path) ? nothing : all) = false;
  }
  if (!direct && !nothing && asked.cutsASum()) all = false;
  const std::vector<std::string> rgb{"R", "G", "B"};
  if (all) return file.image(direct ? "direct" : "indirect", rgb, place);
  Image sum(file.width, file.height, 3);
  if (nothing) return sum;
  if (!hasParts(file)) {
    throw Error(place, fmt::format("holds {} in one sum; {} alone is in a file of gloam reference --parts",
                                   coverageText(asked.there), coverageText(both(asked.part, asked.there))));
  }
  if (!direct && asked.cutsASum()) {
    throw Error(
        place,
        fmt::format("holds light of {} bounces and more in one sum; that of at most {}, of {}, was asked for",
                    asked.apart, asked.bounces, asked.bounces_there));
  }
  for (int p = 0; p < kLightPathCount; ++p) {
    const LightPath path{p};
    if (isDirect(path) != direct || !asked.takes(path) || !asked.has(path)) continue;
    const Image layer = file.image(nameOf(path), rgb, place);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layer.pixels[i];
  }
  return sum;
}

}  // namespace

Coverage coverageOf(const LayeredImage& file, const std::string& place) {
  const std::string* kind = attribute(file, "gloam.kind");
  const std::string* light = attribute(file, kLight);
  if (!kind || *kind != "reference" || !light) {
    throw Error(place,
                "is no picture by gloam reference: its attributes gloam.kind and gloam.light are missing");
  }
  return parseCoverage(*light, place + ": attribute gloam.light");
}

LayeredImage imageOf(const LayeredImage& file, const Coverage& part, const std::string& place, int bounces) {
  const Coverage whole = coverageOf(file, place);
  if (!isPartOf(part, whole)) {
    throw Error(place, fmt::format("holds {}; {} was asked for", coverageText(whole), coverageText(part)));
  }
  const Coverage there = sourcesOf(file, whole, place);
  const Asked asked(file, part, there, bounces);
  const Image direct = lightOfPart(file, asked, true, place);
  const Image indirect = lightOfPart(file, asked, false, place);
  Image sum = file.image("", {"R", "G", "B", "A"}, place);
  if (!asked.all()) {
    for (std::size_t i = 0; i < sum.pixelCount(); ++i) {
      for (std::size_t c = 0; c < 3; ++c)
        sum.pixels[4 * i + c] = direct.pixels[3 * i + c] + indirect.pixels[3 * i + c];
    }
  }
  LayeredImage result;
  result.width = file.width;
  result.height = file.height;
  result.add("", {"R", "G", "B", "A"}, sum, ChannelType::kFloat);
  result.add("direct", {"R", "G", "B"}, direct, ChannelType::kFloat);
  result.add("indirect", {"R", "G", "B"}, indirect, ChannelType::kFloat);
  for (const char* name : {"normal", "depth", "albedo", "object"}) {
    if (const Layer* layer = file.find(name)) result.layers.push_back(*layer);
  }
  result.attributes = file.attributes;
  result.attributes[kLight] = coverageText(part);
  result.attributes[kSources] = coverageText(both(part, there));
  result.attributes[kBounces] = std::to_string(std::min(asked.bounces, asked.bounces_there));
  result.attributes.erase("gloam.noise");
  result.attributes.erase(kVariance);
  result.attributes.erase(kPartVariance);
  return result;
}

std::optional<double> varianceOf(const LayeredImage& file, const Coverage& part, const std::string& place,
                                 int bounces) {
  const std::string *text = attribute(file, kPartVariance), *of_all = attribute(file, kVariance);
  const auto damaged = [&](const std::string& what) {
    return Error(place, fmt::format("attribute {}: {}", text ? kPartVariance : kVariance, what));
  };
  const Asked asked(file, part, text ? kAllLight : sourcesOf(file, coverageOf(file, place), place), bounces);
  if (!text) {
    if (!of_all || !asked.all()) return std::nullopt;
    double value = 0.0;
    if (!(std::istringstream(*of_all) >> value) || !(value >= 0.0) || std::isinf(value))
      throw damaged(fmt::format("'{}'; expected a positive number", *of_all));
    return value;
  }
  if (asked.cutsASum()) return std::nullopt;
  if (text->empty()) throw damaged("is empty");
  std::istringstream words(*text);
  std::vector<bool> taken;  // of the paths so far
  double variance = 0.0;
  for (std::string name; words >> name;) {
    int path = 0;
    while (path < kLightPathCount && name != nameOf(LightPath(path))) ++path;
    if (path == kLightPathCount) throw damaged(fmt::format("'{}' is no kind of light", name));
    if (taken.size() == kLightPathCount) throw damaged("more than all kinds of light");
    taken.push_back(asked.takes(LightPath(path)));
    for (std::size_t other = 0; other < taken.size(); ++other) {
      double value = 0.0;
      if (!(words >> value) || !std::isfinite(value))
        throw damaged(fmt::format("a number is missing after {}", name));
      if (other + 1 == taken.size() && value < 0.0)
        throw damaged(fmt::format("{} of {}; expected a variance of 0 or more", value, name));
      if (taken[other] && taken.back()) variance += (other + 1 < taken.size() ? 2.0 : 1.0) * value;
    }
  }
  return std::max(variance, 0.0);
}

}  // namespace gloam
