// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4.2 and 5 (PRT-2, PRT-3): where matrices are baked, each bounce sends through both
// lobes of what is hit,
//   R_qj(-s) = k_d / pi DI_qj + k_s [G * column j of M_q] (mirror direction of -s about N_q),
// to the receiver's matrix, M_pij += (1 - V) y_i(s) R_qj ds, and to its vector, with max(0, N.s) for y_i. So diffuse
// transfer too has the light that glossy surfaces throw. What differs from the paper: the weights at a point are
// scaled so that the smaller set of directions stands for as much as the first pass found blocked (prt_bake_passes.cpp).
#include <gloam/sh.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_glossy_kernels.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

constexpr float kPi = 3.14159265f;

int bandOf(int i) {
  return int(std::sqrt(float(i) + 0.5f));
}

// Band factors of the lobe times the basis at its axis: how much of each row of a matrix it sends on.
void lobeWeights(int order, float exponent, const glm::vec3& axis, float* weights) {
  const sh::Sh y = sh::evaluate(order, axis);
  float factors[sh::kMaxOrder];
  for (int l = 0; l < order; ++l) factors[l] = brdf::phongBandFactor(l, exponent);
  for (int i = 0; i < y.size(); ++i) weights[i] = factors[bandOf(i)] * y[i];
}

}  // namespace

// Adds what a batch found blocked to the sums of all before it. Returns how much the two differ, of an open point's V.
float BakePasses::addVisibility(const DirectionBatch& batch, const std::uint16_t* blocked,
                                float* sums) const {
  const std::size_t first = std::size_t(batch.first), tiles = std::size_t(batch.end) - first;
  const std::size_t stride = glossy_->stride;
  float here[(sh::kMaxHighCoefficients + 15) / 16 * 16];
  sumBlocked(glossy_->basis.get() + first * kTileSize * stride, glossy_->tile_sums.get() + first * stride,
             stride, blocked + first, tiles, here);
  float squares = 0.0f;
  const int shown = glossy_->field_order * glossy_->field_order;
  for (int k = 0; k < shown && first > 0; ++k) {
    const float difference = here[k] / float(tiles) - sums[k] / float(first);
    squares += difference * difference;
  }
  for (std::size_t k = 0; k < stride; ++k) sums[k] += here[k];
  return std::sqrt(squares / (2.0f * kPi)) * 4.0f * kPi / float(kTileSize);
}

void BakePasses::writeVisibility(std::size_t point, const float* sums, BakeState& state) const {
  const GlossyState& glossy = state.glossy;
  const std::size_t count = glossy.layout.visibilityCount();
  float* visibility = &state.glossy.visibility[glossy.first_row[point] * count];
  sh::hemisphereHigh(glossy.layout.visibilityOrder(), points_.normals[point], {visibility, count});
  RaySite& site = state.sites[point];
  const float solid_angle = tables_.solidAngle(site.tiles);
  float blocked[sh::kMaxHighCoefficients];
  std::copy_n(sums, count, blocked);
  if (const auto* turn = coefficientTurn(point))
    turn->apply(glossy.layout.visibilityOrder(), sums, 1, blocked, 1);
  for (std::size_t k = 0; k < count; ++k) visibility[k] -= solid_angle * blocked[k];
  site.blocked_solid_angle = solid_angle * sums[0] * std::sqrt(4.0f * kPi);
}

// Adds what hits and skies send to a vector, and, where that is given, a matrix.
void BakePasses::sumGlossy(std::span<const GlossyHit> hits, std::span<const SkyHit> skies,
                           const GatherSources& sources, int sky_pass, const GlossyState& glossy,
                           float* vector, float* matrix) const {
  const GlossyLayout& layout = glossy.layout;
  const std::size_t vector_count = std::size_t(tables_.coefficients),
                    vector_stride = rowStride(tables_.coefficients);
  const std::size_t fields = std::size_t(layout.fieldCount()), lights = std::size_t(layout.lightCount());
  const OuterShape vector_shape{1, vector_count, vector_stride, vector_stride};
  const OuterShape matrix_shape{fields, lights, layout.columnStride(), layout.colorSize()};
  constexpr float kOne[1] = {1.0f};
  for (const GlossyHit& hit : hits) {
    LightRow light = {};
    const GatherSource& source = sources.by_mirrors[hit.mirrors];
    if (source.rows == nullptr) continue;
    const std::size_t row = source.grey ? vector_count : 3 * vector_stride;
    MatrixMix vectors{.rows = 1,
                      .columns = vector_count,
                      .stride = vector_stride,
                      .color_size = source.grey ? 0 : vector_stride};
    MatrixMix matrices{
        .rows = fields, .columns = lights, .stride = layout.columnStride(), .color_size = layout.colorSize()};
    const bool mirrors = hit.specular != glm::vec3(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      vectors.share[k] = matrices.share[k] = hit.share[k];
      vectors.matrix[k] = source.rows + hit.point[k] * row;
      if (mirrors)
        matrices.matrix[k] = &glossy.previous[glossy.first_row[hit.point[k]] * layout.matrixSize()];
    }
    addLobe(vectors, kOne, &hit.albedo.x, light);
    if (mirrors) {
      float weights[sh::kMaxCoefficients];
      lobeWeights(layout.field_order, shownExponent(layout.field_order, hit.exponent), hit.mirror, weights);
      addLobe(matrices, weights, &hit.specular.x, light);
    }
    addOuter(vector_shape, kOne, hit.cosine, light, vector);
    if (matrix != nullptr)
      addOuter(matrix_shape, glossy_->basisOf(hit.direction), hit.solid_angle, light, matrix);
  }
  for (const SkyHit& sky : skies) {
    if (sky_pass != kAllPasses && int(sky.mirrors) != sky_pass) continue;
    LightRow light = {};
    const sh::Sh y = sh::evaluate(tables_.order, sky.direction);
    for (int color = 0; color < 3; ++color) {
      for (int c = 0; c < y.size(); ++c) light.color[color][c] = sky.throughput[color] * y[c];
    }
    addOuter(vector_shape, kOne, sky.cosine, light, vector);
    if (matrix != nullptr)
      addOuter(matrix_shape, glossy_->basisOf(sky.primary), sky.solid_angle, light, matrix);
  }
}

// M^b of a point, matrix and vector, from M^{b-1} of what it hits.
void BakePasses::gatherGlossy(std::size_t point, std::span<const GlossyHit> hits,
                              std::span<const SkyHit> skies, BakeState& state) const {
  GlossyState& glossy = state.glossy;
  const GlossyLayout& layout = glossy.layout;
  const bool has_matrix = glossy.has(point);
  thread_local std::vector<float> matrix;
  float vector[3 * sh::kMaxCoefficients + kRowPadding] = {};
  if (has_matrix) matrix.assign(layout.matrixSize() + kRowPadding, 0.0f);
  sumGlossy(hits, skies, sourcesOf(state), state.pass, glossy, vector, has_matrix ? matrix.data() : nullptr);
  std::copy_n(vector, state.row, &state.next[point * state.row]);
  if (has_matrix) turnRows(point, matrix.data(), &glossy.next[glossy.first_row[point] * layout.matrixSize()]);
}

// Rows are of the point's own directions, whose axes are turned.
void BakePasses::turnRows(std::size_t point, const float* matrix, float* to) const {
  const GlossyLayout& layout = glossy_->layout;
  std::copy_n(matrix, layout.matrixSize(), to);
  const sh::HighRotation* turn = coefficientTurn(point);
  if (turn == nullptr) return;
  for (std::size_t color = 0; color < 3; ++color) {
    for (std::size_t j = 0; j < std::size_t(layout.lightCount()); ++j)
      turn->apply(layout.field_order, matrix + color * layout.colorSize() + j, layout.columnStride(),
                  to + color * layout.colorSize() + j, layout.columnStride());
  }
}

}  // namespace gloam::prt
