// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A figure walks round a pedestal between two coloured walls.
#include <algorithm>

#include "scene/builtin_shapes.h"
#include "scene/figure.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

void addFigure(SceneBuilder& builder, const Detail& detail) {
  const auto& joints = figure::joints();
  const int armature = builder.node("armature");
  std::vector<int> nodes;
  std::vector<glm::mat4> joint_from_mesh;
  for (const figure::JointInfo& joint : joints) {
    const bool top = joint.parent == kNone;
    const glm::vec3 origin = top ? glm::vec3(0.0f) : joints[std::size_t(joint.parent)].position;
    nodes.push_back(
        builder.node(joint.name, top ? armature : nodes[std::size_t(joint.parent)], joint.position - origin));
    glm::mat4 inverse_bind(1.0f);
    inverse_bind[3] = glm::vec4(-joint.position, 1.0f);
    joint_from_mesh.push_back(inverse_bind);
  }
  const int body = builder.place("figure", figure::body(std::min(0.022f, detail.cell(0.019f))),
                                 builder.diffuse("pear wood", {0.72f, 0.44f, 0.22f}));
  builder.at(body).skin = builder.skin(nodes, std::move(joint_from_mesh));

  const figure::Walk walk;
  const int keys = 24 * int(walk.seconds);
  std::vector<figure::Posture> postures;
  for (int k = 0; k <= keys; ++k)
    postures.push_back(figure::walking(walk, walk.seconds * float(k) / float(keys)));
  AnimationChannel& place =
      builder.channel(nodes[figure::kPelvis], Path::kTranslation, Interpolation::kLinear);
  for (int k = 0; k <= keys; ++k) {
    addKey(place, walk.seconds * float(k) / float(keys), postures[std::size_t(k)].pelvis);
  }
  for (std::size_t j = 0; j < figure::kJoints; ++j) {
    AnimationChannel& turn = builder.channel(nodes[j], Path::kRotation, Interpolation::kLinear);
    for (int k = 0; k <= keys; ++k) {
      addKey(turn, walk.seconds * float(k) / float(keys), postures[std::size_t(k)].rotation[j]);
    }
  }
}

}  // namespace

Scene makeWalker(const Detail& detail, NamedValues&) {
  SceneBuilder builder("walker");
  const float cell = detail.cell(0.045f);
  builder.place("ground", shapes::slab(2.2f, 2.2f, 0.2f, 0.03f, cell),
                builder.diffuse("ground", {0.48f, 0.46f, 0.42f}));
  // Walls and pedestal reach into the ground and each other by their edges' radius: round edges would be seen there as dark lines.
  constexpr float kEdge = 0.005f;
  builder.place("back wall",
                shapes::moved(shapes::roundedBox({2.2f, 1.2025f, 0.08f}, kEdge, cell, 2), {0, 1.1975f, 0}),
                builder.diffuse("teal plaster", {0.16f, 0.4f, 0.4f}), {0, 0, -2.12f});
  builder.place("left wall",
                shapes::moved(shapes::roundedBox({0.08f, 1.2025f, 2.0425f}, kEdge, cell, 2), {0, 1.1975f, 0}),
                builder.diffuse("red plaster", {0.58f, 0.14f, 0.09f}), {-2.12f, 0, -0.0025f});
  builder.place("pedestal", shapes::cylinder(0.3f, 0.645f, 0.02f, detail(56), detail(22)),
                builder.diffuse("stone", {0.68f, 0.66f, 0.62f}), {0, -0.025f, 0});
  builder.place("knot", shapes::torusKnot(2, 3, 0.2f, 0.085f, 0.052f, detail(180), detail(16)),
                builder.diffuse("gilded paint", {0.78f, 0.55f, 0.15f}), {0, 0.84f, 0});
  addFigure(builder, detail);
  builder.camera({3.1f, 2.5f, 4.4f}, {-0.1f, 0.72f, -0.1f}, 38);
  builder.sky("mild");
  return builder.finish();
}

}  // namespace gloam
