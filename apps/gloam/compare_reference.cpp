// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_reference.h"

#include <fmt/core.h>
#include <scene/coverage.h>
#include <scene/drawn_fingerprint.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "surface_mask.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

/// What a reference that was made here is known by: the path tracer's own attributes say what is in it, not of which scene.
constexpr const char* kInputs = "gloam.compare.inputs";
const std::vector<std::string> kRgb = {"R", "G", "B"};

std::string textOf(const LayeredImage& image, const char* name) {
  const auto found = image.attributes.find(name);
  return found == image.attributes.end() ? "" : found->second;
}

/// Nothing where it is not there; throws Error where it is anything but a number from `least` to `most`.
template <class Number>
std::optional<Number> attribute(const LayeredImage& image, const fs::path& file, const char* name,
                                Number least, Number most) {
  const auto found = image.attributes.find(name);
  if (found == image.attributes.end()) return std::nullopt;
  Number value{};
  const std::string& text = found->second;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !(value >= least && value <= most)) {
    throw Error(file.string(), fmt::format("attribute {} is '{}'; expected a number from {} to {}", name,
                                           text, least, most));
  }
  return value;
}

std::string versionText(const std::string& version, const std::string& revision) {
  return version.empty() ? ""
                         : fmt::format("gloam {}, tracer {}", version, revision.empty() ? "1" : revision);
}

ReferencePicture pictureOf(LayeredImage layers, const fs::path& file) {
  ReferencePicture picture;
  picture.file = file;
  const auto whole = [&](const char* name, int least, int most) {
    return attribute<int>(layers, file, name, least, most);
  };
  picture.version = versionText(textOf(layers, "gloam.version"), textOf(layers, "gloam.revision"));
  picture.samples = whole("gloam.samples", 0, 1 << 24);
  picture.noise = attribute<double>(layers, file, "gloam.noise", 0.0, double(INFINITY));
  picture.bounces = whole("gloam.bounces", 0, 1000).value_or(1);
  picture.environment_order = whole("gloam.environment_order", 0, 6).value_or(0);
  picture.supersample = whole("gloam.supersample", 1, 4).value_or(1);
  picture.background = whole("gloam.background", 0, 1).value_or(1) != 0;
  picture.layers = std::move(layers);
  return picture;
}

/// Of variance nothing below 0; it is infinite where a pixel has one sample: not known.
void requireFinite(const LayeredImage& image, const fs::path& file) {
  const std::size_t width = std::size_t(image.width);
  for (const Layer& layer : image.layers) {
    const bool variance = layer.name == "variance";
    const auto bad = std::ranges::find_if(
        layer.pixels, [&](float value) { return variance ? !(value >= 0.0f) : !std::isfinite(value); });
    if (bad == layer.pixels.end()) continue;
    const std::size_t at = std::size_t(bad - layer.pixels.begin()), channels = layer.channels.size();
    const std::size_t pixel = at / channels;
    const std::string& channel = layer.channels[at % channels];
    throw Error(file.string(), fmt::format("channel {}{}{} is {} at pixel {}, {}: no reference", layer.name,
                                           layer.name.empty() ? "" : ".", channel,
                                           std::isnan(*bad)   ? "not a number"
                                           : std::isinf(*bad) ? "infinite"
                                                              : "below 0",
                                           pixel % width, pixel / width));
  }
}

/// Numbers of objects tell surfaces from the sky and lamps that are seen from what these light: a file that has what is seen apart
/// must have them too, else such pixels would be measured and make errors look small.
void requireObjects(const LayeredImage& image, const fs::path& file) {
  const Layer* objects = image.find("object");
  if (objects == nullptr ? image.find("seen") != nullptr
                         : objects->ids.size() != std::size_t(image.width) * std::size_t(image.height)) {
    throw Error(file.string(),
                fmt::format("channel object.id {}; expected it as whole numbers (uint), as gloam reference "
                            "writes it: it tells which pixels are measured",
                            objects == nullptr ? "is missing" : "holds no whole numbers"));
  }
}

/// Sums of layers by channel; what is rounded to halves differs by no more.
bool isSum(const Image& whole, const Image& sum) {
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
    const float a = whole.pixels[i], b = sum.pixels[i];
    if (std::abs(a - b) > 4e-3f * std::max(std::abs(a), std::abs(b)) + 1e-4f) return false;
  }
  return true;
}

/// Techniques are held to different layers: those that contradict one another would make one of them look good or bad.
void requireSums(const LayeredImage& image, const fs::path& file) {
  const std::vector<std::string> rgb = {"R", "G", "B"};
  const auto add = [&](Image& sum, const char* layer) {
    const Image part = image.image(layer, rgb, file.string());
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
  };
  const auto require = [&](const char* layer, const Image& sum, const char* of) {
    if (isSum(image.image(layer, rgb, file.string()), sum)) return;
    throw Error(file.string(), fmt::format("{} is not the sum of {}: the file was altered",
                                           *layer ? fmt::format("layer {}", layer) : "R, G, B", of));
  };
  Image light(image.width, image.height, 3), direct = light, indirect = light;
  add(light, "direct");
  add(light, "indirect");
  require("", light, "layers direct and indirect");
  bool parts = false;
  for (const Layer& layer : image.layers) {
    const std::string source = layer.name.substr(0, layer.name.find_first_of("0123456789") - 1);
    const auto member = std::ranges::find_if(kCoverageMembers, [&](const CoverageMember& m) {
      return layer.name == m.name || (source == m.name && layer.name.size() > source.size());
    });
    if (member == std::end(kCoverageMembers)) continue;
    parts = true;
    add(member->direct ? direct : indirect, layer.name.c_str());
  }
  if (!parts) return;
  add(direct, "seen");
  require("direct", direct, "its sources' layers and seen");
  require("indirect", indirect, "its sources' layers");
}

/// What a comparison takes from any reference, and that nobody cut a piece out of it.
void requireWhole(const LayeredImage& image, const fs::path& file) {
  image.image("", {"R", "G", "B", "A"}, file.string());
  for (const char* name : {"direct", "indirect"}) image.image(name, {"R", "G", "B"}, file.string());
  requireObjects(image, file);
  const std::string said = textOf(image, "gloam.size"), is = fmt::format("{}x{}", image.width, image.height);
  if (!said.empty() && said != is) {
    throw Error(
        file.string(),
        fmt::format("is {}, but its attribute gloam.size says {}: expected the whole picture", is, said));
  }
}

std::string inputsOf(const ReferenceScene& scene, const ReferenceOptions& options) {
  Fingerprint print;
  addAll(print, std::string(GLOAM_VERSION), kReferenceRevision, scene.scene, scene.posed, scene.camera,
         scene.environment);
  addAll(print, options.width, options.height, options.supersample, options.bounces,
         options.environment_order, options.background, options.seed);
  return print.text();
}

/// What the same command left behind, where it is good enough; any other file is as good as none.
std::optional<ReferencePicture> readKept(const fs::path& file, const std::string& inputs, int samples,
                                         float noise) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  try {
    ReferencePicture kept = pictureOf(readExr(file), file);
    const auto found = kept.layers.attributes.find(kInputs);
    if (found == kept.layers.attributes.end() || found->second != inputs) return std::nullopt;
    const bool enough = kept.samples.value_or(0) >= samples ||
                        (noise > 0.0f && kept.noise.value_or(INFINITY) <= double(noise));
    if (enough) return kept;
  } catch (const Error&) {
  }
  return std::nullopt;
}

std::string samplesText(const ReferencePicture& picture, const std::string& more) {
  const std::string light =
      picture.environment_order == 0
          ? ""
          : fmt::format("lit by {} bands of spherical harmonics, ", picture.environment_order);
  return fmt::format("{} paths a pixel, {} {}, {}{}", countText(std::size_t(picture.samples.value_or(0))),
                     picture.bounces, picture.bounces == 1 ? "bounce" : "bounces", light, more);
}

/// A checkpoint that cannot be used (of other inputs, damaged) is nobody's but this folder's: it goes.
LayeredImage traceResumed(const ReferenceScene& scene, const ReferenceOptions& options,
                          const ReferenceGoal& goal, const Progress& progress, ReferenceReport& report) {
  const auto trace = [&] {
    return renderReference(scene.scene, scene.posed, scene.camera, scene.environment, options, goal, true,
                           progress, &report);
  };
  std::error_code ignored;
  try {
    try {
      return trace();
    } catch (const Error& error) {
      if (!std::string(error.what()).starts_with(goal.checkpoint.string())) throw;
      if (!fs::remove(goal.checkpoint, ignored)) throw;
      return trace();
    }
  } catch (const Interrupted&) {
    throw Interrupted(
        fs::exists(goal.checkpoint, ignored)
            ? fmt::format("interrupted while tracing the reference; the same command goes on from {}",
                          goal.checkpoint.string())
            : "interrupted before the reference had begun");
  }
}

}  // namespace

ReferencePicture readReference(const fs::path& file) {
  LayeredImage layers = readExr(file);
  coverageOf(layers, file.string());
  requireWhole(layers, file);
  requireFinite(layers, file);
  requireSums(layers, file);
  ReferencePicture picture = pictureOf(std::move(layers), file);
  picture.text = samplesText(picture, file.string());
  return picture;
}

bool checkReference(const ReferencePicture& reference, const ReferenceScene& scene) {
  const auto& attributes = reference.layers.attributes;
  bool all = true;
  const auto check = [&](const char* name, const Fingerprint& here, const char* what) {
    const auto found = attributes.find(name);
    all &= found != attributes.end();
    if (found == attributes.end() || found->second == here.text()) return;
    throw Error("--reference", fmt::format("{} is a picture {}", reference.file.string(), what));
  };
  check("gloam.scene", drawnFingerprint(scene.scene, scene.posed),
        "of another scene, or of this one at another time; expected the scene that is compared");
  check("gloam.environment_light", drawnFingerprint(scene.environment),
        "under another light; expected the same --env, --env-rotation and --env-intensity");
  check("gloam.camera", drawnFingerprint(scene.camera),
        "from another camera; expected the view that is compared");
  if (const Layer* objects = reference.layers.find("object")) {
    const auto most = std::ranges::max_element(objects->ids);
    if (most != objects->ids.end() && *most > scene.posed.instances.size())
      throw Error("--reference", fmt::format("{}: channel object.id holds {}; the scene has {} objects",
                                             reference.file.string(), *most, scene.posed.instances.size()));
  }
  return all;
}

ReferencePicture traceReference(const ReferenceScene& scene, const ReferenceOptions& options, int samples,
                                float noise, const fs::path& file, const Progress& progress,
                                Console& console) {
  const std::string inputs = inputsOf(scene, options);
  if (std::optional<ReferencePicture> kept = readKept(file, inputs, samples, noise)) {
    kept->text = samplesText(*kept, file.filename().string());
    console.remark(fmt::format("the reference is taken from {} ({} paths a pixel)", file.string(),
                               countText(std::size_t(kept->samples.value_or(0)))));
    return *std::move(kept);
  }
  ReferenceReport report;
  ReferenceGoal goal{samples, noise, fs::path(file).replace_extension(".checkpoint")};
  LayeredImage layers = traceResumed(scene, options, goal, progress, report);
  layers.attributes[kInputs] = inputs;
  writeExr(layers, file);
  ReferencePicture picture = pictureOf(std::move(layers), file);
  picture.text = samplesText(
      picture, fmt::format("{}, traced in {}{}", file.filename().string(), durationText(report.seconds),
                           report.resumed ? " after it was taken up again" : ""));
  return picture;
}

LayeredImage lightForPart(const ReferencePicture& reference, const Coverage& part, int bounces,
                          const std::vector<bool>& glowing) {
  const LayeredImage all = imageOf(reference.layers, part, reference.file.string(), bounces);
  LayeredImage light;
  light.width = all.width, light.height = all.height;
  light.attributes = all.attributes;
  light.attributes.erase(kInputs);
  for (const char* name : {"", "direct", "indirect"}) {
    const Layer* layer = all.find(name);
    if (layer == nullptr) throw Error(reference.file.string(), fmt::format("layer '{}' is missing", name));
    light.layers.push_back(*layer);
    light.layers.back().type = ChannelType::kHalf;
  }
  const Layer *objects = reference.layers.find("object"), *seen = reference.layers.find("seen");
  if (reference.background && objects != nullptr) light.layers.push_back(*objects);
  if (seen == nullptr || objects == nullptr) return light;
  Layer shining = *seen;  // without the sky, which shows through edges
  bool any = false;
  for (std::size_t i = 0; i < objects->ids.size(); ++i) {
    const std::size_t id = objects->ids[i];
    const bool glows = id > 0 && id <= glowing.size() && glowing[id - 1];
    for (std::size_t c = 0; c < 3; ++c) {
      if (!glows) shining.pixels[3 * i + c] = 0.0f;
      any |= shining.pixels[3 * i + c] > 0.0f;
    }
  }
  if (any) light.layers.push_back(std::move(shining));
  return light;
}

bool tellsBounces(const ReferencePicture& reference, const Coverage& part, int bounces) {
  try {
    imageOf(reference.layers, part, reference.file.string(), bounces);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::optional<double> relativeNoise(const ReferencePicture& reference, const Coverage& part, int bounces,
                                    const Image& light, const Image& mask) {
  const std::optional<double> variance = varianceOf(reference.layers, part, reference.file.string(), bounces);
  return variance ? relativeNoise(*variance, light, mask) : std::nullopt;
}

std::optional<double> relativeNoise(const ReferencePicture& reference, const std::vector<bool>& glowing) {
  const std::string place = reference.file.string();
  const Coverage all = coverageOf(reference.layers, place);
  const LayeredImage light = lightForPart(reference, all, -1, glowing);
  return relativeNoise(reference, all, -1, light.image("", kRgb, place), surfaceMask(light, place));
}

std::string tracerVersion() {
  return versionText(GLOAM_VERSION, std::to_string(kReferenceRevision));
}

}  // namespace gloam::cli
