// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// glTF 2.0 specification, appendix C (animation sampler interpolation modes).
#include "scene/animation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace gloam {
namespace {

using Interpolation = AnimationChannel::Interpolation;

glm::quat quaternionAt(const float* xyzw) {
  return glm::quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
}

void storeUnit(glm::quat q, std::vector<float>& value) {
  const float length = glm::length(q);
  q = length > 0.0f ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  value = {q.x, q.y, q.z, q.w};
}

// Values of key k; cubic splines store (in-tangent, value, out-tangent).
const float* keyValue(const AnimationChannel& channel, std::size_t key) {
  const bool spline = channel.interpolation == Interpolation::kCubicSpline;
  const std::size_t slot = spline ? 3 * key + 1 : key;
  return channel.values.data() + slot * std::size_t(channel.components);
}

void cubicSpline(const AnimationChannel& channel, std::size_t key, float u, float step_s,
                 std::vector<float>& value) {
  const std::size_t n = std::size_t(channel.components);
  const float* v0 = keyValue(channel, key);
  const float* out0 = v0 + n;
  const float* v1 = keyValue(channel, key + 1);
  const float* in1 = v1 - n;
  const float u2 = u * u, u3 = u2 * u;
  for (std::size_t c = 0; c < n; ++c) {
    value[c] = (2 * u3 - 3 * u2 + 1) * v0[c] + step_s * (u3 - 2 * u2 + u) * out0[c] +
               (3 * u2 - 2 * u3) * v1[c] + step_s * (u3 - u2) * in1[c];
  }
}

bool movesNode(const AnimationChannel& channel) {
  if (channel.path == AnimationChannel::Path::kWeights || channel.times_s.size() < 2) return false;
  if (channel.interpolation == Interpolation::kCubicSpline) return true;  // also between equal keys
  const std::size_t n = std::size_t(channel.components);
  const auto begin = channel.values.begin(), end = channel.values.end();
  return !std::equal(begin + std::ptrdiff_t(n), end, begin);
}

bool showsRigidMesh(const Scene& scene, const Node& node) {
  if (node.skin != kNone) return false;
  return std::ranges::any_of(node.meshes, [&](int mesh) {
    const Mesh& shown = scene.meshes[std::size_t(mesh)];
    return shown.morph_targets.empty() && !shown.indices.empty();
  });
}

}  // namespace

std::vector<const AnimationChannel*> channelsInPlay(const Scene& scene) {
  std::vector<const AnimationChannel*> channels;
  std::set<std::pair<int, AnimationChannel::Path>> taken;
  for (const Animation& animation : scene.animations) {
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.node == kNone || channel.times_s.empty() || channel.components <= 0) continue;
      if (taken.insert({channel.node, channel.path}).second) channels.push_back(&channel);
    }
  }
  return channels;
}

void sampleChannel(const AnimationChannel& channel, float time_s, std::vector<float>& value) {
  const std::size_t n = std::size_t(channel.components);
  const std::vector<float>& times = channel.times_s;
  const bool rotation = channel.path == AnimationChannel::Path::kRotation;
  value.resize(n);

  // The last key that is not after the time; a time before all keys (or not a number) takes the first.
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  const std::size_t key =
      after == times.begin() || std::isnan(time_s) ? 0 : std::size_t(after - times.begin()) - 1;
  const bool between = key + 1 < times.size() && time_s > times[key];
  if (!between || channel.interpolation == Interpolation::kStep) {
    std::copy_n(keyValue(channel, key), n, value.begin());
    if (rotation) storeUnit(quaternionAt(value.data()), value);
    return;
  }
  const float step_s = times[key + 1] - times[key];
  const float u = step_s > 0.0f ? (time_s - times[key]) / step_s : 0.0f;
  if (channel.interpolation == Interpolation::kCubicSpline) {
    cubicSpline(channel, key, u, step_s, value);
    if (rotation) storeUnit(quaternionAt(value.data()), value);
    return;
  }
  const float* v0 = keyValue(channel, key);
  const float* v1 = keyValue(channel, key + 1);
  if (rotation) {
    storeUnit(glm::slerp(glm::normalize(quaternionAt(v0)), glm::normalize(quaternionAt(v1)), u), value);
    return;
  }
  for (std::size_t c = 0; c < n; ++c) value[c] = (1.0f - u) * v0[c] + u * v1[c];
}

bool movesApart(const Scene& scene) {
  std::vector<bool> moved(scene.nodes.size(), false);
  for (const AnimationChannel* channel : channelsInPlay(scene)) {
    if (movesNode(*channel)) moved[std::size_t(channel->node)] = true;
  }
  // Meshes that hang on the same moving node, or on none, keep their places to one another.
  std::set<int> movers;
  std::vector<std::pair<int, int>> open;  // node, the nearest moving node above it
  for (const int root : scene.roots) open.emplace_back(root, kNone);
  while (!open.empty() && movers.size() < 2) {
    auto [index, mover] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[std::size_t(index)];
    if (moved[std::size_t(index)]) mover = index;
    if (showsRigidMesh(scene, node)) movers.insert(mover);
    for (const int child : node.children) open.emplace_back(child, mover);
  }
  return movers.size() > 1;
}

float Scene::duration_s() const {
  float duration = 0.0f;
  for (const AnimationChannel* channel : channelsInPlay(*this)) {
    duration = std::max(duration, channel->times_s.back());
  }
  return duration;
}

}  // namespace gloam
