// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-3: rotation, band by band (Pinchon, Hoggan 2007, in our basis). R = Rz(alpha) Ry(beta) Rz(gamma), and with J the
// exchange of y and z, Ry(beta) = J Rz(-beta) J. About z, (c_m, c_-m) turn by m times the angle; J is a constant sparse
// matrix. Near the identity alpha and gamma are each ill-determined; gamma is therefore read from Rz(-alpha) R, so that
// any alpha will do and the result stays exact.
#include <cmath>

#include "math/sh_check.h"
#include "math/sh_tables.h"

namespace gloam::sh {
namespace {

struct Angle {
  double cosine, sine;
};

Angle normalized(double cosine, double sine) {
  const double length = std::sqrt(cosine * cosine + sine * sine);
  if (!(length > 1e-30)) return {1.0, 0.0};
  return {cosine / length, sine / length};
}

template <class T>
using Band = std::array<T, 2 * kMaxOrder - 1>;

/// In place, band l turned about z by the angle whose multiples are given.
template <class T>
void turnAboutZ(int l, const std::array<float, kMaxOrder>& cosine, const std::array<float, kMaxOrder>& sine,
                float sign, Band<T>& band) {
  for (int m = 1; m <= l; ++m) {
    T &plus = band[static_cast<std::size_t>(l + m)], &minus = band[static_cast<std::size_t>(l - m)];
    const float c = cosine[static_cast<std::size_t>(m)], s = sign * sine[static_cast<std::size_t>(m)];
    const T turned = plus * c - minus * s;
    minus = plus * s + minus * c;
    plus = turned;
  }
}

template <class T>
Band<T> exchanged(int l, const Band<T>& band) {
  const tables::ExchangeBand& exchange = tables::kExchange[static_cast<std::size_t>(l)];
  const auto size = static_cast<std::size_t>(2 * l + 1);
  Band<T> result{};
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column)
      if (exchange[row][column] != 0.0f) result[row] += band[column] * exchange[row][column];
  return result;
}

template <class T>
Coefficients<T> rotated(const Rotation& rotation, const Coefficients<T>& function) {
  if (function.order > rotation.order)
    throw Error("spherical harmonics", "function of order " + std::to_string(function.order) +
                                           " under a rotation of order " + std::to_string(rotation.order));
  Coefficients<T> result(function.order);
  result[0] = function[0];
  for (int l = 1; l < function.order; ++l) {
    Band<T> band{};
    for (int i = 0; i <= 2 * l; ++i) band[static_cast<std::size_t>(i)] = function[index(l, i - l)];
    turnAboutZ(l, rotation.cosine[0], rotation.sine[0], 1.0f, band);
    band = exchanged(l, band);
    turnAboutZ(l, rotation.cosine[1], rotation.sine[1], -1.0f, band);
    band = exchanged(l, band);
    turnAboutZ(l, rotation.cosine[2], rotation.sine[2], 1.0f, band);
    const float sign = l % 2 != 0 ? rotation.odd_band_sign : 1.0f;
    for (int i = 0; i <= 2 * l; ++i) result[index(l, i - l)] = band[static_cast<std::size_t>(i)] * sign;
  }
  return result;
}

}  // namespace

Rotation makeRotation(int order, const glm::mat3& matrix) {
  checkOrder(order);
  Rotation rotation;
  rotation.order = order;
  rotation.odd_band_sign = glm::determinant(matrix) < 0.0f ? -1.0f : 1.0f;
  // An improper matrix is a rotation times -1, and y_lm(-s) = (-1)^l y_lm(s). glm: m[column][row].
  const glm::dmat3 m = glm::dmat3(matrix) * double(rotation.odd_band_sign);
  const Angle alpha = normalized(m[2][0], m[2][1]);
  const Angle beta = normalized(m[2][2], alpha.cosine * m[2][0] + alpha.sine * m[2][1]);
  const Angle gamma = normalized(alpha.cosine * m[1][1] - alpha.sine * m[1][0],
                                 alpha.cosine * m[0][1] - alpha.sine * m[0][0]);
  const std::array<Angle, 3> angles = {gamma, beta, alpha};
  for (std::size_t a = 0; a < angles.size(); ++a) {
    Angle multiple{1.0, 0.0};
    for (std::size_t k = 0; k < kMaxOrder; ++k) {
      rotation.cosine[a][k] = static_cast<float>(multiple.cosine);
      rotation.sine[a][k] = static_cast<float>(multiple.sine);
      multiple = {multiple.cosine * angles[a].cosine - multiple.sine * angles[a].sine,
                  multiple.sine * angles[a].cosine + multiple.cosine * angles[a].sine};
    }
  }
  return rotation;
}

Sh rotate(const Rotation& rotation, const Sh& function) {
  return rotated(rotation, function);
}
ShRgb rotate(const Rotation& rotation, const ShRgb& function) {
  return rotated(rotation, function);
}
Sh rotate(const glm::mat3& matrix, const Sh& function) {
  return rotated(makeRotation(function.order, matrix), function);
}
ShRgb rotate(const glm::mat3& matrix, const ShRgb& function) {
  return rotated(makeRotation(function.order, matrix), function);
}

}  // namespace gloam::sh
