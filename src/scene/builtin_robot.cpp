// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A tin robot that marches on the spot and waves: rigid parts on joints, each a node of its own, or one skin.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "scene/builtin_shapes.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"
#include "scene/sampled_motion.h"
#include "scene/turns.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f;
constexpr float kAnkle_m = 0.09f, kLeg_m = 0.31f;  // thigh and shin are of one length

struct Paints {
  int enamel, accent, rubber, dial, face;
};

Paints makePaints(SceneBuilder& builder) {
  Paints paints;
  // Enamel with a pale belt and rivets, for each side of a box and round each limb.
  paints.enamel = addPainted(builder, "yellow enamel", [](float u, float v) {
    const glm::vec3 yellow(0.82f, 0.5f, 0.045f), pale(0.8f, 0.74f, 0.58f);
    const float belt = smoothStep(0.6f, 0.62f, v) * smoothStep(0.76f, 0.74f, v);
    const float x = 8.0f * u - std::floor(8.0f * u) - 0.5f;
    const float rivet = smoothStep(0.018f, 0.012f, std::hypot(x / 8.0f, v - 0.68f));
    return glm::mix(glm::mix(yellow, pale, belt), glm::vec3(0.2f), rivet);
  });
  paints.accent = addPainted(builder, "warning stripes", [](float u, float v) {
    const float x = 5.0f * (u + v), f = x - std::floor(x);
    const float red = smoothStep(0.0f, 0.03f, f) * smoothStep(0.53f, 0.5f, f);
    return glm::mix(glm::vec3(0.8f, 0.76f, 0.66f), glm::vec3(0.66f, 0.05f, 0.03f), red);
  });
  paints.rubber = builder.diffuse("rubber", {0.055f, 0.06f, 0.07f});
  paints.dial = addPainted(builder, "dials", [](float u, float v) {
    glm::vec3 c(0.08f, 0.24f, 0.28f);
    const auto disc = [&](float x, float y, float r, const glm::vec3& color) {
      c = glm::mix(c, color, smoothStep(r + 0.012f, r - 0.012f, std::hypot(u - x, (v - y) * 0.8f)));
    };
    disc(0.3f, 0.34f, 0.2f, glm::vec3(0.8f, 0.78f, 0.7f));
    disc(0.3f, 0.34f, 0.16f, glm::vec3(0.1f, 0.1f, 0.11f));
    if (std::abs((u - 0.3f) * 0.9f + (v - 0.34f)) < 0.02f && u > 0.26f && u < 0.42f) c = {0.8f, 0.12f, 0.05f};
    disc(0.72f, 0.24f, 0.085f, {0.75f, 0.07f, 0.04f});
    disc(0.72f, 0.5f, 0.085f, {0.1f, 0.55f, 0.16f});
    for (int i = 0; i < 4; ++i) disc(0.2f + 0.2f * float(i), 0.78f, 0.06f, {0.82f, 0.6f, 0.1f});
    return c;
  });
  paints.face = addPainted(builder, "visor", [](float u, float v) {
    glm::vec3 c(0.03f, 0.035f, 0.045f);
    for (const float x : {0.29f, 0.71f}) {
      const float r = std::hypot((u - x) * 2.2f, v - 0.5f);
      c = glm::mix(c, {0.2f, 0.75f, 0.78f}, smoothStep(0.34f, 0.31f, r));
      c = glm::mix(c, {0.03f, 0.05f, 0.06f}, smoothStep(0.15f, 0.12f, std::hypot((u - x) * 2.2f, v - 0.46f)));
    }
    return c;
  });
  return paints;
}

Mesh rounded(const glm::vec3& half, float radius, const glm::vec3& middle, const Detail& detail) {
  return shapes::moved(shapes::roundedBox(half, radius, detail.cell(0.035f), detail(3)), middle);
}

/// A barrel along -Y from y = -from to y = -to.
Mesh barrel(float from, float to, float radius_top, float radius_bottom, const Detail& detail) {
  const float b = 0.028f, top = -from, bottom = -to;
  const auto run =
      shapes::joined({shapes::line({0, top}, {radius_top - b, top}, detail(2)),
                      shapes::arc({radius_top - b, top - b}, b, 0.5f * kPi, 0.0f, detail(3)),
                      shapes::line({radius_top, top - b}, {radius_bottom, bottom + b}, detail(8)),
                      shapes::arc({radius_bottom - b, bottom + b}, b, 0.0f, -0.5f * kPi, detail(3)),
                      shapes::line({radius_bottom - b, bottom}, {0, bottom}, detail(2))});
  return shapes::revolve({run}, detail(28));
}

class Robot {
 public:
  Robot(SceneBuilder& builder, const Detail& detail, bool as_skin)
      : builder_(builder), detail_(detail), as_skin_(as_skin), paints_(makePaints(builder)) {}

  void build() {
    pelvis_ = part("pelvis", kNone, {0, kAnkle_m + 2 * kLeg_m, 0});
    add(pelvis_, rounded({0.135f, 0.065f, 0.1f}, 0.045f, {0, 0.02f, 0}, detail_), paints_.accent);
    add(pelvis_,
        shapes::moved(shapes::cylinder(0.075f, 0.09f, 0.015f, detail_(24), detail_(3)), {0, 0.06f, 0}),
        paints_.rubber);
    torso_ = part("torso", pelvis_, {0, 0.125f, 0});
    add(torso_, rounded({0.205f, 0.19f, 0.135f}, 0.06f, {0, 0.2f, 0}, detail_), paints_.enamel);
    add(torso_, rounded({0.135f, 0.105f, 0.018f}, 0.014f, {0, 0.22f, 0.135f}, detail_), paints_.dial);
    add(torso_, rounded({0.13f, 0.13f, 0.045f}, 0.035f, {0, 0.21f, -0.155f}, detail_), paints_.accent);
    head_ = part("head", torso_, {0, 0.43f, 0});
    add(head_,
        shapes::moved(shapes::cylinder(0.065f, 0.09f, 0.012f, detail_(24), detail_(3)), {0, -0.05f, 0}),
        paints_.rubber);
    add(head_, rounded({0.145f, 0.12f, 0.125f}, 0.055f, {0, 0.15f, 0}, detail_), paints_.enamel);
    add(head_, rounded({0.118f, 0.06f, 0.018f}, 0.014f, {0, 0.165f, 0.118f}, detail_), paints_.face);
    add(head_, shapes::moved(shapes::icosphere(0.04f, detail_(7)), {0, 0.285f, 0}), paints_.accent);
    for (const float side : {1.0f, -1.0f}) {
      Mesh ear = shapes::transformed(shapes::cylinder(0.05f, 0.05f, 0.012f, detail_(20), detail_(2)),
                                     glm::rotate(glm::mat4(1.0f), -0.5f * kPi * side, glm::vec3(0, 0, 1)));
      add(head_, shapes::moved(std::move(ear), {0.135f * side, 0.15f, 0}), paints_.rubber);
    }
    for (const float side : {1.0f, -1.0f}) {
      arm(side);
      leg(side);
    }
    if (!as_skin_) return;
    const int body = builder_.node("robot");
    for (auto& [material, mesh] : skinned_) {
      mesh.influences = 4;
      builder_.at(body).meshes.push_back(builder_.mesh("robot", std::move(mesh), material));
    }
    builder_.at(body).skin = builder_.skin(joints_, std::move(joint_from_mesh_));
  }

  void animate();

 private:
  int part(const std::string& name, int parent, const glm::vec3& at) {
    return builder_.node(name, parent, at);
  }
  void add(int node, Mesh mesh, int material) {
    if (as_skin_) return addToSkin(node, mesh, material);
    const std::string name = builder_.at(node).name;
    builder_.at(node).meshes.push_back(builder_.mesh(name, std::move(mesh), material));
  }
  /// All that is of one material becomes one mesh, each vertex of which follows one joint.
  void addToSkin(int node, const Mesh& mesh, int material) {
    if (joints_.empty() || joints_.back() != node) joints_.push_back(node);
    glm::vec3 at(0.0f);  // nothing is turned at rest
    for (int n = node; n != kNone; n = builder_.at(n).parent) at += builder_.at(n).translation;
    joint_from_mesh_.resize(joints_.size(), glm::translate(glm::mat4(1.0f), -at));
    Mesh& whole = skinned_[material];
    shapes::append(whole, shapes::moved(mesh, at));
    const auto joint = std::uint16_t(joints_.size() - 1);
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
      whole.joints.insert(whole.joints.end(), {joint, 0, 0, 0});
      whole.weights.insert(whole.weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
    }
  }
  void joint(int node, float radius) { add(node, shapes::icosphere(radius, detail_(8)), paints_.rubber); }

  void arm(float side) {
    const std::size_t i = side > 0.0f ? 0 : 1;
    const std::string which = i == 0 ? " left" : " right";
    upper_arm_[i] = part("upper arm" + which, torso_, {0.268f * side, 0.315f, 0});
    joint(upper_arm_[i], 0.068f);
    add(upper_arm_[i], barrel(0.04f, 0.235f, 0.058f, 0.05f, detail_), paints_.enamel);
    forearm_[i] = part("forearm" + which, upper_arm_[i], {0, -0.275f, 0});
    joint(forearm_[i], 0.052f);
    add(forearm_[i], barrel(0.035f, 0.2f, 0.052f, 0.066f, detail_), paints_.accent);
    hand_[i] = part("hand" + which, forearm_[i], {0, -0.235f, 0});
    joint(hand_[i], 0.045f);
    // Two prongs and a thumb, half open.
    for (const float z : {0.032f, -0.032f}) {
      const glm::mat4 spread = glm::rotate(glm::mat4(1.0f), 9.0f * z, glm::vec3(1, 0, 0));
      add(hand_[i],
          shapes::transformed(rounded({0.022f, 0.05f, 0.022f}, 0.02f, {0.018f * side, -0.07f, z}, detail_),
                              spread),
          paints_.enamel);
    }
    const glm::mat4 thumb = glm::rotate(glm::mat4(1.0f), -0.5f * side, glm::vec3(0, 0, 1));
    add(hand_[i],
        shapes::transformed(rounded({0.021f, 0.042f, 0.023f}, 0.02f, {-0.018f * side, -0.06f, 0}, detail_),
                            thumb),
        paints_.enamel);
  }

  void leg(float side) {
    const std::size_t i = side > 0.0f ? 0 : 1;
    const std::string which = i == 0 ? " left" : " right";
    thigh_[i] = part("thigh" + which, pelvis_, {0.1f * side, 0, 0});
    joint(thigh_[i], 0.066f);
    add(thigh_[i], barrel(0.035f, 0.265f, 0.07f, 0.058f, detail_), paints_.enamel);
    shin_[i] = part("shin" + which, thigh_[i], {0, -kLeg_m, 0});
    joint(shin_[i], 0.058f);
    add(shin_[i], barrel(0.04f, 0.275f, 0.058f, 0.078f, detail_), paints_.accent);
    foot_[i] = part("foot" + which, shin_[i], {0, -kLeg_m, 0});
    add(foot_[i], rounded({0.078f, 0.04f, 0.13f}, 0.035f, {0, -0.048f, 0.045f}, detail_), paints_.enamel);
    joint(foot_[i], 0.05f);
  }

  SceneBuilder& builder_;
  Detail detail_;
  bool as_skin_;
  Paints paints_;
  int pelvis_ = kNone, torso_ = kNone, head_ = kNone;
  std::array<int, 2> upper_arm_{}, forearm_{}, hand_{}, thigh_{}, shin_{}, foot_{};
  std::map<int, Mesh> skinned_;  // by material
  std::vector<int> joints_;
  std::vector<glm::mat4> joint_from_mesh_;
};

constexpr float kBeat_s = 1.0f;  // each foot is lifted every second beat

/// How far the left (0) or right (1) foot is lifted, 0 to 1.
float lift(std::size_t i, float t) {
  const float x = std::fmod(t + (i == 0 ? 0.0f : kBeat_s), 2.0f * kBeat_s) / kBeat_s;
  if (x > 0.9f) return 0.0f;
  const float s = std::sin(kPi * x / 0.9f);
  return s * s;
}

/// Bend of the hip over the standing foot: the body sinks as a foot comes down.
float crouch(float t) {
  return 0.22f + 0.1f * std::cos(2 * kPi * t / kBeat_s);
}

/// Share of the wave in the left arm's motion.
float waving(float t) {
  return easedThrough({{0.0f, 0.0f}, {0.3f, 0.0f}, {1.1f, 1.0f}, {3.0f, 1.0f}, {3.8f, 0.0f}}, t);
}

void Robot::animate() {
  addMotion(builder_, pelvis_, kSeconds,
            [](float t) { return glm::vec3(0, kAnkle_m + 2.0f * kLeg_m * std::cos(crouch(t)), 0); });
  addTurning(builder_, torso_, kSeconds, [](float t) {
    return aboutY(-0.22f * std::sin(kPi * t / kBeat_s)) * aboutZ(0.05f * std::sin(kPi * t / kBeat_s)) *
           aboutX(0.04f);
  });
  addTurning(builder_, head_, kSeconds, [](float t) {
    return aboutY(0.16f * std::sin(kPi * t / kBeat_s) + 0.42f * std::sin(2 * kPi * t / kSeconds)) *
           aboutX(0.05f * std::sin(2 * kPi * t / kBeat_s)) * aboutZ(0.12f * waving(t));
  });
  for (std::size_t i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0f : -1.0f;
    addTurning(builder_, thigh_[i], kSeconds,
               [=](float t) { return aboutX(-crouch(t) - 0.8f * lift(i, t)); });
    addTurning(builder_, shin_[i], kSeconds,
               [=](float t) { return aboutX(2.0f * crouch(t) + 1.05f * lift(i, t)); });
    // Soles stay level, but for toes that hang a little in the air.
    addTurning(builder_, foot_[i], kSeconds, [=](float t) { return aboutX(-crouch(t) - 0.1f * lift(i, t)); });
    const auto swing = [=](float t) { return -0.55f * side * std::sin(kPi * t / kBeat_s); };
    const auto wave = [=](float t) { return i == 0 ? waving(t) : 0.0f; };
    addTurning(builder_, upper_arm_[i], kSeconds, [=](float t) {
      const glm::quat marching = aboutZ(0.2f * side) * aboutX(swing(t));
      return glm::slerp(marching, aboutZ(1.75f * side) * aboutX(-0.25f), wave(t));
    });
    addTurning(builder_, forearm_[i], kSeconds, [=](float t) {
      const glm::quat marching = aboutX(-0.75f + 0.4f * std::min(0.0f, swing(t)));
      const float sway = 0.45f * std::sin(2 * kPi * (t - 0.2f) / 0.7f);
      return glm::slerp(marching, aboutZ((1.05f + sway) * side), wave(t));
    });
    addTurning(builder_, hand_[i], kSeconds, [=](float t) {
      return aboutZ(0.3f * side * wave(t) * std::sin(2 * kPi * t / 0.7f)) * aboutY(-0.5f * side);
    });
  }
}

}  // namespace

Scene makeRobot(const Detail& detail, NamedValues& values) {
  const bool as_skin = values.take("skin", 0, 0, 1) >= 0.5;
  SceneBuilder builder("robot");
  const float cell = detail.cell(0.07f);
  builder.place("floor", shapes::withUvScale(shapes::slab(1.75f, 1.6f, 0.2f, 0.02f, cell), {2.1875f, 2.0f}),
                addTiles(builder, "floor", {0.64f, 0.62f, 0.57f}, {0.3f, 0.34f, 0.36f}), {0, 0, 0.2f});
  builder.place(
      "back wall",
      shapes::moved(shapes::roundedBox({1.75f, 1.05f, 0.06f}, 0.02f, 1.5f * cell, 2), {0, 1.05f, 0}),
      addPlaster(builder, "back plaster", {0.68f, 0.66f, 0.6f}, {0.1f, 0.36f, 0.42f}, 0.62f, 1.1f),
      {0, -0.03f, -1.06f});
  builder.place(
      "side wall",
      shapes::moved(shapes::roundedBox({0.06f, 1.05f, 1.37f}, 0.02f, 1.5f * cell, 2), {0, 1.05f, 0}),
      addPlaster(builder, "side plaster", {0.68f, 0.66f, 0.6f}, {0.5f, 0.1f, 0.06f}, 0.62f, 1.1f),
      {-1.69f, -0.03f, 0.375f});
  Robot robot(builder, detail, as_skin);
  robot.build();
  robot.animate();
  builder.camera({1.5f, 1.35f, 3.3f}, {-0.06f, 0.75f, -0.05f}, 32);
  builder.sky("mild?azimuth=30&elevation=42");
  return builder.finish();
}

}  // namespace gloam
