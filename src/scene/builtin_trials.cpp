// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What spherical lights are tried on, after Figures 7 to 11 of Guerrero, Jeschke, Wimmer 2008: one ball and several, balls
// grown into each other, a cylinder that bends, a box with sharp edges, links of a chain, bars that no order sorts; and two
// white balls under white light, which tend to radiance 1 with bounces however they stand.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/implicit_surface.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"
#include "scene/sampled_motion.h"
#include "scene/soft_parts.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f;

const glm::vec3 kRed(0.7f, 0.06f, 0.04f), kBlue(0.05f, 0.17f, 0.62f), kYellow(0.84f, 0.58f, 0.06f),
    kGreen(0.1f, 0.48f, 0.13f), kWhite(0.8f, 0.79f, 0.76f);

/// A pale ground, on which colour shows.
void addStage(SceneBuilder& builder, const Detail& detail, float half) {
  builder.place("ground", shapes::slab(half, half, 0.15f, 0.04f, detail.cell(half / 46.0f)),
                builder.diffuse("ground", {0.72f, 0.71f, 0.69f}));
}

void addTurn(SceneBuilder& builder, int node, float turns) {
  addTurning(builder, node, kSeconds,
             [=](float t) { return glm::angleAxis(2 * kPi * turns * t / kSeconds, glm::vec3(0, 1, 0)); });
}

/// A point on the bent axis of a cylinder of that length, at a share of it, and the way on.
struct Joint {
  glm::vec3 position;
  float angle_rad;
};

}  // namespace

Scene makeBalls(const Detail& detail, NamedValues& values) {
  const int count = int(values.take("count", 5, 1, 5));
  SceneBuilder builder("balls");
  addStage(builder, detail, 1.9f);
  const std::array<int, 5> paints = {addGores(builder, "red gores", kRed, kWhite, kBlue, 8),
                                     addBelts(builder, "blue belts", kBlue, kWhite, 2),
                                     addChequers(builder, "yellow chequers", kYellow, kGreen, 8, 4),
                                     addBelts(builder, "green belts", kGreen, kYellow, 1),
                                     addGores(builder, "white gores", kWhite, kRed, kWhite, 6)};
  const std::array<glm::vec3, 5> places = {
      {{0, 0, 0}, {0.82f, 0, 0.28f}, {-0.75f, 0, 0.42f}, {-0.42f, 0, -0.82f}, {0.5f, 0, -0.72f}}};
  const std::array<float, 5> radii = {0.42f, 0.26f, 0.3f, 0.34f, 0.22f};
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    const glm::vec3 low = places[i] + glm::vec3(0, radii[i] + 0.02f, 0);
    const int ball = builder.place("ball " + std::to_string(i + 1),
                                   shapes::uvSphere(radii[i], 2 * detail(24), detail(24)), paints[i], low);
    addTurn(builder, ball, i % 2 ? -1.0f : 1.0f);
    addMotion(builder, ball, kSeconds, [=](float t) {
      return low + glm::vec3(0, 0.16f * (1.0f - std::cos(2 * kPi * (t / kSeconds + 0.2f * float(i)))), 0);
    });
  }
  builder.camera({1.0f, 1.9f, 3.4f}, {0, 0.32f, 0}, 32);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makePair(const Detail& detail, NamedValues& values) {
  const float overlap = float(values.take("overlap", 0.3, -1, 0.9));
  const bool apart = values.take("objects", 1, 1, 2) > 1.5;
  constexpr float kRadius = 0.42f;
  const float x = kRadius * (1.0f - 0.5f * overlap);
  SceneBuilder builder("pair");
  addStage(builder, detail, 1.8f);
  const int both = builder.node("pair", kNone, {0, kRadius + 0.12f, 0});
  if (apart) {
    for (const float side : {-1.0f, 1.0f})
      builder.place(
          side < 0 ? "red ball" : "blue ball", shapes::uvSphere(kRadius, 2 * detail(24), detail(24)),
          side < 0 ? addBelts(builder, "red", kRed, kWhite, 1) : addBelts(builder, "blue", kBlue, kWhite, 1),
          {side * x, 0, 0}, both);
  } else {
    const auto distance = [&](const glm::vec3& p) {
      const glm::vec3 to_side(x, 0, 0);
      return smoothMinimum(glm::length(p - to_side) - kRadius, glm::length(p + to_side) - kRadius, 0.08f);
    };
    const float cell = detail.cell(0.036f), reach = kRadius + 3.0f * cell;
    const glm::vec3 half(x + reach, reach, reach);
    Mesh mesh = meshOfSurface(distance, -half, half, cell);
    // Each half has the belts of a ball; u tells red from blue.
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
      const glm::vec3& p = mesh.positions[i];
      mesh.uv_sets[0][i] = {p.x < 0.0f ? 0.25f : 0.75f,
                            std::acos(std::clamp(p.y / kRadius, -1.0f, 1.0f)) / kPi};
    }
    const int paint = addPainted(builder, "red and blue", [](float u, float v) {
      const float belt = smoothStep(0.31f, 0.34f, v) * smoothStep(0.69f, 0.66f, v);
      return glm::mix(kWhite, u < 0.5f ? kRed : kBlue,
                      std::max(smoothStep(0.36f, 0.33f, v) + smoothStep(0.64f, 0.67f, v), 1.0f - belt));
    });
    builder.at(both).meshes = {builder.mesh("pair", std::move(mesh), paint)};
  }
  addTurn(builder, both, 1.0f);
  builder.camera({0.9f, 1.7f, 3.3f}, {0, 0.36f, 0}, 32);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makeBend(const Detail& detail, NamedValues& values) {
  const float most_rad = glm::radians(float(values.take("angle", 180, 0, 270)));
  constexpr int kJoints = 9;
  constexpr float kLength = 2.4f, kRadius = 0.24f;
  SceneBuilder builder("bend");
  addStage(builder, detail, 2.3f);
  // The cylinder lies along X at rest and bends in its level plane about its middle joint, towards -Z.
  Mesh mesh = shapes::moved(shapes::cylinder(kRadius, kLength, 0.05f, detail(44), detail(64)),
                            {0, -0.5f * kLength, 0});
  mesh = shapes::transformed(std::move(mesh), glm::rotate(glm::mat4(1.0f), -0.5f * kPi, glm::vec3(0, 0, 1)));
  mesh.influences = 4;
  for (const glm::vec3& p : mesh.positions) {
    const float s = std::clamp(p.x / kLength + 0.5f, 0.0f, 1.0f) * float(kJoints - 1);
    const int below = std::min(int(s), kJoints - 2);
    const float above = smoothStep(0.0f, 1.0f, s - float(below));
    // Joints without weight are 0.
    mesh.joints.insert(mesh.joints.end(), {std::uint16_t(above < 1.0f ? below : 0),
                                           std::uint16_t(above > 0.0f ? below + 1 : 0), 0, 0});
    mesh.weights.insert(mesh.weights.end(), {1.0f - above, above, 0.0f, 0.0f});
  }
  const float step = kLength / float(kJoints - 1), height = 1.0f;
  const auto bend = [=](float t) { return most_rad * 0.5f * (1.0f - std::cos(2 * kPi * t / kSeconds)); };
  // Half of the bend lies to either side of the middle joint, which moves so that the arch stays over the stage.
  const auto placeOf = [=](int j, float angle) {
    Joint joint{{0, 0, 0}, angle * (float(j) / float(kJoints - 1) - 0.5f)};
    const int middle = (kJoints - 1) / 2, way = j < middle ? -1 : 1;
    for (int k = middle; k != j; k += way) {
      const float along = angle * ((float(k) + 0.5f * float(way)) / float(kJoints - 1) - 0.5f);
      joint.position += float(way) * step * glm::vec3(std::cos(along), 0, -std::sin(along));
    }
    const float turned = angle > 1e-3f ? kLength / angle * (1.0f - std::cos(0.5f * angle)) : 0.0f;
    joint.position += glm::vec3(0, height, 0.5f * turned);
    return joint;
  };
  std::vector<int> joints;
  std::vector<glm::mat4> joint_from_mesh;
  for (int j = 0; j < kJoints; ++j) {
    const float x = step * float(j) - 0.5f * kLength;
    const int joint = builder.node("joint " + std::to_string(j), kNone, {x, height, 0});
    joints.push_back(joint);
    joint_from_mesh.push_back(glm::translate(glm::mat4(1.0f), {-x, 0, 0}));
    addMotion(builder, joint, kSeconds, [=](float t) { return placeOf(j, bend(t)).position; });
    addTurning(builder, joint, kSeconds,
               [=](float t) { return glm::angleAxis(placeOf(j, bend(t)).angle_rad, glm::vec3(0, 1, 0)); });
  }
  const int node = builder.place("cylinder", std::move(mesh),
                                 addChequers(builder, "yellow and red", kYellow, kRed, 8, 16));
  builder.at(node).skin = builder.skin(joints, std::move(joint_from_mesh));
  builder.camera({1.0f, 3.1f, 3.9f}, {0, 0.45f, -0.05f}, 36);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makeBox(const Detail& detail, NamedValues& values) {
  const float lift = float(values.take("lift", 0.1, 0.001, 1));
  constexpr float kHalf = 0.45f;
  SceneBuilder builder("box");
  addStage(builder, detail, 1.7f);
  const int paint = addPainted(builder, "box paint", [](float u, float v) {
    const float edge = std::min(std::min(u, 1.0f - u), std::min(v, 1.0f - v));
    const float ring = std::max(std::abs(u - 0.5f), std::abs(v - 0.5f));
    const glm::vec3 orange(0.8f, 0.24f, 0.03f);
    return glm::mix(glm::mix(orange, kYellow, smoothStep(0.27f, 0.25f, ring)), kRed,
                    smoothStep(0.08f, 0.06f, edge));
  });
  const int box = builder.place("box", shapes::roundedBox(glm::vec3(kHalf), 0.008f, detail.cell(0.045f), 1),
                                paint, {0, kHalf + lift, 0});
  const glm::quat stands = glm::angleAxis(0.5f, glm::vec3(0, 1, 0));
  addTurning(builder, box, kSeconds,
             [=](float t) { return glm::angleAxis(2 * kPi * t / kSeconds, glm::vec3(0, 1, 0)) * stands; });
  builder.camera({0.9f, 1.8f, 3.1f}, {0, 0.4f, 0}, 32);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makeLinks(const Detail& detail, NamedValues& values) {
  const int count = int(values.take("count", 2, 2, 4));
  constexpr float kTube = 0.085f, kHalfStraight = 0.2f, kBow = 0.24f;  // middle line of a link
  const float pitch = 2.0f * (kHalfStraight + kBow) - 2.0f * kTube - 0.12f;
  SceneBuilder builder("links");
  addStage(builder, detail, 1.8f + 0.25f * float(count - 2));
  const auto curve = [](float t) {  // two straights and two half circles, in the XY plane, longer along X
    const float straight = 2.0f * kHalfStraight, bow = kPi * kBow, whole = 2.0f * (straight + bow);
    float s = (t - std::floor(t)) * whole;
    if (s < straight) return glm::vec3(s - kHalfStraight, kBow, 0);
    s -= straight;
    if (s < bow) return glm::vec3(kHalfStraight + kBow * std::sin(s / kBow), kBow * std::cos(s / kBow), 0);
    s -= bow;
    if (s < straight) return glm::vec3(kHalfStraight - s, -kBow, 0);
    s -= straight;
    return glm::vec3(-kHalfStraight - kBow * std::sin(s / kBow), -kBow * std::cos(s / kBow), 0);
  };
  const std::array<glm::vec3, 4> hues = {kRed, kBlue, kYellow, kGreen};
  for (int i = 0; i < count; ++i) {
    const std::string name = "link " + std::to_string(i + 1);
    const glm::vec3 at((float(i) - 0.5f * float(count - 1)) * pitch, 0.66f, 0);
    const glm::vec3 hue = hues[std::size_t(i)];
    const int paint = addBelts(builder, name, hue, glm::mix(hue, kWhite, 0.75f), 3);
    Mesh link = shapes::tube(curve, kTube, 4 * detail(34), detail(20));
    for (glm::vec2& uv : link.uv_sets[0]) uv = {uv.y, uv.x * 2.0f};  // belts lie across the link
    const int node = builder.place(name, std::move(link), paint, at);
    const float stands = i % 2 == 0 ? 0.25f * kPi : -0.25f * kPi;  // neighbours at right angles
    addTurning(builder, node, kSeconds, [=](float t) {
      return glm::angleAxis(stands + 0.18f * std::sin(2 * kPi * t / kSeconds + 1.3f * float(i)),
                            glm::vec3(1, 0, 0));
    });
  }
  builder.camera({0.8f, 1.75f, 3.3f + 0.5f * float(count - 2)}, {0, 0.42f, 0}, 33);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makeBars(const Detail& detail, NamedValues&) {
  SceneBuilder builder("bars");
  addStage(builder, detail, 1.8f);
  // Each lies over the next and under the one before.
  const int group = builder.node("bars", kNone, {0, 0.62f, 0});
  const std::array<glm::vec3, 3> hues = {kRed, kBlue, kYellow};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "bar " + std::to_string(i + 1);
    const int node = builder.node(name, group);
    const Mesh bar = shapes::roundedBox({0.85f, 0.085f, 0.11f}, 0.05f, detail.cell(0.05f), detail(3));
    const float turn = 2 * kPi * float(i) / 3.0f;
    builder.at(node).rotation =
        glm::angleAxis(turn, glm::vec3(0, 1, 0)) * glm::angleAxis(0.3f, glm::vec3(0, 0, 1));
    builder.at(node).translation = glm::angleAxis(turn, glm::vec3(0, 1, 0)) * glm::vec3(0, 0, 0.27f);
    builder.at(node).meshes = {
        builder.mesh(name, bar, addChequers(builder, name, hues[i], glm::mix(hues[i], kWhite, 0.7f), 8, 2))};
  }
  addTurn(builder, group, 1.0f / 3.0f);
  builder.camera({0.8f, 2.0f, 3.2f}, {0, 0.4f, 0}, 33);
  builder.sky("mild?azimuth=30");
  return builder.finish();
}

Scene makeFurnacePair(const Detail& detail, NamedValues& values) {
  const float gap = float(values.take("gap", 0.2, 0.001, 4)), albedo = float(values.take("albedo", 1, 0, 1));
  SceneBuilder builder("furnace-pair");
  const int white = builder.diffuse("white", glm::vec3(albedo));
  for (const float side : {-1.0f, 1.0f})
    builder.place(side < 0 ? "left" : "right", shapes::icosphere(1.0f, detail(22)), white,
                  {side * (1.0f + 0.5f * gap), 0, 0});
  builder.camera({0, 0, 9.0f + 0.5f * gap}, {0, 0, 0}, 30);
  builder.sky("uniform");
  return builder.finish();
}

}  // namespace gloam
