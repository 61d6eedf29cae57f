// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Toys are put together on a line of rollers, under a lamp that travels along a rail: an arm sets drums on blocks, heads drop
// from a pipe, a ram presses them down. Each round ends where the next begins: a toy takes its neighbour's place.
#include <fmt/core.h>

#include <array>
#include <cmath>

#include "scene/assembly_hall.h"
#include "scene/builtin_shapes.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"
#include "scene/sampled_motion.h"
#include "scene/turns.h"

namespace gloam {
namespace {

using namespace assembly;

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f;
// Heights over the rollers.
constexpr float kDrum_m = 0.285f, kDrumHalf_m = 0.085f, kHead_m = 0.465f, kPressed_m = 0.44f,
                kHeadRadius_m = 0.112f;
constexpr float kGrip_m = 0.13f;  // from the wrist down to what the gripper holds
constexpr float kUpper_m = 0.52f, kFore_m = 0.5f;
constexpr float kGripped_s = 0.5f, kPlaced_s = 2.2f;

/// A cylinder about the Y axis with ten rounded teeth, about the origin.
Mesh drum(const Detail& detail) {
  Mesh mesh = shapes::moved(shapes::cylinder(0.1f, 2 * kDrumHalf_m, 0.02f, detail(70), detail(5)),
                            {0, -kDrumHalf_m, 0});
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    glm::vec3 &p = mesh.positions[i], &n = mesh.normals[i];
    const float angle = std::atan2(p.x, p.z), depth = 0.09f, steep = 2.0f;
    const float tooth = std::tanh(steep * std::cos(10.0f * angle)) / std::tanh(steep);
    const float slope = -10.0f * std::sin(10.0f * angle) * steep *
                        (1.0f - std::pow(tooth * std::tanh(steep), 2.0f)) / std::tanh(steep);
    const float factor = 1.0f + depth * tooth, r = std::hypot(p.x, p.z);
    if (r < 1e-5f) continue;
    const glm::vec3 radial(p.x / r, 0, p.z / r), around(radial.z, 0, -radial.x);
    const float out = glm::dot(n, radial);
    n = glm::normalize(out * (radial - around * (depth * slope / factor)) + glm::vec3(0, n.y * factor, 0));
    p = glm::vec3(p.x * factor, p.y, p.z * factor);
    const glm::vec3 t(mesh.tangents[i]);
    mesh.tangents[i] = glm::vec4(glm::normalize(t - n * glm::dot(n, t)), mesh.tangents[i].w);
  }
  return mesh;
}

/// What toys are made of; each of them is placed more than once.
struct Pieces {
  int block, drum, head;
};

Pieces makePieces(SceneBuilder& builder, const Detail& detail) {
  const int blocks = addPainted(builder, "block paint", [](float u, float v) {
    const float edge = std::min(std::min(u, 1.0f - u), std::min(v, 1.0f - v));
    const glm::vec3 blue(0.05f, 0.22f, 0.58f), white(0.8f, 0.78f, 0.72f);
    const float ring = std::hypot(u - 0.5f, v - 0.5f);
    const float mark = smoothStep(0.3f, 0.28f, ring) * smoothStep(0.15f, 0.17f, ring);
    return glm::mix(blue, white, std::max(mark, smoothStep(0.06f, 0.04f, edge)));
  });
  const int drums = addBelts(builder, "drum paint", {0.8f, 0.76f, 0.64f}, {0.82f, 0.36f, 0.03f}, 1);
  const int heads = addPainted(builder, "head paint", [](float u, float v) {
    // u = 0 and 1 look towards +Z.
    const float side = std::abs(u < 0.5f ? u : u - 1.0f);
    glm::vec3 c(0.8f, 0.58f, 0.4f);
    c = glm::mix(c, {0.02f, 0.02f, 0.02f},
                 smoothStep(0.024f, 0.018f, std::hypot(side - 0.055f, 0.6f * (v - 0.47f))));
    const float smile = std::abs(std::hypot(side, 0.55f * (v - 0.52f)) - 0.06f);
    if (v > 0.55f) c = glm::mix(c, {0.5f, 0.06f, 0.04f}, smoothStep(0.012f, 0.007f, smile));
    return glm::mix(c, {0.66f, 0.05f, 0.035f}, smoothStep(0.36f, 0.345f, v));  // a cap
  });
  return {builder.mesh(
              "block",
              shapes::moved(shapes::roundedBox({0.13f, 0.1f, 0.13f}, 0.03f, detail.cell(0.05f), detail(3)),
                            {0, 0.1f, 0}),
              blocks),
          builder.mesh("drum", drum(detail), drums),
          builder.mesh("head", shapes::uvSphere(kHeadRadius_m, 2 * detail(13), detail(13)), heads)};
}

int placed(SceneBuilder& builder, const std::string& name, int mesh, int parent, const glm::vec3& at) {
  const int node = builder.node(name, parent, at);
  builder.at(node).meshes = {mesh};
  return node;
}

float along(float from, float to, float t) {
  return easedThrough({{0.1f, from}, {1.5f, to}}, t);
}

/// The arm's wrist: turn about the vertical, reach from that axis and height.
struct Wrist {
  float turn_rad, reach_m, height_m;
  glm::vec3 position() const {
    return glm::vec3(kArm.x, height_m, kArm.z) +
           reach_m * glm::vec3(std::sin(turn_rad), 0, std::cos(turn_rad));
  }
};

Wrist wristAt(float t) {
  const float waits = kMagazineTop_m + 2 * kDrumHalf_m + kGrip_m,
              sets = kRollers_m + kDrum_m + kDrumHalf_m + kGrip_m;
  const float over = waits + 0.16f, near = kMagazine.x - kArm.x, far = -kArm.z;
  return {easedThrough({{1.0f, 0.5f * kPi}, {1.75f, 0.0f}, {2.75f, 0.0f}, {3.6f, 0.5f * kPi}}, t),
          easedThrough({{1.0f, near}, {1.7f, far}, {2.75f, far}, {3.6f, near}}, t),
          easedThrough({{0.0f, over},
                        {0.45f, waits},
                        {0.6f, waits},
                        {1.05f, over},
                        {1.65f, over - 0.1f},
                        {kPlaced_s, sets},
                        {2.35f, sets},
                        {2.8f, over - 0.1f},
                        {3.6f, over}},
                       t)};
}

/// Elevations of upper arm and forearm that bring the wrist there, the elbow up (law of cosines).
struct Elbow {
  float upper_rad, fore_rad;
};
Elbow elbowFor(const Wrist& wrist) {
  const float x = wrist.reach_m, y = wrist.height_m - kShoulder_m, far = std::hypot(x, y);
  const float a = std::acos((kUpper_m * kUpper_m + far * far - kFore_m * kFore_m) / (2.0f * kUpper_m * far));
  const float upper = std::atan2(y, x) + a;
  return {upper, std::atan2(y - kUpper_m * std::sin(upper), x - kUpper_m * std::cos(upper))};
}

void addArm(SceneBuilder& builder, const Detail& detail) {
  const int paint = addBelts(builder, "arm paint", {0.78f, 0.34f, 0.03f}, {0.08f, 0.08f, 0.09f}, 2);
  const int dark = builder.diffuse("arm joints", {0.09f, 0.095f, 0.11f});
  const auto bone = [&](const std::string& name, float length, float radius, int parent,
                        const glm::vec3& at) {
    const int node = builder.node(name, parent, at);
    const Mesh tube = shapes::moved(shapes::cylinder(radius, length - 0.07f, 0.02f, detail(22), detail(8)),
                                    {0, -length + 0.035f, 0});
    builder.at(node).meshes = {builder.mesh(name, tube, paint),
                               builder.mesh(name, shapes::icosphere(radius * 1.3f, detail(7)), dark)};
    return node;
  };
  const int turret = builder.place("turret", shapes::cylinder(0.11f, 0.13f, 0.025f, detail(28), detail(4)),
                                   dark, {kArm.x, kShoulder_m - 0.15f, kArm.z});
  const int upper = bone("upper arm", kUpper_m, 0.065f, turret, {0, 0.15f, 0});
  const int fore = bone("forearm", kFore_m, 0.052f, upper, {0, -kUpper_m, 0});
  const int grip = builder.node("gripper", fore, {0, -kFore_m, 0});
  Mesh hand = shapes::icosphere(0.062f, detail(7));
  shapes::append(
      hand, shapes::moved(shapes::cylinder(0.05f, 0.08f, 0.012f, detail(22), detail(3)), {0, -0.12f, 0}));
  builder.at(grip).meshes = {builder.mesh("gripper", std::move(hand), dark)};
  addTurning(builder, turret, kSeconds,
             [](float t) { return glm::angleAxis(wristAt(t).turn_rad, glm::vec3(0, 1, 0)); });
  addTurning(builder, upper, kSeconds,
             [=](float t) { return aboutX(-elbowFor(wristAt(t)).upper_rad - 0.5f * kPi); });
  addTurning(builder, fore, kSeconds, [=](float t) {
    const Elbow elbow = elbowFor(wristAt(t));
    return aboutX(elbow.upper_rad - elbow.fore_rad);
  });
  addTurning(builder, grip, kSeconds,
             [=](float t) { return aboutX(elbowFor(wristAt(t)).fore_rad + 0.5f * kPi); });
}

/// A head falls from the pipe, bounces once and stays.
float fallenHeight(float t) {
  constexpr float kGravity = 9.81f, kOpen_s = 1.75f, kKept = 0.24f;
  const float from = kPipeWait_m, to = kRollers_m + kHead_m, u = t - kOpen_s;
  if (u < 0.0f) return from;
  const float falls_s = std::sqrt(2.0f * (from - to) / kGravity);
  if (u < falls_s) return from - 0.5f * kGravity * u * u;
  const float speed = kKept * kGravity * falls_s, w = u - falls_s;
  return to + std::max(0.0f, speed * w - 0.5f * kGravity * w * w);
}

void addToys(SceneBuilder& builder, const Pieces& pieces) {
  const std::array<float, 5> stations = {kHidden_m[0], kStations_m[0], kStations_m[1], kStations_m[2],
                                         kHidden_m[1]};
  const glm::vec3 on_block(0, kDrum_m, 0);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string number = fmt::format(" {}", k + 1);
    const float from = stations[k], to = stations[k + 1];
    const int toy = placed(builder, "block" + number, pieces.block, kNone, {from, kRollers_m, 0});
    addMotion(builder, toy, kSeconds, [=](float t) { return glm::vec3(along(from, to, t), kRollers_m, 0); });
    if (k > 0) placed(builder, "drum" + number, pieces.drum, toy, on_block);
    if (k == 3) placed(builder, "head" + number, pieces.head, toy, {0, kPressed_m, 0});
    if (k != 2) continue;
    const int head = placed(builder, "head" + number, pieces.head, toy, {0, kHead_m, 0});
    addMotion(builder, head, kSeconds, [](float t) {
      return glm::vec3(0, std::min(kHead_m, ramHeight(std::min(t, 2.1f)) - kRollers_m - kHeadRadius_m), 0);
    });
  }
  // The drum that is set down in this round, and the one that is next.
  const float waits = kMagazineTop_m + kDrumHalf_m;
  const int drum = placed(builder, "drum 1", pieces.drum, kNone, {kMagazine.x, waits, kMagazine.z});
  addMotion(builder, drum, kSeconds, [=](float t) {
    if (t < kGripped_s) return glm::vec3(kMagazine.x, waits, kMagazine.z);
    return wristAt(std::min(t, kPlaced_s)).position() - glm::vec3(0, kGrip_m + kDrumHalf_m, 0);
  });
  const int next =
      placed(builder, "next drum", pieces.drum, kNone, {kMagazine.x, waits - 0.26f, kMagazine.z});
  addMotion(builder, next, kSeconds, [=](float t) {
    return glm::vec3(kMagazine.x, easedThrough({{2.2f, waits - 0.26f}, {3.4f, waits}}, t), kMagazine.z);
  });
  const int head = placed(builder, "head 2", pieces.head, kNone, {kStations_m[1], kPipeWait_m, 0});
  addMotion(builder, head, kSeconds, [](float t) { return glm::vec3(kStations_m[1], fallenHeight(t), 0); });
  const int next_head =
      placed(builder, "next head", pieces.head, kNone, {kStations_m[1], kPipeWait_m + 0.3f, 0});
  addMotion(builder, next_head, kSeconds, [](float t) {
    return glm::vec3(kStations_m[1], easedThrough({{2.3f, kPipeWait_m + 0.3f}, {2.8f, kPipeWait_m}}, t), 0);
  });
}

}  // namespace

float assembly::ramHeight(float time_s) {
  const float lowest = kRollers_m + kPressed_m + kHeadRadius_m;
  return easedThrough({{1.5f, 1.33f}, {1.95f, lowest}, {2.25f, lowest}, {3.0f, 1.33f}}, time_s);
}

Scene makeAssembly(const Detail& detail, NamedValues&) {
  SceneBuilder builder("assembly");
  addHall(builder, detail);
  addToys(builder, makePieces(builder, detail));
  addArm(builder, detail);
  Mesh ram = shapes::cylinder(0.105f, 0.06f, 0.02f, detail(28), detail(3));
  shapes::append(ram,
                 shapes::moved(shapes::cylinder(0.045f, 0.42f, 0.01f, detail(20), detail(8)), {0, 0.05f, 0}));
  const int press = builder.place("ram", std::move(ram), builder.diffuse("ram", {0.5f, 0.5f, 0.52f}),
                                  {kStations_m[2], 1.33f, 0});
  addMotion(builder, press, kSeconds, [](float t) { return glm::vec3(kStations_m[2], ramHeight(t), 0); });

  const int glow = builder.diffuse("lamp", glm::vec3(0.0f));
  builder.material(glow).emission = {34.0f, 24.0f, 13.0f};
  const glm::vec3 middle(0, kRail_m - kLampRadius_m, kRailOut_m);
  const int lamp = builder.place("lamp", shapes::icosphere(kLampRadius_m, detail(8)), glow, middle);
  addMotion(builder, lamp, kSeconds,
            [=](float t) { return middle - glm::vec3(1.45f * std::cos(2 * kPi * t / kSeconds), 0, 0); });
  builder.camera({0.75f, 1.95f, 4.3f}, {-0.02f, 0.84f, -0.2f}, 35);
  builder.sky("mild?intensity=0.3&azimuth=20");
  return builder.finish();
}

}  // namespace gloam
