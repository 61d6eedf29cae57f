// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What can be asked of a node's matrix: its translation, rotation and scale, its nearest rotation, how it
// moves normals.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace gloam {

struct Trs {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< unit
  glm::vec3 scale{1.0f};                       ///< x is negative where the matrix mirrors
};

glm::mat4 composeTrs(const Trs& trs);

/// As near to 1 as a unit vector of floats may come. Readers leave such a vector as it is: what a file holds is drawn bit for
/// bit, and one that is written again stays the same.
inline bool isUnitLength(double length) {
  return std::abs(length - 1.0) < 1e-6;
}

/// The inverse of composeTrs. Nothing where the matrix shears, projects or flattens (no such triple then
/// gives it back within 1e-4 of its largest column).
std::optional<Trs> decomposeTrs(const glm::mat4& matrix);

/// Any 3x3 matrix as rotation, scale, rotation: M = R(outer) diag(scale) R(inner), its singular value decomposition. Two
/// nodes, one within the other, can hold what one translation, rotation and scale cannot.
struct RotatedScale {
  glm::quat outer{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};  ///< x is negative where the matrix mirrors
  glm::quat inner{1.0f, 0.0f, 0.0f, 0.0f};
};
RotatedScale decomposeLinear(const glm::mat3& matrix);

/// The orthogonal matrix nearest to the given one: the factor Q of its polar decomposition M = Q S, S
/// symmetric and positive. It is a rotation, or a rotation times a reflection where M mirrors (det < 0).
/// Baked transfer lives in the axes that it defines: a direction w of the world is transpose(Q) w in the
/// object's axes. A flattened axis (scale 0) is given the direction that completes the others to a rotation.
glm::mat3 rotationFactor(const glm::mat3& matrix);
inline glm::mat3 rotationFactor(const glm::mat4& matrix) {
  return rotationFactor(glm::mat3(matrix));
}

/// Inverse transpose up to a positive factor: how normals move; finite also where the matrix has no inverse.
/// The results are not unit vectors.
glm::mat3 normalTransform(const glm::mat3& matrix);

}  // namespace gloam
