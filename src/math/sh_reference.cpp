// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_reference.h"

#include <cmath>

#include "math/quadrature.h"

namespace gloam::sh::reference {
namespace {

const Real kPi = std::acos(Real(-1));

Real factorial(int n) {
  return n < 2 ? Real(1) : Real(n) * factorial(n - 1);
}

/// Associated Legendre function P_l^m without the Condon-Shortley phase, m >= 0, by the recursion in l.
Real associatedLegendre(int l, int m, Real z) {
  Real value = 1;  // P_m^m = (2m - 1)!! sin^m
  for (int i = 1; i <= m; ++i) value *= Real(2 * i - 1) * std::sqrt(Real(1) - z * z);
  if (l == m) return value;
  Real before = value;
  value = Real(2 * m + 1) * z * before;
  for (int i = m + 2; i <= l; ++i) {
    const Real next = (Real(2 * i - 1) * z * value - Real(i + m - 1) * before) / Real(i - m);
    before = value;
    value = next;
  }
  return value;
}

}  // namespace

Vector evaluate(int order, Direction direction) {
  const Real length = std::hypot(std::hypot(direction[0], direction[1]), direction[2]);
  for (Real& component : direction) component /= length;
  const Real phi = std::atan2(direction[1], direction[0]);
  const Real z = std::min(Real(1), std::max(Real(-1), direction[2]));
  Vector basis;
  for (int l = 0; l < order; ++l)
    for (int m = -l; m <= l; ++m) {
      const int n = std::abs(m);
      const Real norm = std::sqrt(Real(2 * l + 1) / (Real(4) * kPi) * factorial(l - n) / factorial(l + n));
      const Real turn = m == 0  ? Real(1)
                        : m > 0 ? std::sqrt(Real(2)) * std::cos(Real(n) * phi)
                                : std::sqrt(Real(2)) * std::sin(Real(n) * phi);
      basis.push_back(norm * associatedLegendre(l, n, z) * turn);
    }
  return basis;
}

Real valueAt(const Vector& function, const Direction& direction) {
  const Vector basis = evaluate(static_cast<int>(std::lround(std::sqrt(double(function.size())))), direction);
  Real sum = 0;
  for (std::size_t i = 0; i < basis.size(); ++i) sum += function[i] * basis[i];
  return sum;
}

Vector project(int order, const Function& function, int rings) {
  const GaussLegendre<Real> rule(rings);
  const int columns = 2 * rings;
  Vector sum(static_cast<std::size_t>(order * order));
  for (std::size_t ring = 0; ring < rule.nodes.size(); ++ring)
    for (int column = 0; column < columns; ++column) {
      const Real z = rule.nodes[ring], radius = std::sqrt(Real(1) - z * z);
      const Real phi = Real(2) * kPi * (Real(column) + Real(0.5)) / Real(columns);
      const Direction direction = {radius * std::cos(phi), radius * std::sin(phi), z};
      const Real weighted = function(direction) * rule.weights[ring] * Real(2) * kPi / Real(columns);
      const Vector basis = evaluate(order, direction);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weighted * basis[i];
    }
  return sum;
}

Real integrate(const Function& function, int rings) {
  return project(1, function, rings)[0] * std::sqrt(Real(4) * kPi);
}

Vector rotate(const glm::dmat3& matrix, const Vector& function) {
  const int order = static_cast<int>(std::lround(std::sqrt(double(function.size()))));
  return project(
      order,
      [&](const Direction& s) {
        Direction back{};
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            back[static_cast<std::size_t>(i)] += Real(matrix[i][j]) * s[static_cast<std::size_t>(j)];
        return valueAt(function, back);
      },
      8);
}

Vector product(int order, const Vector& f, const Vector& g) {
  return project(
      order, [&](const Direction& s) { return valueAt(f, s) * valueAt(g, s); }, 10);
}

Direction toDirection(const glm::vec3& direction) {
  return {direction.x, direction.y, direction.z};
}

}  // namespace gloam::sh::reference
