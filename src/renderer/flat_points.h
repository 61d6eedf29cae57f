// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Points of surfaces that are to become rectangles, spread by area.
#pragma once

#include <gloam/scene.h>

#include <vector>

namespace gloam {

inline constexpr int kFlatPoints = 20000;  ///< of all things together

struct FlatPoint {
  glm::vec3 place, normal;     ///< world; unit, as the triangle winds
  glm::vec3 albedo, emission;  ///< reflectance of diffuse and gloss together; radiance
  float area;                  ///< that it stands for
  float meets = 1.0f;          ///< share of what it sends that meets a surface
  float room = 0.0f;           ///< metres to what has no spheres, mean; 0 where some of it meets none
};

/// Square metres, in the world.
double areaOf(const Mesh& mesh, const glm::mat4& world_from_object);
/// Of one mesh where it stands.
std::vector<FlatPoint> pointsOf(const Scene& scene, const Instance& instance, double area_each);
/// Sets `meets` by a few rays from each point, spread as the cosine is; and `room`, by the same among these instances alone, which the
/// points are of.
void meetSurfaces(const Scene& scene, const PosedScene& posed, const std::vector<const Instance*>& instances,
                  std::vector<std::vector<FlatPoint>>& points);
/// For each of these instances the points that shine, once to each side from which they can be seen: not to the inside of what is closed,
/// not where something lies right before them.
std::vector<std::vector<FlatPoint>> shiningPoints(const Scene& scene, const PosedScene& posed,
                                                  const std::vector<const Instance*>& instances);

}  // namespace gloam
