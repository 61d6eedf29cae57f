// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

namespace gloam {

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1]: exact for polynomials up to degree 2 count - 1.
template <class Real>
struct GaussLegendre {
  std::vector<Real> nodes, weights;

  explicit GaussLegendre(int count) {
    const Real pi = std::acos(Real(-1));
    for (int i = 0; i < count; ++i) {
      Real x = std::cos(pi * (Real(i) + Real(0.75)) / (Real(count) + Real(0.5)));
      Real slope = 1;
      for (int iteration = 0; iteration < 12; ++iteration) {  // Newton; quadratic from a close start
        Real before = 1, now = x;
        for (int n = 1; n < count; ++n) {
          const Real next = (Real(2 * n + 1) * x * now - Real(n) * before) / Real(n + 1);
          before = now;
          now = next;
        }
        slope = count == 1 ? Real(1) : Real(count) * (x * now - before) / (x * x - Real(1));
        x -= now / slope;
      }
      nodes.push_back(x);
      weights.push_back(Real(2) / ((Real(1) - x * x) * slope * slope));
    }
  }
};

}  // namespace gloam
