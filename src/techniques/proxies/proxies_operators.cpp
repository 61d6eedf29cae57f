// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007, "Image-based proxy accumulation for real-time soft global illumination":
// figures 4 and 5. Frobenius norms do not change when both sides are turned, so the proxy stands on +Z.
#include "techniques/proxies/proxies_operators.h"

#include <array>
#include <cmath>

#include "techniques/proxies/proxies_tables.h"

namespace gloam::proxies {

namespace {

using Matrix = std::array<std::array<double, 9>, 9>;  // [what is sent][light]

/// What light of three bands leaves an unshadowed white sphere with: each band by its factor of the cosine, over pi.
double leavingFactor(int l) {
  return double(sh::clampedCosineFactor(l)) / 3.14159265358979323846;
}

constexpr int bandOf(int i) {
  return i == 0 ? 0 : i < 4 ? 1 : 2;
}

Matrix exactMatrix(float sine) {
  const ExactOperator m = exactOperator(sine);
  Matrix matrix{};
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k)
      matrix[std::size_t(sh::index(j, 0))][std::size_t(sh::index(k, 0))] = double(m.m0[j][k]);
  }
  for (int j = 1; j < 3; ++j) {
    for (int k = 1; k < 3; ++k) {
      for (const int order : {-1, 1})
        matrix[std::size_t(sh::index(j, order))][std::size_t(sh::index(k, order))] =
            double(m.m1[j - 1][k - 1]);
    }
  }
  matrix[4][4] = matrix[8][8] = double(m.m2);
  return matrix;
}

/// The disc, of the radiance that a zonal function picks from the light.
Matrix discMatrix(float sine, const sh::Zh& picked) {
  const float angle = std::asin(std::min(1.0f, sine));
  const sh::Zh disc = sh::discZonal(kIndirectOrder, angle);
  const double solid_angle = double(disc[0]) * double(sh::zonalFactor(0));
  Matrix matrix{};
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k)
      matrix[std::size_t(sh::index(j, 0))][std::size_t(sh::index(k, 0))] =
          double(disc[j]) / solid_angle * double(picked[k]);
  }
  return matrix;
}

double distance(const Matrix& a, const Matrix& exact) {
  double wrong = 0.0, all = 0.0;
  for (std::size_t j = 0; j < 9; ++j) {
    for (std::size_t k = 0; k < 9; ++k) {
      const double factor = leavingFactor(bandOf(int(k)));
      wrong += std::pow((a[j][k] - exact[j][k]) * factor, 2), all += std::pow(exact[j][k] * factor, 2);
    }
  }
  return std::sqrt(wrong / all);
}

/// y_l0 at -Z: the sphere's normal in its middle, as the receiver sees it.
sh::Zh middleOfDisc() {
  sh::Zh zonal{.order = kIndirectOrder};
  const sh::Sh y = sh::evaluate(kIndirectOrder, {0.0f, 0.0f, -1.0f});
  for (int l = 0; l < kIndirectOrder; ++l) zonal[l] = y[sh::index(l, 0)];
  return zonal;
}

/// Turns +Z to `to`.
glm::mat3 frameAbout(const glm::vec3& to) {
  const glm::vec3 aside = std::abs(to.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(aside, to));
  return {x, glm::cross(to, x), to};
}

struct Sum {
  double wrong = 0.0;
  void add(const glm::vec3& got, const glm::vec3& want) {
    const glm::vec3 d = got - want;
    wrong += double(glm::dot(d, d));
  }
};

}  // namespace

std::vector<OperatorDistance> operatorDistances(int count) {
  std::vector<OperatorDistance> result;
  const sh::Zh middle = middleOfDisc();
  for (int i = 1; i <= count; ++i) {
    const float sine = float(i) / float(count);
    const Matrix exact = exactMatrix(sine);
    result.push_back({sine, distance(discMatrix(sine, averageOperatorFit(sine)), exact),
                      distance(discMatrix(sine, middle), exact)});
  }
  return result;
}

PlaneErrors planeErrors(const sh::ShRgb& light, float height, float width, int side) {
  const sh::ShRgb three = sh::truncated(light, kIndirectOrder);
  const sh::Zh middle = middleOfDisc();
  Sum averaged, point, all;
  for (int i = 0; i < side * side; ++i) {
    const float x = (float(i % side) + 0.5f) / float(side) - 0.5f,
                z = (float(i / side) + 0.5f) / float(side) - 0.5f;
    const glm::vec3 to_center(-x * width, height, -z * width);
    const float far = glm::length(to_center), sine = 1.0f / far;
    const glm::mat3 frame = frameAbout(to_center / far);
    const sh::ShRgb seen = sh::rotate(glm::transpose(frame), three);  // the proxy on +Z
    const sh::Sh normal = sh::evaluate(kIndirectOrder, glm::transpose(frame) * glm::vec3(0, 1, 0));
    const Matrix matrices[3] = {exactMatrix(sine), discMatrix(sine, averageOperatorFit(sine)),
                                discMatrix(sine, middle)};
    const double solid_angle =
        double(sh::discZonal(kIndirectOrder, std::asin(sine))[0]) * double(sh::zonalFactor(0));
    glm::vec3 irradiance[3] = {};
    for (int m = 0; m < 3; ++m) {
      for (int j = 0; j < 9; ++j) {
        for (int k = 0; k < 9; ++k) {
          const double factor =
              leavingFactor(bandOf(k)) * double(sh::clampedCosineFactor(bandOf(j))) * solid_angle;
          irradiance[m] += float(matrices[m][std::size_t(j)][std::size_t(k)] * factor) * normal[j] * seen[k];
        }
      }
    }
    averaged.add(irradiance[1], irradiance[0]);
    point.add(irradiance[2], irradiance[0]);
    all.add(irradiance[0], glm::vec3(0.0f));
  }
  return {averaged.wrong / all.wrong, point.wrong / all.wrong};
}

FitErrors fitErrors() {
  double wrong[3] = {}, all[3] = {};
  for (int i = 20; i <= 1000; ++i) {
    const float sine = float(i) / 1000.0f;
    const sh::Zh exact = averageOperator(sine), fit = averageOperatorFit(sine);
    for (int l = 1; l < 3; ++l) {
      wrong[l] += std::pow(double(fit[l]) - double(exact[l]), 2), all[l] += std::pow(double(exact[l]), 2);
    }
  }
  return {wrong[1] / all[1], wrong[2] / all[2]};
}

}  // namespace gloam::proxies
