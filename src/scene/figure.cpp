// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The body is the smooth union of tapered capsules about the bones; a vertex follows the bones whose capsules are nearest.
#include "scene/figure.h"

#include <algorithm>
#include <cmath>

#include "scene/implicit_surface.h"
#include "scene/soft_parts.h"

namespace gloam::figure {
namespace {

constexpr float kTorsoBlend_m = 0.14f;  // how far parts melt into each other
constexpr float kBlend_m = 0.045f;
constexpr float kSoften_m = 0.032f;  // how far influence reaches over a joint

struct Part {
  Joint joint;
  glm::vec3 a, b;
  float radius_a, radius_b;
};

glm::vec3 mirrored(const glm::vec3& p) {
  return {-p.x, p.y, p.z};
}

Joint otherSide(Joint joint) {
  if (joint >= kUpperArmLeft && joint <= kHandLeft) return Joint(joint + 3);
  if (joint >= kThighLeft && joint <= kFootLeft) return Joint(joint + 3);
  return joint;
}

std::vector<Part> parts() {
  const auto at = [](Joint joint) { return joints()[joint].position; };
  std::vector<Part> all = {
      {kPelvis, {-0.062f, 0.95f, -0.008f}, {0.062f, 0.95f, -0.008f}, 0.1f, 0.1f},
      {kSpine, {-0.036f, 1.11f, 0.0f}, {0.036f, 1.11f, 0.0f}, 0.08f, 0.08f},
      {kChest, {-0.072f, 1.28f, 0.0f}, {0.072f, 1.28f, 0.0f}, 0.098f, 0.098f},
      {kChest, {-0.135f, 1.395f, -0.012f}, {0.135f, 1.395f, -0.012f}, 0.05f, 0.05f},
      {kNeck, {0.0f, 1.42f, -0.005f}, {0.0f, 1.54f, 0.005f}, 0.05f, 0.046f},
      {kHead, {0.0f, 1.575f, 0.022f}, {0.0f, 1.635f, 0.008f}, 0.068f, 0.088f},
  };
  const glm::vec3 hand_tip = at(kHandLeft) + 0.13f * glm::normalize(at(kHandLeft) - at(kForearmLeft));
  const std::vector<Part> left = {
      {kUpperArmLeft, at(kUpperArmLeft), at(kForearmLeft), 0.05f, 0.039f},
      {kForearmLeft, at(kForearmLeft), at(kHandLeft), 0.04f, 0.027f},
      {kHandLeft, at(kHandLeft), hand_tip, 0.03f, 0.024f},
      {kThighLeft, at(kThighLeft) + glm::vec3(0, 0.01f, 0), at(kShinLeft), 0.083f, 0.05f},
      {kShinLeft, at(kShinLeft), at(kShinLeft) + glm::vec3(0.002f, -0.14f, -0.016f), 0.049f, 0.05f},
      {kShinLeft, at(kShinLeft) + glm::vec3(0.002f, -0.14f, -0.014f), at(kFootLeft), 0.048f, 0.034f},
      {kFootLeft, at(kFootLeft) + glm::vec3(0, -0.045f, -0.03f),
       at(kFootLeft) + glm::vec3(0.01f, -0.052f, 0.13f), 0.04f, 0.033f},
  };
  for (const Part& part : left) {
    all.push_back(part);
    all.push_back({otherSide(part.joint), mirrored(part.a), mirrored(part.b), part.radius_a, part.radius_b});
  }
  return all;
}

float distanceTo(const Part& part, const glm::vec3& p) {
  return gloam::distanceTo(TaperedCapsule{part.a, part.b, part.radius_a, part.radius_b}, p);
}

/// The four joints that a point follows most, weights summing to 1.
void addInfluences(Mesh& mesh, const std::vector<Part>& all, const glm::vec3& p) {
  std::array<float, kJoints> nearest;
  nearest.fill(1e9f);
  for (const Part& part : all) nearest[part.joint] = std::min(nearest[part.joint], distanceTo(part, p));
  const float least = *std::min_element(nearest.begin(), nearest.end());
  std::array<std::pair<float, std::uint16_t>, kJoints> weight;
  for (std::size_t j = 0; j < kJoints; ++j) {
    const float beyond = (nearest[j] - least) / kSoften_m;
    weight[j] = {std::exp(-beyond * beyond), std::uint16_t(j)};
  }
  std::partial_sort(weight.begin(), weight.begin() + 4, weight.end(), std::greater<>());
  const float floor = 0.01f;  // what is left of the fifth must not matter
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) sum += std::max(0.0f, weight[std::size_t(k)].first - floor);
  for (int k = 0; k < 4; ++k) {
    const float w = std::max(0.0f, weight[std::size_t(k)].first - floor) / sum;
    mesh.joints.push_back(w > 0.0f ? weight[std::size_t(k)].second : std::uint16_t(0));
    mesh.weights.push_back(w);
  }
}

}  // namespace

const std::array<JointInfo, kJoints>& joints() {
  static const std::array<JointInfo, kJoints> all = {{
      {"pelvis", kNone, {0, 0.95f, 0}},
      {"spine", kPelvis, {0, 1.03f, 0}},
      {"chest", kSpine, {0, 1.18f, 0}},
      {"neck", kChest, {0, 1.455f, -0.005f}},
      {"head", kNeck, {0, 1.545f, 0.005f}},
      {"upper arm left", kChest, {0.168f, 1.4f, -0.01f}},
      {"forearm left", kUpperArmLeft, {0.34f, 1.185f, -0.02f}},
      {"hand left", kForearmLeft, {0.495f, 0.985f, 0.0f}},
      {"upper arm right", kChest, {-0.168f, 1.4f, -0.01f}},
      {"forearm right", kUpperArmRight, {-0.34f, 1.185f, -0.02f}},
      {"hand right", kForearmRight, {-0.495f, 0.985f, 0.0f}},
      {"thigh left", kPelvis, {0.09f, 0.915f, 0.0f}},
      {"shin left", kThighLeft, {0.096f, 0.5f, 0.012f}},
      {"foot left", kShinLeft, {0.1f, 0.085f, -0.012f}},
      {"thigh right", kPelvis, {-0.09f, 0.915f, 0.0f}},
      {"shin right", kThighRight, {-0.096f, 0.5f, 0.012f}},
      {"foot right", kShinRight, {-0.1f, 0.085f, -0.012f}},
  }};
  return all;
}

Mesh body(float cell) {
  const std::vector<Part> all = parts();
  const auto distance = [&](const glm::vec3& p) {
    float torso = 1e9f;
    for (const Part& part : all) {
      if (part.joint <= kChest) torso = smoothMinimum(torso, distanceTo(part, p), kTorsoBlend_m);
    }
    float d = torso;
    for (const Part& part : all) {
      if (part.joint > kChest) d = smoothMinimum(d, distanceTo(part, p), kBlend_m);
    }
    return d;
  };
  Mesh mesh = meshOfSurface(distance, {-0.68f, -0.05f, -0.24f}, {0.68f, 1.79f, 0.28f}, cell);
  mesh.influences = 4;
  for (const glm::vec3& p : mesh.positions) addInfluences(mesh, all, p);
  return mesh;
}

}  // namespace gloam::figure
