// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-3, SH-6: integrals of products of basis functions, exact up to the rounding of doubles and usable at compile
// time. With y_lm = N_lm p_lm(z) sin^|m|(theta) Phi_m(phi), p_lm = d^m/dz^m P_l and Phi_m = sqrt 2 cos m phi, 1 or
// sqrt 2 sin |m| phi, they fall apart into one over phi (a sum rule) and one over z (of a polynomial).
#pragma once

#include <array>

namespace gloam::sh::exact {

inline constexpr double kPi = 3.14159265358979323846;

constexpr int absolute(int m) {
  return m < 0 ? -m : m;
}

constexpr double squareRoot(double value) {
  double root = value > 1.0 ? value : 1.0;
  for (double next = 0.5 * (root + value / root); next < root; next = 0.5 * (root + value / root))
    root = next;
  return root;
}

/// A polynomial in z, lowest coefficient first.
struct Polynomial {
  std::array<double, 16> c{};
  std::size_t degree = 0;
};

constexpr Polynomial times(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  product.degree = a.degree + b.degree;
  for (std::size_t i = 0; i <= a.degree; ++i) {
    if (a.c[i] == 0.0) continue;
    for (std::size_t j = 0; j <= b.degree; ++j) product.c[i + j] += a.c[i] * b.c[j];
  }
  return product;
}

constexpr double valueOf(const Polynomial& polynomial, double z) {
  double value = 0.0;
  for (std::size_t i = polynomial.degree + 1; i-- > 0;) value = value * z + polynomial.c[i];
  return value;
}

/// Legendre's P_l by Bonnet's recursion, then its m-th derivative, 0 <= m <= l.
constexpr Polynomial legendreDerivative(int l, int m) {
  Polynomial before{{1.0}, 0}, now{{0.0, 1.0}, 1};
  if (l == 0) now = before;
  for (int n = 1; n < l; ++n) {
    Polynomial next;
    next.degree = now.degree + 1;
    for (std::size_t i = 0; i <= next.degree; ++i)
      next.c[i] = ((i > 0 ? (2 * n + 1) * now.c[i - 1] : 0.0) - n * before.c[i]) / (n + 1);
    before = now;
    now = next;
  }
  for (int derivative = 0; derivative < m; ++derivative) {
    for (std::size_t i = 0; i < now.degree; ++i) now.c[i] = static_cast<double>(i + 1) * now.c[i + 1];
    now.c[now.degree--] = 0.0;
  }
  return now;
}

/// N_lm without the sqrt 2 that Phi carries.
constexpr double normalization(int l, int m) {
  double ratio = 1.0;  // (l - |m|)! / (l + |m|)!
  for (int i = l - absolute(m) + 1; i <= l + absolute(m); ++i) ratio /= i;
  return squareRoot((2 * l + 1) / (4.0 * kPi) * ratio);
}

/// Integral over a full turn of Phi_a Phi_b Phi_c.
constexpr double azimuthIntegral(int a, int b, int c) {
  const int sines = (a < 0) + (b < 0) + (c < 0);
  if (sines % 2 != 0) return 0.0;
  // Bring the odd one out (the only cosine among sines) to c; all-cosine triples need no order.
  if (sines == 2 && a >= 0) return azimuthIntegral(c, b, a);
  if (sines == 2 && b >= 0) return azimuthIntegral(a, c, b);
  const int p = absolute(a), q = absolute(b), r = absolute(c);
  double scale = 1.0;
  for (int m : {p, q, r})
    if (m > 0) scale *= squareRoot(2.0);
  const auto turn = [](int m) { return m == 0 ? 2.0 * kPi : 0.0; };  // integral of cos m phi
  const int s = sines == 2 ? -1 : 1;
  // cos p cos q = (cos(p - q) + cos(p + q)) / 2, sin p sin q = (cos(p - q) - cos(p + q)) / 2, times cos r.
  return scale * 0.25 * (turn(p - q - r) + turn(p - q + r) + s * turn(p + q - r) + s * turn(p + q + r));
}

/// N_lm p_lm(z) of one function, and its m.
struct PolarPart {
  Polynomial polynomial;
  int l = 0, m = 0;
};

constexpr PolarPart polarPart(int l, int m) {
  PolarPart part{legendreDerivative(l, absolute(m)), l, m};
  for (double& c : part.polynomial.c) c *= normalization(l, m);
  return part;
}

/// Integral of y_a y_b y_c over the sphere.
constexpr double tripleIntegral(const PolarPart& a, const PolarPart& b, const PolarPart& c) {
  if ((a.l + b.l + c.l) % 2 != 0 || c.l > a.l + b.l || a.l > b.l + c.l || b.l > a.l + c.l) return 0.0;
  const double azimuth = azimuthIntegral(a.m, b.m, c.m);
  if (azimuth == 0.0) return 0.0;
  Polynomial integrand = times(times(a.polynomial, b.polynomial), c.polynomial);
  // sin^(|ma| + |mb| + |mc|) theta is a power of 1 - z^2, for the sum rule makes the exponent even.
  const int power = (absolute(a.m) + absolute(b.m) + absolute(c.m)) / 2;
  for (int i = 0; i < power; ++i) integrand = times(integrand, Polynomial{{1.0, 0.0, -1.0}, 2});
  double polar = 0.0;
  for (std::size_t i = 0; i <= integrand.degree; i += 2)
    polar += integrand.c[i] * 2.0 / static_cast<double>(i + 1);
  return azimuth * polar;
}

/// y_lm as a sum of monomials x^a y^b z^c on the unit sphere.
struct Monomial {
  int a = 0, b = 0, c = 0;
  double factor = 0.0;
};
struct Monomials {
  std::array<Monomial, 9> terms{};
  int count = 0;
};

constexpr Monomials monomials(int l, int m) {
  Monomials sum;
  const Polynomial p = legendreDerivative(l, absolute(m));
  const int power = absolute(m);
  const double scale = normalization(l, m) * (m == 0 ? 1.0 : squareRoot(2.0));
  for (int c = 0; c <= l - power; ++c) {
    if (p.c[static_cast<std::size_t>(c)] == 0.0) continue;
    double binomial = 1.0;  // (x + i y)^power = sum of binomial x^(power - b) (i y)^b
    for (int b = 0; b <= power; ++b) {
      if ((b % 2 != 0) == (m < 0)) {
        const double sign = b % 4 < 2 ? 1.0 : -1.0;
        const double factor = scale * sign * binomial * p.c[static_cast<std::size_t>(c)];
        sum.terms[static_cast<std::size_t>(sum.count++)] = {power - b, b, c, factor};
      }
      binomial = binomial * (power - b) / (b + 1);
    }
  }
  return sum;
}

/// Integral of x^a y^b z^c over the sphere: 4 pi (a-1)!! (b-1)!! (c-1)!! / (a+b+c+1)!! for even a, b, c, else 0.
constexpr double monomialIntegral(int a, int b, int c) {
  if (a % 2 != 0 || b % 2 != 0 || c % 2 != 0) return 0.0;
  double value = 4.0 * kPi;
  for (int exponent : {a, b, c})
    for (int i = exponent - 1; i > 1; i -= 2) value *= i;
  for (int i = a + b + c + 1; i > 1; i -= 2) value /= i;
  return value;
}

/// Integral of y_lm(x, y, z) y_lm'(x, z, y): an entry of J, the matrix of the exchange of y and z.
constexpr double exchangeIntegral(int l, int m, int m_exchanged) {
  const Monomials f = monomials(l, m), g = monomials(l, m_exchanged);
  double sum = 0.0, magnitude = 0.0;
  for (int i = 0; i < f.count; ++i)
    for (int j = 0; j < g.count; ++j) {
      const Monomial &p = f.terms[static_cast<std::size_t>(i)], &q = g.terms[static_cast<std::size_t>(j)];
      const double term = p.factor * q.factor * monomialIntegral(p.a + q.a, p.b + q.c, p.c + q.b);
      sum += term;
      magnitude += term < 0.0 ? -term : term;
    }
  const double rounding = 1e-13 * magnitude;
  return sum < rounding && sum > -rounding ? 0.0 : sum;
}

}  // namespace gloam::sh::exact
