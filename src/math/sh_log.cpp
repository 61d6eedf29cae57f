// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-7: log f = R^T diag(log t / (t - 1)) R (f - 1) with M_f = R^T diag(t) R (Ren et al. 2006). As M_f 1 = f, this is
// log(M_f) 1, so its inverse is exp(M_f) 1, SH-8 without approximation. The product matrix of a zonal function mixes
// coefficients of the same m alone; the block of m = 0 carries the function, all blocks the greatest eigenvalue.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "math/sh_check.h"
#include "math/sh_constants.h"
#include "math/sh_log_exp.h"

namespace gloam::sh {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Solver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

const double kSqrt4Pi = kShZonal0;  // rounded as in f, so that log 1 = 0

void checkClamp(float clamp) {
  if (!(clamp > 0.0f && clamp <= 1.0f))
    throw Error("spherical harmonics", fmt::format("clamp {}, expected more than 0, up to 1", clamp));
}

void checkGreatest(double greatest) {
  if (!(greatest > 0.0 && std::isfinite(greatest)))
    throw Error(
        "spherical harmonics",
        fmt::format("logarithm of a function whose greatest eigenvalue is {:.3g}, expected a positive "
                    "number",
                    greatest));
}

void checkFinite(std::span<const float> coefficients) {
  for (const float value : coefficients)
    if (!std::isfinite(value))
      throw Error("spherical harmonics", "logarithm or exponential of a coefficient that is not finite");
}

/// log t / (t - 1), 1 at t = 1.
double logSlope(double t) {
  const double d = t - 1.0;
  return std::abs(d) < 1e-8 ? 1.0 - 0.5 * d : std::log1p(d) / d;
}

/// R^T diag(log t / (t - 1)) R (f - 1).
VectorXd logBySlopes(const Solver& eigen, VectorXd f, double least) {
  f[0] -= kSqrt4Pi;
  VectorXd turned = eigen.eigenvectors().transpose() * f;
  for (Eigen::Index i = 0; i < turned.size(); ++i)
    turned[i] *= logSlope(std::max(eigen.eigenvalues()[i], least));
  return eigen.eigenvectors() * turned;
}

MatrixXd productMatrixOf(const Sh& f) {
  const ShMatrix matrix = productMatrix(f, f.order, f.order);
  MatrixXd result(f.size(), f.size());
  for (int i = 0; i < f.size(); ++i)
    for (int k = 0; k < f.size(); ++k) result(i, k) = matrix.at(i, k);
  return result;
}

Sh toSh(int order, const VectorXd& vector) {
  Sh result(order);
  for (int i = 0; i < result.size(); ++i) result[i] = static_cast<float>(vector[i]);
  return result;
}

/// The block of the zonal function's product matrix between coefficients (l, m) and (k, m).
MatrixXd zonalBlock(const Zh& f, int m) {
  const int size = f.order - m;
  MatrixXd block = MatrixXd::Zero(size, size);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column <= row; ++column) {
      for (int l = row - column; l < f.order; ++l)
        block(row, column) +=
            static_cast<double>(f[l]) * gamma(index(l, 0), index(row + m, m), index(column + m, m));
      block(column, row) = block(row, column);
    }
  return block;
}

}  // namespace

Sh logarithm(const Sh& f, float clamp) {
  checkOrder(f.order);
  checkClamp(clamp);
  checkFinite(f.coefficients());
  const Solver eigen(productMatrixOf(f));
  const double greatest = eigen.eigenvalues().maxCoeff();
  checkGreatest(greatest);
  VectorXd vector(f.size());
  for (int i = 0; i < f.size(); ++i) vector[i] = f[i];
  return toSh(f.order, logBySlopes(eigen, std::move(vector), static_cast<double>(clamp) * greatest));
}

Zh logarithmZonal(const Zh& f, float clamp) {
  checkOrder(f.order);
  checkClamp(clamp);
  checkFinite(f.c);
  const Solver eigen(zonalBlock(f, 0));
  double greatest = eigen.eigenvalues().maxCoeff();
  for (int m = 1; m < f.order; ++m)
    greatest = std::max(greatest, Solver(zonalBlock(f, m), Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
  checkGreatest(greatest);
  VectorXd vector(f.order);
  for (int l = 0; l < f.order; ++l) vector[l] = f[l];
  const VectorXd result = logBySlopes(eigen, std::move(vector), static_cast<double>(clamp) * greatest);
  Zh log{f.order, {}};
  for (int l = 0; l < f.order; ++l) log[l] = static_cast<float>(result[l]);
  return log;
}

Zh logBlocker(int order, float half_angle_rad, float clamp) {
  Zh visible = discZonal(order, half_angle_rad);
  for (float& value : visible.c) value = -value;
  visible[0] += static_cast<float>(kSqrt4Pi);
  if (!(visible[0] > 1e-3 * kSqrt4Pi))
    throw Error("spherical harmonics",
                fmt::format("logarithm of a blocker of {} rad, expected one that leaves a thousandth visible",
                            half_angle_rad));
  return logarithmZonal(visible, clamp);
}

float logBlockerCoordinate(float alpha) {
  const float a = std::clamp(alpha, 0.0f, 1.0f);
  return a / std::sqrt(1.0f + std::sqrt(1.0f - a * a));
}

float logBlockerAlpha(float coordinate) {
  // alpha = sin(theta) = 2 sin(theta / 2) cos(theta / 2).
  const float v = std::clamp(coordinate, 0.0f, 1.0f);
  return v * std::sqrt(2.0f - v * v);
}

LogBlockerTable makeLogBlockerTable(int order, int entries, float clamp) {
  checkOrder(order);
  if (entries < 2 || entries > 65536)
    throw Error("spherical harmonics", fmt::format("{} entries, expected 2 to 65536", entries));
  LogBlockerTable table{order, {}};
  for (int i = 0; i < entries; ++i) {
    const double v = static_cast<double>(i) / (entries - 1);
    table.entries.push_back(
        logBlocker(order, static_cast<float>(2.0 * std::asin(v / std::sqrt(2.0))), clamp));
  }
  return table;
}

Zh LogBlockerTable::at(float alpha) const {
  const float place = logBlockerCoordinate(alpha) * static_cast<float>(entries.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), entries.size() - 2);
  const float t = place - static_cast<float>(below);
  Zh zonal{order, {}};
  for (int l = 0; l < order; ++l)
    zonal[l] = entries[below][l] + t * (entries[below + 1][l] - entries[below][l]);
  return zonal;
}

Sh expNumeric(const Sh& f) {
  checkOrder(f.order);
  checkFinite(f.coefficients());
  const Solver eigen(productMatrixOf(f));
  VectorXd turned = eigen.eigenvectors().row(0).transpose() * kSqrt4Pi;
  for (Eigen::Index i = 0; i < turned.size(); ++i) turned[i] *= std::exp(eigen.eigenvalues()[i]);
  return toSh(f.order, eigen.eigenvectors() * turned);
}

}  // namespace gloam::sh
