// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 7: the radiance L_p = M_p L that arrives at a place p near an object, M_p interpolated
// in its grid.
#include "techniques/prt/prt_neighbourhood_field.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/sh_high_order.h"
#include "techniques/prt/prt_neighbourhood_shared.h"

namespace gloam::prt {

GridCorners cornersAt(const NeighbourhoodTransfer& grid, const glm::vec3& position) {
  const glm::vec3 last = glm::vec3(grid.size - 1);
  const glm::vec3 at = glm::clamp(grid.placeOf(position), glm::vec3(0.0f), last);
  const glm::ivec3 cell = glm::min(glm::ivec3(at), grid.size - 2);
  const glm::vec3 f = at - glm::vec3(cell);
  GridCorners corners;
  for (int c = 0; c < 8; ++c) {
    const glm::ivec3 step(c & 1, c >> 1 & 1, c >> 2), p = cell + step;
    corners.point[c] = grid.numberOf(p);
    const glm::vec3 w = glm::mix(1.0f - f, f, glm::vec3(step));
    corners.weight[c] = w.x * w.y * w.z;
  }
  return corners;
}

void visibilityAt(const NeighbourhoodTransfer& grid, const glm::vec3& position, std::span<float> visibility) {
  const GridCorners corners = cornersAt(grid, position);
  const std::size_t count = grid.visibilityCount();
  for (std::size_t k = 0; k < count; ++k) {
    float sum = 0.0f;
    for (int c = 0; c < 8; ++c) sum += corners.weight[c] * grid.visibility[corners.point[c] * count + k];
    visibility[k] = sum;
  }
}

float neighbourhoodShare(const NeighbourhoodTransfer& grid, const glm::vec3& position) {
  const glm::vec3 half = grid.half();
  const glm::vec3 in = (half - glm::abs(position - grid.centre)) / (kNeighbourhoodFade * half);
  const float share = glm::clamp(std::min({in.x, in.y, in.z}), 0.0f, 1.0f);
  return share * share * (3.0f - 2.0f * share);
}

NeighbourhoodField fieldAt(const NeighbourhoodTransfer& grid, const glm::vec3& position,
                           const sh::ShRgb& light) {
  const std::size_t count = grid.visibilityCount();
  std::vector<float> visibility(count);
  visibilityAt(grid, position, visibility);
  const sh::Tripling& tripling = sh::Tripling::of(grid.light_order, grid.field_order);
  std::vector<float> packed(std::size_t(tripling.shape().size()));
  tripling.expand(visibility, packed);
  const int rows = grid.field_order * grid.field_order, columns = grid.light_order * grid.light_order;
  NeighbourhoodField field{sh::ShRgb(grid.field_order), sh::ShRgb(grid.field_order)};
  const GridCorners corners = cornersAt(grid, position);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const glm::vec3 l = light.c[std::size_t(j)];
      field.direct.c[std::size_t(i)] += packed[std::size_t(tripling.shape().at(i, j))] * l;
      for (int c = 0; c < 8 && !grid.indirect.empty(); ++c) {
        const std::size_t at = 3 * (corners.point[c] * grid.matrixCount() +
                                    std::size_t(i) * std::size_t(columns) + std::size_t(j));
        field.thrown.c[std::size_t(i)] +=
            corners.weight[c] * l *
            glm::vec3(grid.indirect[at], grid.indirect[at + 1], grid.indirect[at + 2]);
      }
    }
  }
  return field;
}

glm::dvec2 irradianceDifference(int order, std::span<const float> truth, std::span<const float> other) {
  static const std::vector<glm::vec3> normals = sampling::fibonacciSphere(16);
  const sh::Tripling& tripling = sh::Tripling::of(order, order);
  std::vector<float> a(std::size_t(tripling.shape().size())), b(a.size());
  tripling.expand(truth, a);
  tripling.expand(other, b);
  const sh::Zh cosine = sh::clampedCosine(order);
  const int count = order * order;
  glm::dvec2 sum(0.0);
  for (const glm::vec3& n : normals) {
    const sh::Sh lobe = sh::rotateZonal(cosine, n);
    for (int j = 0; j < count; ++j) {
      double is = 0.0, seems = 0.0;
      for (int i = 0; i < count; ++i) {
        const std::size_t at = std::size_t(tripling.shape().at(i, j));
        is += double(lobe[i]) * double(a[at]);
        seems += double(lobe[i]) * double(b[at]);
      }
      const double weight = 1.0 / std::pow(1.0 + std::floor(std::sqrt(double(j) + 0.5)), 2.0);
      sum += weight * glm::dvec2((is - seems) * (is - seems), is * is);
    }
  }
  return sum;
}

}  // namespace gloam::prt
