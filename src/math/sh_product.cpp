// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-6: products by the sparse tripling tensor, (f g)_i = sum of Gamma_ijk f_j g_k (Snyder 2006).
#include <algorithm>
#include <array>

#include "math/sh_check.h"
#include "math/sh_tables.h"

namespace gloam::sh {
namespace {

/// Calls visit(i, j, k, value) for all ordered non-zero (i, j, k) with i, j, k below the sizes given.
template <class Visit>
void forEachGamma(int size_i, int size_j, int size_k, const Visit& visit) {
  for (const tables::GammaTriple& triple : tables::gammaTriples(kMaxOrder)) {
    if (triple.k >= std::max({size_i, size_j, size_k})) break;  // sorted by k, the greatest index
    std::array<int, 3> p = {triple.i, triple.j, triple.k};
    do {
      if (p[0] < size_i && p[1] < size_j && p[2] < size_k) visit(p[0], p[1], p[2], triple.value);
    } while (std::next_permutation(p.begin(), p.end()));
  }
}

template <class T>
Coefficients<T> productOf(const Coefficients<T>& f, const Sh& g, int order) {
  if (order == 0) order = std::max(f.order, g.order);
  checkOrder(order);
  Coefficients<T> result(order);
  if (f.order == order && g.order == order) {
    const tables::ProductPlan& plan = tables::productPlan(order);
    const tables::ProductEntry* entry = plan.entries.data();
    for (const tables::ProductPair& pair : plan.pairs) {
      const T both = pair.j == pair.k ? f[pair.j] * g[pair.k] : f[pair.j] * g[pair.k] + f[pair.k] * g[pair.j];
      for (int e = 0; e < pair.count; ++e, ++entry) result.c[entry->i] += both * entry->gamma;
    }
    return result;
  }
  forEachGamma(result.size(), f.size(), g.size(),
               [&](int i, int j, int k, float value) { result[i] += f[j] * (g[k] * value); });
  return result;
}

}  // namespace

Sh product(const Sh& f, const Sh& g, int order) {
  return productOf(f, g, order);
}
ShRgb product(const ShRgb& f, const Sh& g, int order) {
  return productOf(f, g, order);
}

Sh square(const Sh& f) {
  return productOf(f, f, f.order);
}

ShMatrix productMatrix(const Sh& f, int order_in, int order_out) {
  checkOrder(order_in);
  checkOrder(order_out);
  ShMatrix matrix;
  matrix.order_in = order_in;
  matrix.order_out = order_out;
  forEachGamma(coefficientCount(order_out), f.size(), coefficientCount(order_in),
               [&](int i, int j, int k, float value) { matrix.at(i, k) += f[j] * value; });
  return matrix;
}

Sh multiply(const ShMatrix& matrix, const Sh& function) {
  Sh result(matrix.order_out);
  const int columns = std::min(coefficientCount(matrix.order_in), function.size());
  for (int i = 0; i < result.size(); ++i)
    for (int k = 0; k < columns; ++k) result[i] += matrix.at(i, k) * function[k];
  return result;
}

float gamma(int i, int j, int k) {
  std::array<int, 3> key = {i, j, k};
  std::sort(key.begin(), key.end());
  if (key[0] < 0 || key[2] >= kMaxCoefficients)
    throw Error("spherical harmonics", "tripling coefficient (" + std::to_string(i) + ", " +
                                           std::to_string(j) + ", " + std::to_string(k) +
                                           "), expected indices 0 to 35");
  const auto triples = tables::gammaTriples(kMaxOrder);
  const auto rank = [](int a, int b, int c) { return (c * kMaxCoefficients + b) * kMaxCoefficients + a; };
  const int wanted = rank(key[0], key[1], key[2]);
  const auto found =
      std::lower_bound(triples.begin(), triples.end(), wanted,
                       [&](const tables::GammaTriple& t, int value) { return rank(t.i, t.j, t.k) < value; });
  return found != triples.end() && rank(found->i, found->j, found->k) == wanted ? found->value : 0.0f;
}

int gammaNonZeros(int order) {
  checkOrder(order);
  int count = 0;
  const int size = coefficientCount(order);
  forEachGamma(size, size, size, [&](int, int, int, float) { ++count; });
  return count;
}

}  // namespace gloam::sh
