// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Real spherical harmonics, orders 1 to 6: the light, visibility and transfer that all techniques share.
//
// Conventions: orthonormal, no Condon-Shortley phase, y_1 = 0.488603 (y, z, x). Order n means n bands and n^2
// coefficients; coefficient (l, m) stands at l (l + 1) + m. The basis takes world x, y, z as they are.
// Directions are unit vectors. Every function that takes an order throws Error where it is not 1 to 6;
// results are relative to the vector's norm exact to 1e-5 (docs/sh.md has the measured figures). Shaders have
// the same functions in math/sh.glsl. One header, though long: it is the manual of the room.
#pragma once

#include <gloam/error.h>

#include <array>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <span>

namespace gloam::sh {

inline constexpr int kMaxOrder = 6;
inline constexpr int kMaxCoefficients = kMaxOrder * kMaxOrder;
constexpr int coefficientCount(int order) {
  return order * order;
}
constexpr int index(int l, int m) {
  return l * (l + 1) + m;
}

/// A function on the sphere: order^2 coefficients; those beyond are 0 and stay 0.
template <class T>
struct Coefficients {
  int order = 0;
  std::array<T, kMaxCoefficients> c{};

  Coefficients() = default;
  explicit Coefficients(int order_) : order(order_) {}
  int size() const { return coefficientCount(order); }
  T& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
  const T& operator[](int i) const { return c[static_cast<std::size_t>(i)]; }
  std::span<const T> coefficients() const { return {c.data(), static_cast<std::size_t>(size())}; }
  /// Sum; the order becomes the greater of the two.
  Coefficients& operator+=(const Coefficients& other) {
    order = order > other.order ? order : other.order;
    for (std::size_t i = 0; i < c.size(); ++i) c[i] += other.c[i];
    return *this;
  }
  Coefficients& operator*=(const T& factor) {
    for (T& value : c) value *= factor;
    return *this;
  }
};
using Sh = Coefficients<float>;
using ShRgb =
    Coefficients<glm::vec3>;  ///< std::array<glm::vec3, 36>: red, green and blue of a coefficient together

/// A function that depends on the angle from an axis alone: one coefficient a band, that of y_l0 about +Z.
struct Zh {
  int order = 0;
  std::array<float, kMaxOrder> c{};
  float& operator[](int l) { return c[static_cast<std::size_t>(l)]; }
  float operator[](int l) const { return c[static_cast<std::size_t>(l)]; }
};

ShRgb colored(const Sh& function, const glm::vec3& color);
Sh truncated(const Sh& function, int order);  ///< fewer bands, or more, which are 0
ShRgb truncated(const ShRgb& function, int order);
/// Integral of the product of two functions over the sphere, over the bands that both have.
float dot(const Sh& f, const Sh& g);
glm::vec3 dot(const ShRgb& f, const Sh& g);

// ---- SH-1: the basis ----

/// All basis functions at a direction.
Sh evaluate(int order, const glm::vec3& direction);
/// The function's value at a direction.
float valueAt(const Sh& function, const glm::vec3& direction);
glm::vec3 valueAt(const ShRgb& function, const glm::vec3& direction);

// ---- SH-2: projection ----

/// By quadrature with `rings` Gauss-Legendre rings of 2 rings points each: exact for polynomials of degree 2
/// rings - 1 - (order - 1).
Sh project(int order, const std::function<float(const glm::vec3&)>& function, int rings = 64);
ShRgb projectRgb(int order, const std::function<glm::vec3(const glm::vec3&)>& function, int rings = 64);
/// Light from one direction with irradiance 1 on a plane that faces it (a delta of integral 1).
Sh directionalLight(int order, const glm::vec3& direction);
/// Radiance 1 inside the cone of that half-angle (0 to pi, exact for all) about the axis, 0 outside.
Sh disc(int order, const glm::vec3& axis, float half_angle_rad);
Zh discZonal(int order, float half_angle_rad);
/// The same radiance everywhere.
ShRgb constantSky(int order, const glm::vec3& radiance);
/// Radiance linear in the sine of the elevation, apart in each half: nadir at -Y, horizon, zenith at +Y.
/// Exact.
ShRgb gradientSky(int order, const glm::vec3& zenith, const glm::vec3& horizon, const glm::vec3& nadir);
/// Of an equirectangular picture (rows from the top; u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2),
/// exact for texels of constant radiance. `texels` holds width * height values, else Error.
ShRgb projectEquirectangular(int order, std::span<const glm::vec3> texels, int width, int height);
/// Of a cube of 6 * size * size texels: faces +X -X +Y -Y +Z -Z, oriented as Vulkan and OpenGL do.
ShRgb projectCube(int order, std::span<const glm::vec3> texels, int size);
float equirectangularSolidAngle(int row, int width, int height);  ///< of one texel, in sr; all sum to 4 pi
float cubeSolidAngle(int column, int row, int size);              ///< of one texel, in sr; all sum to 4 pi
/// Direction through a point of a cube face, (u, v) in 0..1 from the face's first texel.
glm::vec3 cubeDirection(int face, float u, float v);

// ---- SH-3: rotation ----

/// A 3x3 orthogonal matrix, proper or not, made ready for SH. D(R) = Z(alpha) J Z(beta) J Z(gamma), J the
/// exchange of y and z: exact also near the identity.
struct Rotation {
  int order = 0;
  /// Cosine and sine of m times each angle (gamma, beta, alpha), m = 0 … 5; the sign of odd bands (-1:
  /// improper).
  std::array<std::array<float, kMaxOrder>, 3> cosine{}, sine{};
  float odd_band_sign = 1.0f;
};
Rotation makeRotation(int order, const glm::mat3& matrix);
/// The function turned by the matrix: rotate(R, f)(R s) = f(s).
Sh rotate(const Rotation& rotation, const Sh& function);
ShRgb rotate(const Rotation& rotation, const ShRgb& function);
Sh rotate(const glm::mat3& matrix, const Sh& function);
ShRgb rotate(const glm::mat3& matrix, const ShRgb& function);

// ---- SH-4, SH-5: zonal functions ----

/// The zonal function turned so that its axis is `axis`.
Sh rotateZonal(const Zh& zonal, const glm::vec3& axis);
/// sqrt(4 pi / (2 l + 1)): turns a zonal coefficient into the factor of its band in a convolution.
float zonalFactor(int l);
/// Convolution with a zonal kernel: result(n) = integral of f(s) kernel(angle between s and n) ds.
Sh convolve(const Sh& function, const Zh& kernel);
ShRgb convolve(const ShRgb& function, const Zh& kernel);
Zh clampedCosine(int order);       ///< max(0, cos)
float clampedCosineFactor(int l);  ///< A_l = pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0
/// Irradiance of a light on a plane with that normal: integral of L(s) max(0, n.s) ds.
glm::vec3 irradiance(const ShRgb& light, const glm::vec3& normal);

// ---- SH-6: products ----

/// Dense row-major matrix between coefficient vectors, order_out^2 rows and order_in^2 columns.
struct ShMatrix {
  int order_out = 0, order_in = 0;
  std::array<float, kMaxCoefficients * kMaxCoefficients> m{};
  float& at(int row, int column) { return m[static_cast<std::size_t>(row * order_in * order_in + column)]; }
  float at(int row, int column) const {
    return m[static_cast<std::size_t>(row * order_in * order_in + column)];
  }
};
/// Projection of the pointwise product: sum of Gamma_ijk f_j g_k. Orders may differ; `order` 0: that of the
/// greater.
Sh product(const Sh& f, const Sh& g, int order = 0);
ShRgb product(const ShRgb& f, const Sh& g, int order = 0);
Sh square(const Sh& f);
/// Matrix of the multiplication by f, from order_in to order_out.
ShMatrix productMatrix(const Sh& f, int order_in, int order_out);
Sh multiply(const ShMatrix& matrix, const Sh& function);
/// One entry of the tripling tensor, the integral of y_i y_j y_k.
float gamma(int i, int j, int k);
int gammaNonZeros(int order);  ///< 1, 10, 83, 353, 1158, 2907

// ---- SH-9: windowing ----

/// Band factors (1 + cos(pi l / width)) / 2, 0 from l = width on; width > 0, commonly order.
Sh windowHann(const Sh& function, float width);
ShRgb windowHann(const ShRgb& function, float width);
/// Band factors sin(pi l / width) / (pi l / width), 0 from l = width on.
Sh windowLanczos(const Sh& function, float width);
ShRgb windowLanczos(const ShRgb& function, float width);
/// Divides band l by 1 + lambda l^2 (l + 1)^2 with the least lambda that keeps the function non-negative
/// everywhere (one lambda for the three channels). A channel whose mean is not positive is beyond help and
/// counts for nothing.
Sh windowNonNegative(const Sh& function);
ShRgb windowNonNegative(const ShRgb& function);
/// Least value over the sphere, and where.
struct Minimum {
  float value = 0.0f;
  glm::vec3 direction{0.0f, 0.0f, 1.0f};
};
Minimum minimum(const Sh& function);

// ---- Batches (SIMD, chosen at run time) ----
//
// Layout: planes. Coefficient i of item k stands at data[i * stride + k], stride >= count; spans hold at
// least (order^2 - 1) * stride + count floats, else Error. No alignment is asked for. Output may not overlap
// input.

/// A stride for that many items at which planes start in different cache sets; powers of two are slower.
constexpr std::size_t planeStride(std::size_t count) {
  return (count + 15) / 16 * 16 + 16;
}

/// Basis functions of many directions, given as three arrays of the same length.
void evaluateMany(int order, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> out, std::size_t stride);
/// Item k turned by matrix k (builds and applies).
void rotateMany(int order, std::span<const glm::mat3> matrices, std::span<const float> in,
                std::span<float> out, std::size_t stride);
/// All `count` items turned by one rotation.
void rotateMany(const Rotation& rotation, std::size_t count, std::span<const float> in, std::span<float> out,
                std::size_t stride);
/// Item k of f times item k of g, all of one order.
void productMany(int order, std::size_t count, std::span<const float> f, std::span<const float> g,
                 std::span<float> out, std::size_t stride);

}  // namespace gloam::sh
