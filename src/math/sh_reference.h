// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Slow, obvious twins of the spherical-harmonics routines, in long double: what the tests hold the fast ones against.
// The basis comes from its definition through associated Legendre functions and angles, everything else from
// quadrature that is exact for the polynomials concerned.
#pragma once

#include <gloam/sh.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace gloam::sh::reference {

using Real = long double;
using Direction = std::array<Real, 3>;
using Function = std::function<Real(const Direction&)>;
using Vector = std::vector<Real>;  ///< order^2 coefficients

Vector evaluate(int order, Direction direction);
Real valueAt(const Vector& function, const Direction& direction);
Real integrate(const Function& function, int rings = 16);
Vector project(int order, const Function& function, int rings = 16);
/// Re-projection of the function turned by an orthogonal matrix, proper or not: s -> f(R^T s).
Vector rotate(const glm::dmat3& matrix, const Vector& function);
Vector product(int order, const Vector& f, const Vector& g);

Direction toDirection(const glm::vec3& direction);
template <class Container>
Vector toVector(int order, const Container& floats) {
  return Vector(floats.begin(), floats.begin() + order * order);
}
/// Length of the difference over the length of `want`.
template <class Container>
double relativeError(const Container& got, const Vector& want) {
  Real difference = 0, length = 0;
  for (std::size_t i = 0; i < want.size(); ++i) {
    difference += (static_cast<Real>(got[i]) - want[i]) * (static_cast<Real>(got[i]) - want[i]);
    length += want[i] * want[i];
  }
  return static_cast<double>(std::sqrt(difference / length));
}

}  // namespace gloam::sh::reference
