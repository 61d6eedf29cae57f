// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The polar factor is found by Newton's iteration Q <- (Q + Q^-T) / 2 from Q = M (Higham 1986, "Computing the
// polar decomposition"), which doubles the correct digits each step; in double precision ten steps suffice
// after scaling.
#include "scene/transforms.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

float largestColumn(const glm::mat3& m) {
  return std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
}

// Gram-Schmidt for matrices that flatten at least one axis: the longest column leads, what is lost is
// completed.
glm::dmat3 completedRotation(const glm::dmat3& m) {
  int order[3] = {0, 1, 2};
  std::sort(order, order + 3, [&](int a, int b) { return glm::length(m[a]) > glm::length(m[b]); });
  glm::dmat3 q(1.0);
  if (glm::length(m[order[0]]) == 0.0) return q;
  const glm::dvec3 first = glm::normalize(m[order[0]]);
  glm::dvec3 second = m[order[1]] - first * glm::dot(first, m[order[1]]);
  if (glm::length(second) <= 1e-9 * glm::length(m[order[0]])) {
    // One axis alone is left: any perpendicular serves; take the axis that the identity would have, made
    // perpendicular.
    glm::dvec3 axis(0.0);
    axis[order[1]] = 1.0;
    second = axis - first * glm::dot(first, axis);
    if (glm::length(second) < 1e-3) {
      axis = glm::dvec3(0.0);
      axis[order[0]] = 1.0;
      second = axis - first * glm::dot(first, axis);
    }
  }
  second = glm::normalize(second);
  q[order[0]] = first;
  q[order[1]] = second;
  // (order[0], order[1], order[2]) is an even permutation of the axes where the cross product keeps its sign.
  const bool even = (order[1] - order[0] + 3) % 3 == 1;
  q[order[2]] = even ? glm::cross(first, second) : -glm::cross(first, second);
  return q;
}

}  // namespace

glm::mat4 composeTrs(const Trs& trs) {
  glm::mat4 m = glm::mat4_cast(trs.rotation);
  m[0] *= trs.scale.x;
  m[1] *= trs.scale.y;
  m[2] *= trs.scale.z;
  m[3] = glm::vec4(trs.translation, 1.0f);
  return m;
}

std::optional<Trs> decomposeTrs(const glm::mat4& matrix) {
  if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f)
    return std::nullopt;
  const glm::mat3 linear(matrix);
  Trs trs;
  trs.translation = glm::vec3(matrix[3]);
  trs.scale = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
  if (!(trs.scale.x > 0.0f && trs.scale.y > 0.0f && trs.scale.z > 0.0f)) return std::nullopt;
  if (glm::determinant(linear) < 0.0f) trs.scale.x = -trs.scale.x;
  const glm::mat3 rotation(linear[0] / trs.scale.x, linear[1] / trs.scale.y, linear[2] / trs.scale.z);
  trs.rotation = glm::normalize(glm::quat_cast(rotation));
  const glm::mat3 again(composeTrs(trs));
  const float tolerance = 1e-4f * largestColumn(linear);
  for (int c = 0; c < 3; ++c) {
    if (glm::length(again[c] - linear[c]) > tolerance) return std::nullopt;
  }
  return trs;
}

RotatedScale decomposeLinear(const glm::mat3& matrix) {
  // Eigenvectors of the symmetric M^T M by Jacobi's rotations.
  const glm::dmat3 m(matrix);
  glm::dmat3 s = glm::transpose(m) * m, v(1.0);
  for (int sweep = 0; sweep < 32; ++sweep) {
    for (int p = 0; p < 3; ++p) {
      const int q = (p + 1) % 3;
      if (std::abs(s[q][p]) <= 1e-300) continue;
      // The smaller of the two rotations that clear s_pq: only that one converges.
      const double angle =
          0.5 * std::atan2(2.0 * s[q][p] * (s[p][p] < s[q][q] ? -1.0 : 1.0), std::abs(s[p][p] - s[q][q]));
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = std::cos(angle);
      turn[p][q] = std::sin(angle);
      turn[q][p] = -std::sin(angle);
      s = glm::transpose(turn) * s * turn;
      v = v * turn;
    }
  }
  if (glm::determinant(v) < 0.0) v[0] = -v[0];
  const glm::dmat3 scaled = m * v;  // U times the singular values
  glm::mat3 u = rotationFactor(glm::mat3(scaled));
  RotatedScale result;
  for (int c = 0; c < 3; ++c) result.scale[c] = float(glm::length(scaled[c]));
  if (glm::determinant(u) < 0.0f) {
    u[0] = -u[0];
    result.scale.x = -result.scale.x;
  }
  result.outer = glm::normalize(glm::quat_cast(u));
  result.inner = glm::normalize(glm::quat_cast(glm::mat3(glm::transpose(v))));
  return result;
}

glm::mat3 rotationFactor(const glm::mat3& matrix) {
  const double size = largestColumn(matrix);
  if (!(size > 0.0) || !std::isfinite(size)) return glm::mat3(1.0f);
  glm::dmat3 q = glm::dmat3(matrix) / size;
  if (std::abs(glm::determinant(q)) < 1e-10) return glm::mat3(completedRotation(q));
  for (int step = 0; step < 64; ++step) {
    const glm::dmat3 inverse_transpose = glm::transpose(glm::inverse(q));
    const glm::dmat3 next = 0.5 * (q + inverse_transpose);
    double change = 0.0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - q[c]));
    q = next;
    if (change < 1e-14) break;
  }
  return glm::mat3(q);
}

glm::mat3 normalTransform(const glm::mat3& m) {
  const glm::mat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0f ? -cofactor : cofactor;
}

}  // namespace gloam
