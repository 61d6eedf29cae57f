// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-1, SH-4, SH-5: the basis, zonal functions and convolution (Ramamoorthi, Hanrahan 2001; Sloan 2008).
#include <gloam/sh.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sh_basis.h"
#include "math/sh_check.h"
#include "math/sh_constants.h"

namespace gloam::sh {
namespace {

constexpr std::array<float, kMaxOrder> kZonal = {kShZonal0, kShZonal1, kShZonal2,
                                                 kShZonal3, kShZonal4, kShZonal5};
constexpr std::array<float, kMaxOrder> kCosine = {kShCosine0, kShCosine1, kShCosine2, 0.0f, kShCosine4, 0.0f};

void checkBand(int l) {
  if (l < 0 || l >= kMaxOrder)
    throw Error("spherical harmonics",
                "band " + std::to_string(l) + ", expected 0 to " + std::to_string(kMaxOrder - 1));
}

template <class T>
Coefficients<T> truncatedTo(const Coefficients<T>& function, int order) {
  checkOrder(order);
  Coefficients<T> result(order);
  const int size = std::min(result.size(), function.size());
  std::copy_n(function.c.begin(), size, result.c.begin());
  return result;
}

template <class T, class U>
T dotOf(const Coefficients<T>& f, const Coefficients<U>& g) {
  T sum(0.0f);
  const int size = std::min(f.size(), g.size());
  for (int i = 0; i < size; ++i) sum += f[i] * g[i];
  return sum;
}

template <class T>
Coefficients<T> convolved(const Coefficients<T>& function, const Zh& kernel) {
  Coefficients<T> result(std::min(function.order, kernel.order));
  for (int l = 0; l < result.order; ++l)
    for (int m = -l; m <= l; ++m) result[index(l, m)] = function[index(l, m)] * (zonalFactor(l) * kernel[l]);
  return result;
}

}  // namespace

ShRgb colored(const Sh& function, const glm::vec3& color) {
  ShRgb result(function.order);
  for (int i = 0; i < function.size(); ++i) result[i] = function[i] * color;
  return result;
}

Sh truncated(const Sh& function, int order) {
  return truncatedTo(function, order);
}
ShRgb truncated(const ShRgb& function, int order) {
  return truncatedTo(function, order);
}

float dot(const Sh& f, const Sh& g) {
  return dotOf(f, g);
}
glm::vec3 dot(const ShRgb& f, const Sh& g) {
  return dotOf(f, g);
}

Sh evaluate(int order, const glm::vec3& direction) {
  checkOrder(order);
  Sh basis(order);
  const float x = direction.x, y = direction.y, z = direction.z;
  switch (order) {
    case 1:
      GLOAM_SH_BASIS_1(basis, x, y, z) break;
    case 2:
      GLOAM_SH_BASIS_2(basis, x, y, z) break;
    case 3:
      GLOAM_SH_BASIS_3(basis, x, y, z) break;
    case 4:
      GLOAM_SH_BASIS_4(basis, x, y, z) break;
    case 5:
      GLOAM_SH_BASIS_5(basis, x, y, z) break;
    default:
      GLOAM_SH_BASIS_6(basis, x, y, z) break;
  }
  return basis;
}

float valueAt(const Sh& function, const glm::vec3& direction) {
  return dot(function, evaluate(function.order, direction));
}
glm::vec3 valueAt(const ShRgb& function, const glm::vec3& direction) {
  return dot(function, evaluate(function.order, direction));
}

Sh rotateZonal(const Zh& zonal, const glm::vec3& axis) {
  Sh result = evaluate(zonal.order, axis);
  for (int l = 0; l < zonal.order; ++l)
    for (int m = -l; m <= l; ++m) result[index(l, m)] *= zonalFactor(l) * zonal[l];
  return result;
}

float zonalFactor(int l) {
  checkBand(l);
  return kZonal[static_cast<std::size_t>(l)];
}

Sh convolve(const Sh& function, const Zh& kernel) {
  return convolved(function, kernel);
}
ShRgb convolve(const ShRgb& function, const Zh& kernel) {
  return convolved(function, kernel);
}

Zh clampedCosine(int order) {
  checkOrder(order);
  Zh zonal{order, {}};
  for (int l = 0; l < order; ++l) zonal[l] = clampedCosineFactor(l) / zonalFactor(l);
  return zonal;
}

float clampedCosineFactor(int l) {
  checkBand(l);
  return kCosine[static_cast<std::size_t>(l)];
}

glm::vec3 irradiance(const ShRgb& light, const glm::vec3& normal) {
  const Sh basis = evaluate(light.order, normal);
  glm::vec3 sum(0.0f);
  for (int l = 0; l < light.order; ++l) {
    glm::vec3 band(0.0f);
    for (int m = -l; m <= l; ++m) band += light[index(l, m)] * basis[index(l, m)];
    sum += clampedCosineFactor(l) * band;
  }
  return sum;
}

}  // namespace gloam::sh
