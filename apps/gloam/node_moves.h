// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nodes that a hand has moved: motions of the world, on top of where scene and animation put things.
#pragma once

#include <gloam/scene.h>

#include <map>
#include <string>
#include <vector>

#include "arguments.h"

namespace gloam::cli {

/// By node, a rotation and a shift in the world; that of a node moves all below it, too.
using NodeMoves = std::map<int, glm::mat4>;

/// All motions of a node and of those above it, together; the identity for kNone.
glm::mat4 motionOf(const Scene& scene, const NodeMoves& moves, int node);
/// Moves a node on, in the world.
void moveNode(const Scene& scene, NodeMoves& moves, int node, const glm::mat4& motion);
/// Nodes of PosedScene::lights, in that order.
std::vector<int> lightNodes(const Scene& scene);
/// The scene at that time, its nodes moved.
PosedScene poseMoved(const Scene& scene, const NodeMoves& moves, float time_s);

/// What --move says of one node, before its scene is there.
struct MoveText {
  std::string node;  ///< its name, or "#" and its index
  glm::mat4 motion{1.0f};
};
/// "NODE=X,Y,Z", or "NODE=X,Y,Z,QX,QY,QZ,QW" where the quaternion turns about the world's origin first. Throws Error.
MoveText parseMove(const std::string& text);
/// Throws Error where the scene has no such node, or several of the name.
NodeMoves movesIn(const Scene& scene, const std::vector<MoveText>& texts);
/// The way back: what --move takes.
std::vector<std::string> moveTexts(const Scene& scene, const NodeMoves& moves);
void addMoveOption(CLI::App& app, std::vector<MoveText>& moves);

}  // namespace gloam::cli
