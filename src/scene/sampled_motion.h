// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Motion given by functions of time, as keys that are close enough to be straight between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "scene/scene_builder.h"

namespace gloam {

inline constexpr float kKeysPerSecond = 30.0f;

/// Keys of a node's translation from 0 to `seconds`.
inline void addMotion(SceneBuilder& builder, int node, float seconds,
                      const std::function<glm::vec3(float time_s)>& place) {
  const int keys = int(std::lround(seconds * kKeysPerSecond));
  AnimationChannel& channel =
      builder.channel(node, AnimationChannel::Path::kTranslation, AnimationChannel::Interpolation::kLinear);
  for (int k = 0; k <= keys; ++k) {
    const float t = seconds * float(k) / float(keys);
    addKey(channel, t, place(t));
  }
}

/// Keys of a node's rotation; each differs from the one before by less than half a turn.
inline void addTurning(SceneBuilder& builder, int node, float seconds,
                       const std::function<glm::quat(float time_s)>& turn) {
  const int keys = int(std::lround(seconds * kKeysPerSecond));
  AnimationChannel& channel =
      builder.channel(node, AnimationChannel::Path::kRotation, AnimationChannel::Interpolation::kLinear);
  for (int k = 0; k <= keys; ++k) {
    const float t = seconds * float(k) / float(keys);
    addKey(channel, t, glm::normalize(turn(t)));
  }
}

/// Keys of the weight of a mesh's only morph target.
inline void addMorphing(SceneBuilder& builder, int node, float seconds,
                        const std::function<float(float time_s)>& weight) {
  const int keys = int(std::lround(seconds * kKeysPerSecond));
  AnimationChannel& channel =
      builder.channel(node, AnimationChannel::Path::kWeights, AnimationChannel::Interpolation::kLinear);
  channel.components = 1;
  for (int k = 0; k <= keys; ++k) {
    const float t = seconds * float(k) / float(keys);
    channel.times_s.push_back(t);
    channel.values.push_back(weight(t));
  }
}

/// A curve through points (time, value) that comes to rest at each of them; constant before the first and after the last.
inline float easedThrough(const std::vector<std::pair<float, float>>& points, float time_s) {
  if (time_s <= points.front().first) return points.front().second;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (time_s > points[i].first) continue;
    const float x = (time_s - points[i - 1].first) / (points[i].first - points[i - 1].first);
    return glm::mix(points[i - 1].second, points[i].second, x * x * (3.0f - 2.0f * x));
  }
  return points.back().second;
}

}  // namespace gloam
