// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums become pictures: means of samples, by path, and what the file says of itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/reference_file.h"

namespace gloam::reference {
namespace {

/// Calls visit(pixel, samples) for each pixel, in order.
template <class Visit>
void forPixels(const PathSums& sums, const Visit& visit) {
  std::size_t pixel = 0;
  for (int y = 0; y < sums.height; ++y) {
    for (int x = 0; x < sums.width; ++x, ++pixel) visit(pixel, sums.samples[sums.tileOf(x, y)]);
  }
}

/// Means of the light of all paths that `takes` names, R, G, B in a picture of that many channels.
template <class Takes>
Image meanLight(const PathSums& sums, int channels, const Takes& takes) {
  Image image(sums.width, sums.height, channels);
  const std::size_t paths = sums.paths.size();
  forPixels(sums, [&](std::size_t pixel, std::uint32_t samples) {
    glm::dvec3 light(0.0);
    for (std::size_t p = 0; p < paths; ++p) {
      if (!takes(sums.paths[p])) continue;
      const double* sum = &sums.sums[(pixel * paths + p) * 3];
      light += glm::dvec3(sum[0], sum[1], sum[2]);
    }
    light /= double(std::max(samples, 1u));
    for (int c = 0; c < 3; ++c)
      image.pixels[pixel * std::size_t(channels) + std::size_t(c)] = float(light[c]);
  });
  return image;
}

Image varianceImage(const PathSums& sums) {
  Image image(sums.width, sums.height, 3);
  const double even = evenness(sums);
  forPixels(sums, [&](std::size_t pixel, std::uint32_t samples) {
    const glm::dvec3 variance = even * independentVariance(sums, pixel, samples);
    for (int c = 0; c < 3; ++c) image.pixels[3 * pixel + std::size_t(c)] = float(variance[c]);
  });
  return image;
}

std::map<std::string, std::string> attributesOf(const TracerState& state, const Coverage& part) {
  const ReferenceOptions& options = state.options;
  std::string sources;
  for (const LightPath path : state.sums.paths) {
    if (path >= kSeen || !covers(part, path)) continue;
    if (!sources.empty()) sources += ' ';
    sources += nameOf(path);
  }
  return {{"gloam.kind", "reference"},
          {"gloam.version", GLOAM_VERSION},
          {"gloam.revision", std::to_string(kReferenceRevision)},
          {"gloam.size", fmt::format("{}x{}", state.sums.width, state.sums.height)},
          {"gloam.light", coverageText(part)},
          {"gloam.sources", sources.empty() ? "none" : sources},
          {"gloam.bounces", std::to_string(options.bounces)},
          {"gloam.samples", std::to_string(state.sums.least())},
          {"gloam.supersample", std::to_string(options.supersample)},
          {"gloam.environment_order", std::to_string(options.environment_order)},
          {"gloam.background", options.background ? "1" : "0"},
          {"gloam.seed", std::to_string(options.seed)},
          {"gloam.scene", state.scene},
          {"gloam.environment_light", state.environment_light},
          {"gloam.camera", state.camera}};
}

/// A row a path: its name, its covariances with those before it, its variance.
std::string varianceText(const PathSums& sums) {
  const std::vector<std::vector<double>> covariances = partCovariances(sums);
  std::string text;
  for (std::size_t a = 0; a < covariances.size(); ++a) {
    if (a > 0) text += ' ';
    text += nameOf(sums.paths[a]);
    for (std::size_t b = 0; b <= a; ++b) text += fmt::format(" {:.6g}", covariances[a][b]);
  }
  return text;
}

}  // namespace

LayeredImage pictureOf(const TracerState& state, const Coverage& part, bool variance, bool parts) {
  if (!isPartOf(part, state.options.light)) {
    throw Error("reference", fmt::format("follows {}; {} was asked for", coverageText(state.options.light),
                                         coverageText(part)));
  }
  const PathSums& sums = state.sums;
  const std::vector<std::string> rgb{"R", "G", "B"};
  LayeredImage result;
  result.width = sums.width;
  result.height = sums.height;
  Image sum = meanLight(sums, 4, [&](LightPath path) { return covers(part, path); });
  for (std::size_t i = 0; i < sum.pixelCount(); ++i) sum.pixels[4 * i + 3] = state.alpha.pixels[i];
  result.add("", {"R", "G", "B", "A"}, sum, ChannelType::kFloat);
  for (const bool direct : {true, false}) {
    const auto takes = [&](LightPath path) { return covers(part, path) && isDirect(path) == direct; };
    result.add(direct ? "direct" : "indirect", rgb, meanLight(sums, 3, takes), ChannelType::kFloat);
  }
  for (const Layer& layer : state.geometry.layers) result.layers.push_back(layer);
  if (variance) result.add("variance", rgb, varianceImage(sums), ChannelType::kFloat);
  for (int p = 0; p < kLightPathCount; ++p) {
    const LightPath path{p};
    if (!parts && (path != kSeen || !variance)) continue;
    const bool there = path == kSeen || std::ranges::find(sums.paths, path) != sums.paths.end();
    if (!there || !covers(part, path)) continue;
    const auto takes = [&](LightPath other) { return other == path; };
    result.add(nameOf(path), rgb, meanLight(sums, 3, takes), ChannelType::kFloat);
  }
  result.attributes = attributesOf(state, part);
  if (variance) result.attributes["gloam.noise"] = fmt::format("{:.6g}", noiseOf(sums));
  if (const double of_all = meanVariance(sums); variance && std::isfinite(of_all))
    result.attributes[kVariance] = fmt::format("{:.6g}", of_all);
  const std::string covariances = variance && parts ? varianceText(sums) : "";
  if (!covariances.empty()) result.attributes[kPartVariance] = covariances;
  return result;
}

}  // namespace gloam::reference
