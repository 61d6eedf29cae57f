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

void BakePasses::projectVisibility(std::size_t point, const std::uint16_t* blocked, BakeState& state) const {
  const GlossyState& glossy = state.glossy;
  const std::size_t count = glossy.layout.visibilityCount();
  float sums[(sh::kMaxHighCoefficients + 15) / 16 * 16];
  sumBlocked(glossy_->basis.get(), glossy_->tile_sums.get(), glossy_->stride, blocked,
             std::size_t(tables_.tiles), sums);
  float* visibility = &state.glossy.visibility[glossy.first_row[point] * count];
  sh::hemisphereHigh(glossy.layout.visibilityOrder(), points_.normals[point], {visibility, count});
  const float solid_angle = tables_.solidAngle();
  for (std::size_t k = 0; k < count; ++k) visibility[k] -= solid_angle * sums[k];
  state.sites[point].blocked_solid_angle = solid_angle * sums[0] * std::sqrt(4.0f * kPi);
}

void BakePasses::addGlossyHits(const trace::RayPacket& rays, const trace::HitPacket& found, std::size_t tile,
                               std::uint32_t lanes, const float* cosines,
                               std::vector<GlossyHit>& hits) const {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int instance = found.instance[k], triangle = found.triangle[k];
    if (instance == trace::kNoHit) continue;
    const glm::vec3 s(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    const glm::vec3 geometric(found.normal_x[k], found.normal_y[k], found.normal_z[k]);
    if (isBack(instance, triangle, glm::dot(s, geometric))) continue;
    const Surface& surface = surfaces_[std::size_t(instance)];
    const float u = found.u[k], v = found.v[k];
    brdf::Lobes lobes = surface.lobes;
    if (!surface.uniform) {
      const trace::SurfacePoint at{triangle, u, v};
      const trace::MaterialPoint material = trace::materialAt(scene_, *surface.mesh, at, at);
      const float specular = scene_.materials[std::size_t(surface.mesh->material)].specular;
      lobes = brdf::makeLobes(material.base_color, material.metallic, material.roughness, specular);
    }
    const glm::uvec3& corner =
        points_.triangles[points_.first_triangle[std::size_t(instance)] + std::size_t(triangle)];
    GlossyHit hit{.point = {corner.x, corner.y, corner.z},
                  .share = {1.0f - u - v, u, v},
                  .direction = std::uint32_t(tile) * kTileSize + std::uint32_t(k),
                  .cosine = cosines[k],
                  .solid_angle = 1.0f,
                  .albedo = glm::clamp(lobes.diffuse, 0.0f, 1.0f) / kPi,
                  .specular = glm::vec3(0.0f),
                  .exponent = glossy_->exponent > 0.0f ? glossy_->exponent : lobes.exponent,
                  .mirror = {}};
    if (surface.glossy) hit.specular = glm::clamp(lobes.specular, 0.0f, 1.0f);
    const glm::vec3 sum = hit.share[0] * points_.normals[corner.x] +
                          hit.share[1] * points_.normals[corner.y] + hit.share[2] * points_.normals[corner.z];
    const float length = glm::length(sum);
    const glm::vec3 shading = length > 1.0e-6f ? sum / length : points_.normals[corner.x];
    hit.mirror = brdf::mirrorDirection(shading, -s);
    hits.push_back(hit);
  }
}

// As traceHits, with what both lobes need.
std::size_t BakePasses::traceGlossyHits(std::size_t point, const BakeState& state,
                                        std::vector<GlossyHit>& hits) const {
  const std::size_t first = hits.size();
  const BounceSums sums = traceBounceRays(
      point, state,
      [&](const trace::RayPacket& rays, const trace::HitPacket& found, std::int32_t tile, std::uint32_t lanes,
          const float* cosines) { addGlossyHits(rays, found, std::size_t(tile), lanes, cosines, hits); });
  const float each = tables_.bounceSolidAngle();
  const auto scaled = [&](float known, double seen) {
    return seen > 0.0 ? each * std::clamp(known / (each * float(seen)), 0.5f, 2.0f) : each;
  };
  const RaySite& site = state.sites[point];
  const float cosine_weight = scaled(site.blocked_cosine, sums.cosine);
  const float solid_angle = scaled(site.blocked_solid_angle, double(sums.rays));
  for (std::size_t h = first; h < hits.size(); ++h) {
    hits[h].cosine *= cosine_weight;
    hits[h].solid_angle *= solid_angle;
  }
  return sums.rays;
}

// M^b of a point, matrix and vector, from M^{b-1} of what it hits.
void BakePasses::gatherGlossy(std::size_t point, std::span<const GlossyHit> hits, BakeState& state) const {
  GlossyState& glossy = state.glossy;
  const GlossyLayout& layout = glossy.layout;
  const std::size_t vector_stride = rowStride(state.coefficients),
                    vector_count = std::size_t(state.coefficients);
  const std::size_t fields = std::size_t(layout.fieldCount()), lights = std::size_t(layout.lightCount());
  const OuterShape vector_shape{1, vector_count, vector_stride, vector_stride};
  const OuterShape matrix_shape{fields, lights, layout.columnStride(), layout.colorSize()};
  const bool has_matrix = glossy.has(point);
  thread_local std::vector<float> matrix;
  float vector[3 * sh::kMaxCoefficients + kRowPadding] = {};
  if (has_matrix) matrix.assign(layout.matrixSize() + kRowPadding, 0.0f);
  constexpr float kOne[1] = {1.0f};
  for (const GlossyHit& hit : hits) {
    LightRow light = {};
    MatrixMix vectors{
        .rows = 1, .columns = vector_count, .stride = vector_stride, .color_size = vector_stride};
    MatrixMix matrices{
        .rows = fields, .columns = lights, .stride = layout.columnStride(), .color_size = layout.colorSize()};
    const bool mirrors = hit.specular != glm::vec3(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      vectors.share[k] = matrices.share[k] = hit.share[k];
      vectors.matrix[k] = &state.previous[hit.point[k] * state.row];
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
    if (has_matrix)
      addOuter(matrix_shape, glossy_->basisOf(hit.direction), hit.solid_angle, light, matrix.data());
  }
  std::copy_n(vector, state.row, &state.next[point * state.row]);
  if (has_matrix)
    std::copy_n(matrix.data(), layout.matrixSize(),
                &glossy.next[glossy.first_row[point] * layout.matrixSize()]);
}

std::size_t BakePasses::glossyBounceBlock(std::size_t block, BakeState& state) {
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  KeptHits fresh;
  const bool kept = kept_hits_[block].complete;
  std::size_t ray_count = 0;
  for (std::size_t i = 0; i < count && !kept; ++i) {
    if (state.sites[begin + i].place != Place::kBuried)
      ray_count += traceGlossyHits(begin + i, state, fresh.glossy_hits);
    fresh.end[i] = fresh.glossy_hits.size();
  }
  const KeptHits& use = kept ? kept_hits_[block] : fresh;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i > 0 ? use.end[i - 1] : 0;
    gatherGlossy(begin + i, {use.glossy_hits.data() + first, use.end[i] - first}, state);
  }
  const std::size_t bytes = fresh.glossy_hits.size() * sizeof(GlossyHit);
  if (!kept && state.pass < state.bounces && kept_bytes_.fetch_add(bytes) + bytes <= kKeptHitsBytes) {
    fresh.glossy_hits.shrink_to_fit();
    fresh.complete = true;
    kept_hits_[block] = std::move(fresh);
  }
  return ray_count;
}

}  // namespace gloam::prt
