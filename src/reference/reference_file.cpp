// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/reference_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scene/coverage.h"

namespace gloam {

namespace reference {

static_assert(std::size(kCoverageMembers) == kSeen);

const char* nameOf(LightPath path) {
  return path == kSeen ? "seen" : kCoverageMembers[path].name;
}

bool isDirect(LightPath path) {
  return path == kSeen || kCoverageMembers[path].direct;
}

bool covers(const Coverage& light, LightPath path) {
  return path == kSeen || light.*kCoverageMembers[path].member;
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

/// Direct or indirect light of a part: the file's own layer where it is all of that, 0 where it is nothing, else the sum of
/// the parts' layers.
Image lightOfPart(const LayeredImage& file, const Coverage& part, const Coverage& there, bool direct,
                  const std::string& place) {
  bool all = true, nothing = !direct;  // what is seen is always direct
  for (int p = 0; p < kSeen; ++p) {
    if (isDirect(LightPath(p)) != direct || !covers(there, LightPath(p))) continue;
    (covers(part, LightPath(p)) ? nothing : all) = false;
  }
  const std::vector<std::string> rgb{"R", "G", "B"};
  if (all) return file.image(direct ? "direct" : "indirect", rgb, place);
  Image sum(file.width, file.height, 3);
  if (nothing) return sum;
  if (!file.find(nameOf(kSeen))) {
    throw Error(place, fmt::format("holds {} in one sum; {} alone is in a file of gloam reference --parts",
                                   coverageText(there), coverageText(both(part, there))));
  }
  for (int p = 0; p < kLightPathCount; ++p) {
    const LightPath path{p};
    if (isDirect(path) != direct || !covers(part, path) || !covers(there, path)) continue;
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

LayeredImage imageOf(const LayeredImage& file, const Coverage& part, const std::string& place) {
  const Coverage whole = coverageOf(file, place);
  if (!isPartOf(part, whole)) {
    throw Error(place, fmt::format("holds {}; {} was asked for", coverageText(whole), coverageText(part)));
  }
  const Coverage there = sourcesOf(file, whole, place);
  const Image direct = lightOfPart(file, part, there, true, place);
  const Image indirect = lightOfPart(file, part, there, false, place);
  Image sum = file.image("", {"R", "G", "B", "A"}, place);
  if (both(part, there) != there) {
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
  result.attributes.erase("gloam.noise");
  result.attributes.erase(kPartVariance);
  return result;
}

std::optional<double> varianceOf(const LayeredImage& file, const Coverage& part, const std::string& place) {
  const std::string* text = attribute(file, kPartVariance);
  if (!text) return std::nullopt;
  const auto damaged = [&](const std::string& what) {
    return Error(place, fmt::format("attribute {}: {}", kPartVariance, what));
  };
  std::istringstream words(*text);
  std::vector<bool> taken;  // of the paths so far
  double variance = 0.0;
  for (std::string name; words >> name;) {
    int path = 0;
    while (path < kLightPathCount && name != nameOf(LightPath(path))) ++path;
    if (path == kLightPathCount) throw damaged(fmt::format("'{}' is no kind of light", name));
    if (taken.size() == kLightPathCount) throw damaged("more than all kinds of light");
    taken.push_back(covers(part, LightPath(path)));
    for (std::size_t other = 0; other < taken.size(); ++other) {
      double value = 0.0;
      if (!(words >> value) || !std::isfinite(value))
        throw damaged(fmt::format("a number is missing after {}", name));
      if (taken[other] && taken.back()) variance += (other + 1 < taken.size() ? 2.0 : 1.0) * value;
    }
  }
  return std::max(variance, 0.0);
}

}  // namespace gloam
