// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spherical harmonics beyond six bands, for one purpose: visibility that is to be multiplied exactly (PRT-2). The product
// of y_i (of b bands) and y_j (of a bands) has a + b - 1 bands, so
//   M_ij = integral of V y_i y_j = sum over k of Gamma_ijk V_k,   k < (a + b - 1)^2,
// holds to rounding: (a + b - 1)^2 numbers, 81 at a = b = 5, are the whole matrix of 325 (its lower triangle). With V to
// fewer bands it is an approximation. Conventions as in gloam/sh.h.
#pragma once

#include <gloam/sh.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace gloam::sh {

inline constexpr int kMaxHighOrder = 2 * kMaxOrder - 1;
inline constexpr int kMaxHighCoefficients = kMaxHighOrder * kMaxHighOrder;

/// All basis functions of up to 11 bands at a unit vector: order^2 values. In doubles throughout.
void evaluateHigh(int order, const glm::dvec3& direction, std::span<double> values);

/// 1 on the side of the normal, 0 on the other: order^2 coefficients, exact.
void hemisphereHigh(int order, const glm::vec3& normal, std::span<float> coefficients);

/// Matrices of a bands in, b >= a bands out, that are symmetric as far as they are square: rows i < b^2, columns
/// j < a^2, and of these the ones with j <= i, row after row.
struct PackedMatrix {
  int light_order = 0, field_order = 0;
  int columns() const { return light_order * light_order; }
  int rows() const { return field_order * field_order; }
  int size() const { return columns() * (columns() + 1) / 2 + (rows() - columns()) * columns(); }
  int at(int i, int j) const {
    if (i >= columns()) return columns() * (columns() + 1) / 2 + (i - columns()) * columns() + j;
    return j <= i ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
  }
};

/// Gamma_ijk for i < b^2, j < a^2 and k < (a + b - 1)^2: the few that are not zero.
class Tripling {
 public:
  /// Made at the first call for a pair of orders, 1 <= light_order <= field_order <= 6 (else Error), and kept.
  static const Tripling& of(int light_order, int field_order);

  const PackedMatrix& shape() const { return shape_; }
  int visibilityOrder() const { return shape_.light_order + shape_.field_order - 1; }
  /// The matrix of a function of visibilityOrder() bands; of fewer where `visibility` is shorter, the rest being 0.
  void expand(std::span<const float> visibility, std::span<float> packed) const;
  /// P_ik = sum over j of Gamma_ijk L_j, k < `columns`: with one light and many V, M L = P V. Row after row.
  std::vector<glm::vec3> lightMatrix(std::span<const glm::vec3> light, int columns) const;

 private:
  Tripling(int light_order, int field_order);
  struct Entry {
    std::uint32_t k;
    float value;
  };
  PackedMatrix shape_;
  std::vector<std::uint32_t> first_;  ///< [packed element + 1], into entries_
  std::vector<Entry> entries_;        ///< k ascending within an element
};

/// A rotation for up to 11 bands, as blocks of numbers: (2l + 1)^2 a band. Turns vectors as sh::rotate does.
class HighRotation {
 public:
  /// `matrix` orthogonal, proper or not.
  HighRotation(int order, const glm::mat3& matrix);
  bool isIdentity() const { return identity_; }
  /// Element k of in and out at data[k * stride]; the first `order` bands.
  void apply(int order, const float* in, std::size_t in_stride, float* out, std::size_t out_stride) const;

 private:
  std::vector<float> blocks_;
  bool identity_ = false;
};

}  // namespace gloam::sh
