// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which surface points one rectangle stands for.
#pragma once

#include "renderer/flat_points.h"

namespace gloam {

/// Points that face one way, within a box along an object's axes.
struct FlatGroup {
  std::vector<FlatPoint> points;
  int axis = 0;                              ///< that they face, either way
  glm::vec3 low{INFINITY}, high{-INFINITY};  ///< along the axes
  float area = 0.0f;
  void add(const FlatPoint& point, const glm::mat3& own_from_world);
};

/// By cells of that size and which of six ways points face.
std::vector<FlatGroup> groupedByCells(const std::vector<FlatPoint>& points, const glm::mat3& world_from_own,
                                      float side);

/// Points of several things: first by which of six ways they face; then the group where it gains most is cut in two, across its length or
/// where `meets` tells shade from light, until there are `most`.
std::vector<std::vector<FlatGroup>> groupedByLight(const std::vector<std::vector<FlatPoint>>& points,
                                                   const std::vector<glm::mat3>& world_from_own, int most);

}  // namespace gloam
