// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <gloam/image.h>
#include <gloam/scene.h>

#include <cmath>
#include <numbers>

#include "console.h"
#include "info.h"

namespace gloam::cli {
namespace {

struct Statistics {
  double minimum = INFINITY, maximum = -INFINITY, sum = 0.0;
  std::size_t finite = 0, non_finite = 0;
  void add(double value) {
    if (!std::isfinite(value)) {
      ++non_finite;
      return;
    }
    minimum = std::min(minimum, value), maximum = std::max(maximum, value), sum += value, ++finite;
  }
  void into(Json& json) const {
    json["minimum"] = minimum, json["maximum"] = maximum;  // null where nothing is finite
    json["mean"] = finite > 0 ? sum / double(finite) : NAN;
    json["non_finite"] = non_finite;
  }
};

Json layerJson(const Layer& layer) {
  static constexpr const char* kTypes[] = {"half", "float", "uint"};
  Json json = {{"name", layer.name}, {"type", kTypes[int(layer.type)]}};
  const std::size_t channels = layer.channels.size();
  Json list = Json::array();
  for (std::size_t c = 0; c < channels; ++c) {
    Statistics statistics;
    for (std::size_t i = c; i < layer.pixels.size(); i += channels) statistics.add(double(layer.pixels[i]));
    for (std::size_t i = c; i < layer.ids.size(); i += channels) statistics.add(double(layer.ids[i]));
    Json channel = {{"name", layer.channels[c]}};
    statistics.into(channel);
    list.push_back(std::move(channel));
  }
  json["channels"] = std::move(list);
  return json;
}

/// What an equirectangular map gives as light: its mean over the sphere, and how far its brightest pixel stands out.
Json lightJson(const float* pixels, int width, int height, int channels) {
  double sum[3] = {}, weight_sum = 0.0, brightest = 0.0;
  for (int y = 0; y < height; ++y) {
    const double weight = std::sin(std::numbers::pi * (y + 0.5) / height);  // solid angle of a row's pixels
    for (int x = 0; x < width; ++x) {
      const float* pixel =
          pixels + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
      double luminance = 0.0;
      for (int c = 0; c < 3; ++c) {
        constexpr double kLuminance[] = {0.2126, 0.7152, 0.0722};
        const double value = double(pixel[channels >= 3 ? c : 0]);
        if (!std::isfinite(value)) continue;
        sum[c] += weight * value, luminance += kLuminance[c] * value;
      }
      weight_sum += weight;
      brightest = std::max(brightest, luminance);
    }
  }
  const double mean[] = {sum[0] / weight_sum, sum[1] / weight_sum, sum[2] / weight_sum};
  return {{"mean_radiance", {mean[0], mean[1], mean[2]}}, {"brightest_luminance", brightest}};
}

bool mayBeEquirectangular(int width, int height) {
  return width == 2 * height;
}

Json pictureJson(const std::string& path, const char* format, int width, int height) {
  std::error_code ignored;
  return {{"kind", "image"},
          {"file", path},
          {"format", format},
          {"size", fmt::format("{}x{}", width, height)},
          {"file_bytes", std::size_t(std::filesystem::file_size(path, ignored))}};
}

}  // namespace

Json describeLayers(const std::string& path) {
  const LayeredImage image = readExr(path);
  Json json = pictureJson(path, "OpenEXR", image.width, image.height);
  Json layers = Json::array();
  for (const Layer& layer : image.layers) layers.push_back(layerJson(layer));
  json["layers"] = std::move(layers);
  if (!image.attributes.empty()) {
    Json attributes = Json::object();
    for (const auto& [name, value] : image.attributes) attributes[singleLine(name)] = singleLine(value);
    json["attributes"] = std::move(attributes);
  }
  const Layer* sum = image.find("");
  if (sum != nullptr && sum->channels.size() >= 3 && mayBeEquirectangular(image.width, image.height)) {
    const Image light = image.image("", {"R", "G", "B"}, path);
    json["as_environment"] = lightJson(light.pixels.data(), light.width, light.height, light.channels);
  }
  return json;
}

Json describePicture(const std::string& path) {
  static const std::vector<std::string> kNames[] = {
      {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  const Image image = readImage(path);
  std::string extension = std::filesystem::path(path).extension().string();
  const bool hdr = extension == ".hdr";
  Json json =
      pictureJson(path, hdr ? "Radiance HDR" : "PNG or JPEG, decoded from sRGB", image.width, image.height);
  const Layer layer{"", kNames[image.channels], ChannelType::kFloat, image.pixels, {}};
  json["layers"] = Json::array({layerJson(layer)});
  if (hdr && mayBeEquirectangular(image.width, image.height)) {
    json["as_environment"] = lightJson(image.pixels.data(), image.width, image.height, image.channels);
  }
  return json;
}

Json describeSky(const std::string& name) {
  const Environment sky = loadEnvironment(name);
  Json json = {{"kind", "sky"}, {"name", sky.name}, {"size", fmt::format("{}x{}", sky.width, sky.height)}};
  json["as_environment"] = lightJson(&sky.radiance.front().x, sky.width, sky.height, 3);
  return json;
}

}  // namespace gloam::cli
