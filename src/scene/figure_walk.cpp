// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A gait from footprints: each foot stands still on its print for 62 % of its cycle, rolls over the heel as it lands and
// over the ball as it leaves, and swings to the next print. Legs follow by two-bone inverse kinematics (law of cosines);
// pelvis, spine and arms by small harmonic motions of the cycle.
#include <algorithm>
#include <cmath>

#include "scene/figure.h"
#include "scene/turns.h"

namespace gloam::figure {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kStance = 0.62f;          // share of a foot's cycle on the ground
constexpr float kLandPitch_rad = -0.3f;   // toes up
constexpr float kLeavePitch_rad = 0.72f;  // heel up
constexpr float kTrack_m = 0.075f;        // of each foot from the line of the walk
constexpr float kPelvisDrop_m = 0.035f;   // knees are never quite straight

glm::vec3 rest(Joint joint) {
  return joints()[joint].position;
}
float ease(float t) {
  return t * t * (3.0f - 2.0f * t);
}

struct Path {
  const Walk& walk;
  float angle(float time_s) const { return 2 * kPi * time_s / walk.seconds; }
  float heading(float time_s) const { return angle(time_s) + 0.5f * kPi; }
  glm::vec3 at(float time_s, float toward_left) const {
    const float r = walk.radius - toward_left, a = angle(time_s);  // the centre lies to the left
    return {r * std::sin(a), 0.0f, r * std::cos(a)};
  }
};

struct Foot {
  glm::vec3 ankle;
  glm::quat rotation;
};

/// Where the ankle is when the foot, standing on its print, is pitched about the heel (toes up) or the ball (heel up).
glm::vec3 pitchedAnkle(float pitch_rad) {
  const glm::vec3 ankle(0, rest(kFootLeft).y, 0);
  const glm::vec3 pivot(0, 0, pitch_rad < 0.0f ? -0.055f : 0.12f);
  return pivot + aboutX(pitch_rad) * (ankle - pivot);
}

/// `side` is +1 for the left foot, which lands on even steps. `landing_s`: when the body passes over print 0.
Foot footAt(const Path& path, float time_s, float side) {
  const float step_s = path.walk.seconds / float(path.walk.steps), cycle_s = 2.0f * step_s;
  const float over_s = side > 0.0f ? 0.0f : step_s;
  // Phase 0 where the foot lands, half its stance before the body is over it.
  const float cycles = (time_s - over_s) / cycle_s + 0.5f * kStance;
  const float print = std::floor(cycles), phase = cycles - print;
  const auto standing = [&](float number, float pitch_rad) {
    const float t = over_s + number * cycle_s;
    const glm::quat yaw = aboutY(path.heading(t));
    return Foot{path.at(t, side * kTrack_m) + yaw * pitchedAnkle(pitch_rad), yaw * aboutX(pitch_rad)};
  };
  if (phase < kStance) {
    const float s = phase / kStance;
    float pitch = 0.0f;
    if (s < 0.14f) pitch = kLandPitch_rad * (1.0f - ease(s / 0.14f));
    if (s > 0.58f) pitch = kLeavePitch_rad * std::pow((s - 0.58f) / 0.42f, 1.6f);
    return standing(print, pitch);
  }
  const float s = (phase - kStance) / (1.0f - kStance);
  const Foot from = standing(print, kLeavePitch_rad), to = standing(print + 1.0f, kLandPitch_rad);
  const float along = ease(s);
  const glm::vec3 lift(0, 0.055f * std::sin(kPi * s), 0);
  const glm::quat over = glm::slerp(from.rotation, to.rotation, ease(std::min(1.0f, 1.15f * s)));
  return {glm::mix(from.ankle, to.ankle, along) + lift, over};
}

/// Rotation that brings the rest direction to `along` and the rest +Z as near as may be to `front`.
glm::quat aim(const glm::vec3& rest_along, const glm::vec3& along, const glm::vec3& front) {
  const auto frame = [](const glm::vec3& a, const glm::vec3& f) {
    const glm::vec3 y = glm::normalize(a), x = glm::normalize(glm::cross(y, f));
    return glm::mat3(x, y, glm::cross(x, y));
  };
  return glm::normalize(glm::quat_cast(frame(along, front) * glm::transpose(frame(rest_along, {0, 0, 1}))));
}

/// Sets thigh, shin and foot; `world` holds the rotations of joints in the world.
void placeLeg(Joint thigh, const Foot& foot, const glm::vec3& hip, const glm::quat& pelvis,
              const glm::vec3& knee_front, Posture& posture) {
  const Joint shin = Joint(thigh + 1), ankle = Joint(thigh + 2);
  const glm::vec3 rest_thigh = rest(shin) - rest(thigh), rest_shin = rest(ankle) - rest(shin);
  const float a = glm::length(rest_thigh), b = glm::length(rest_shin);
  const glm::vec3 reach = foot.ankle - hip;
  const float c = std::clamp(glm::length(reach), 0.2f, 0.9995f * (a + b));
  const glm::vec3 down = glm::normalize(reach);
  const glm::vec3 front = glm::normalize(knee_front - down * glm::dot(down, knee_front));
  const float cosine = (a * a + c * c - b * b) / (2.0f * a * c);
  const float bend = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const glm::vec3 knee = a * (down * std::cos(bend) + front * std::sin(bend));
  const glm::quat thigh_world = aim(rest_thigh, knee, front),
                  shin_world = aim(rest_shin, down * c - knee, front);
  posture.rotation[thigh] = glm::inverse(pelvis) * thigh_world;
  posture.rotation[shin] = glm::inverse(thigh_world) * shin_world;
  posture.rotation[ankle] = glm::inverse(shin_world) * foot.rotation;
}

}  // namespace

Posture walking(const Walk& walk, float time_s) {
  const Path path{walk};
  Posture posture;
  posture.rotation.fill(glm::quat(1, 0, 0, 0));
  const float step_s = walk.seconds / float(walk.steps);
  const float beat =
      kPi * time_s / step_s;  // a cycle of both feet is 2 pi; 0 as the body passes over the left foot
  const glm::quat heading = aboutY(path.heading(time_s));

  // Highest over the standing foot, towards which it sways; the hip of the leg that swings forward leads.
  const float twist = 0.1f * std::sin(beat), sway = 0.018f * std::cos(beat);
  posture.pelvis = path.at(time_s, sway);
  posture.pelvis.y = rest(kPelvis).y - kPelvisDrop_m + 0.016f * std::cos(2.0f * beat);
  const glm::quat pelvis = heading * aboutY(twist) * aboutZ(0.03f * std::cos(beat)) * aboutX(0.04f);
  posture.rotation[kPelvis] = pelvis;
  posture.rotation[kSpine] = aboutY(-0.9f * twist) * aboutZ(-0.03f * std::cos(beat));
  posture.rotation[kChest] = aboutY(-1.1f * twist);
  posture.rotation[kNeck] = aboutY(0.6f * twist) * aboutX(0.02f);
  posture.rotation[kHead] = aboutY(0.4f * twist) * aboutX(-0.06f);

  for (const float side : {1.0f, -1.0f}) {
    const Joint thigh = side > 0.0f ? kThighLeft : kThighRight;
    const glm::vec3 hip = posture.pelvis + pelvis * (rest(thigh) - rest(kPelvis));
    const glm::vec3 front = heading * glm::vec3(0.06f * side, 0, 1);
    placeLeg(thigh, footAt(path, time_s, side), hip, pelvis, front, posture);

    // Arms hang from their spread rest, and swing against the leg of their side.
    const Joint arm = side > 0.0f ? kUpperArmLeft : kUpperArmRight;
    const float swing = 0.42f * side * std::sin(beat) - 0.04f;
    posture.rotation[arm] = aboutX(swing) * aboutZ(-0.52f * side);
    posture.rotation[arm + 1] = aboutX(-0.3f + 0.55f * std::min(0.0f, swing));
    posture.rotation[arm + 2] = aboutX(-0.08f);
  }
  return posture;
}

}  // namespace gloam::figure
