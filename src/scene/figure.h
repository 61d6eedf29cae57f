// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A lay figure, 1.72 m tall, that faces +Z with arms spread: skeleton, skin, and a walk along a circle.
#pragma once

#include <gloam/scene.h>

#include <array>

namespace gloam::figure {

enum Joint : std::size_t {
  kPelvis,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kUpperArmLeft,
  kForearmLeft,
  kHandLeft,
  kUpperArmRight,
  kForearmRight,
  kHandRight,
  kThighLeft,
  kShinLeft,
  kFootLeft,
  kThighRight,
  kShinRight,
  kFootRight,
  kJoints
};

struct JointInfo {
  const char* name;
  int parent;          ///< kNone for the pelvis
  glm::vec3 position;  ///< at rest, where all rotations are the identity
};
const std::array<JointInfo, kJoints>& joints();

/// The body at rest: one closed mesh with four influences a vertex.
Mesh body(float cell);

/// Rotations of all joints relative to their parents, and where the pelvis stands, at one instant.
struct Posture {
  std::array<glm::quat, kJoints> rotation;
  glm::vec3 pelvis{0.0f};
};

/// A walk, counter-clockwise seen from above, on a circle about the Y axis, on level ground at y = 0. Feet that stand do not
/// slide. A round takes an even number of steps, so that it repeats.
struct Walk {
  float radius = 1.25f;
  float seconds = 8.0f;  ///< a round
  int steps = 12;
};
Posture walking(const Walk& walk, float time_s);

}  // namespace gloam::figure
