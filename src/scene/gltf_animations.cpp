// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Animations (glTF 2.0 specification, section 3.11).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/gltf_parts.h"
#include "scene/transforms.h"

namespace gloam {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

std::optional<Path> pathOf(const std::string& word) {
  if (word == "translation") return Path::kTranslation;
  if (word == "rotation") return Path::kRotation;
  if (word == "scale") return Path::kScale;
  if (word == "weights") return Path::kWeights;
  return std::nullopt;
}

/// Times must grow; exporters repeat keys all the same. Such keys are dropped with their `a_key` values each.
void dropRepeatedKeys(GltfReading& reading, AnimationChannel& channel, std::size_t a_key,
                      const std::string& where) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < channel.times_s.size(); ++i) {
    if (kept > 0 && !(channel.times_s[i] > channel.times_s[kept - 1])) continue;
    channel.times_s[kept] = channel.times_s[i];
    std::copy_n(channel.values.begin() + static_cast<std::ptrdiff_t>(i * a_key), a_key,
                channel.values.begin() + static_cast<std::ptrdiff_t>(kept * a_key));
    ++kept;
  }
  if (kept == channel.times_s.size()) return;
  reading.document.warn(fmt::format("{}: {} keys are not later than the one before and are left out", where,
                                    channel.times_s.size() - kept));
  channel.times_s.resize(kept);
  channel.values.resize(kept * a_key);
}

/// Animated nodes are moved by translation, rotation and scale: a matrix is taken apart.
void takeMatrixApart(GltfReading& reading, std::size_t index) {
  Node& node = reading.scene.nodes[index];
  if (!node.matrix) return;
  const std::optional<Trs> trs = decomposeTrs(*node.matrix);
  if (!trs)
    reading.document.fail(fmt::format("nodes[{}].matrix", index), "an animated node's matrix must not shear");
  node.translation = trs->translation, node.rotation = trs->rotation, node.scale = trs->scale;
  node.matrix.reset();
}

std::optional<AnimationChannel> readChannel(GltfReading& reading, const gloam_tinygltf::Animation& animation,
                                            std::size_t index, const std::string& animation_place) {
  GltfDocument& document = reading.document;
  const gloam_tinygltf::AnimationChannel& source = animation.channels[index];
  const std::string where = fmt::format("{}.channels[{}]", animation_place, index);
  if (static_cast<std::size_t>(source.sampler) >= animation.samplers.size())
    document.fail(where + ".sampler",
                  fmt::format("{}, but there are {} samplers", source.sampler, animation.samplers.size()));
  const std::optional<Path> path = pathOf(source.target_path);
  if (!path || source.target_node < 0) {
    document.warn(where + ": moves something else than a node and is left out");
    return std::nullopt;
  }
  const gloam_tinygltf::AnimationSampler& sampler =
      animation.samplers[static_cast<std::size_t>(source.sampler)];
  const std::string sampler_place = fmt::format("{}.samplers[{}]", animation_place, source.sampler);
  const Node& node = reading.scene.nodes[static_cast<std::size_t>(source.target_node)];

  AnimationChannel channel;
  channel.node = source.target_node;
  channel.path = *path;
  channel.interpolation = sampler.interpolation == "STEP"          ? Interpolation::kStep
                          : sampler.interpolation == "CUBICSPLINE" ? Interpolation::kCubicSpline
                                                                   : Interpolation::kLinear;
  channel.components = *path == Path::kRotation  ? 4
                       : *path == Path::kWeights ? static_cast<int>(node.morph_weights.size())
                                                 : 3;
  if (channel.components == 0) {
    document.warn(where + ": moves morph targets of a node that has none and is left out");
    return std::nullopt;
  }
  channel.times_s = reading.accessors.floats(sampler.input, 1, sampler_place + ".input");
  if (channel.times_s.empty()) document.fail(sampler_place + ".input", "at least one key was expected");
  channel.values = reading.accessors.floats(sampler.output, *path == Path::kWeights ? 1 : channel.components,
                                            sampler_place + ".output");
  const std::size_t a_key = static_cast<std::size_t>(channel.components) *
                            (channel.interpolation == Interpolation::kCubicSpline ? 3 : 1);
  if (channel.values.size() != channel.times_s.size() * a_key)
    document.fail(sampler_place + ".output",
                  fmt::format("{} numbers were expected for {} keys, found {}",
                              channel.times_s.size() * a_key, channel.times_s.size(), channel.values.size()));
  for (const float value : channel.values)
    if (std::abs(value) > 1e12f) document.fail(sampler_place + ".output", "a value lies beyond 1e12");
  dropRepeatedKeys(reading, channel, a_key, sampler_place + ".input");
  takeMatrixApart(reading, static_cast<std::size_t>(channel.node));
  return channel;
}

}  // namespace

void readAnimations(GltfReading& reading) {
  const auto& animations = reading.document.model.animations;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const std::string where = fmt::format("animations[{}]", i);
    reading.step(0.95, "reading animations");
    Animation animation;
    animation.name = animations[i].name.empty() ? where : animations[i].name;
    for (std::size_t c = 0; c < animations[i].channels.size(); ++c)
      if (std::optional<AnimationChannel> channel = readChannel(reading, animations[i], c, where))
        animation.channels.push_back(std::move(*channel));
    if (!animation.channels.empty()) reading.scene.animations.push_back(std::move(animation));
  }
}

}  // namespace gloam
