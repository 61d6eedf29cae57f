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
  for (std::size_t k = 0; k < count; ++k) visibility[k] -= solid_angle * sums[k];
  site.blocked_solid_angle = solid_angle * sums[0] * std::sqrt(4.0f * kPi);
}

GlossyHit BakePasses::glossyHit(const MirrorRay& came, const Meeting& at, const glm::vec3& diffuse) const {
  const auto& [sender, share] = sendersAt(at.instance, at.triangle, at.u, at.v);
  return {.point = {sender.x, sender.y, sender.z},
          .share = {share.x, share.y, share.z},
          .direction = came.primary,
          .mirrors = came.mirrors,
          .cosine = came.cosine,
          .solid_angle = 1.0f,
          .albedo = came.throughput * glm::clamp(diffuse, 0.0f, 1.0f) / kPi,
          .specular = glm::vec3(0.0f),
          .exponent = 1.0f,
          .mirror = {}};
}

void BakePasses::addGlossyHits(std::size_t point, const trace::RayPacket& rays, const trace::HitPacket& found,
                               std::size_t tile, std::uint32_t lanes, const float* cosines,
                               std::vector<GlossyHit>& hits, std::vector<MirrorRay>& onward) const {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int instance = found.instance[k], triangle = found.triangle[k];
    if (instance == trace::kNoHit) continue;
    MirrorRay came{.ray = {.direction = {rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]}},
                   .cosine = cosines[k]};
    came.primary = std::uint32_t(tile) * kTileSize + std::uint32_t(k);
    const Meeting at{instance,
                     triangle,
                     found.u[k],
                     found.v[k],
                     {found.normal_x[k], found.normal_y[k], found.normal_z[k]}};
    if (isBack(instance, triangle, glm::dot(came.ray.direction, at.geometric_normal))) continue;
    const Surface& surface = surfaces_[std::size_t(instance)];
    const brdf::Lobes lobes = lobesAt(surface, triangle, at.u, at.v);
    GlossyHit hit = glossyHit(came, at, lobes.diffuse);
    if (isFollowed(surface, lobes, 0)) {
      reflect(point, came, at, lobes, onward);
      if (hit.albedo != glm::vec3(0.0f)) hits.push_back(hit);
      continue;
    }
    if (surface.glossy) {
      hit.specular = glm::clamp(lobes.specular, 0.0f, 1.0f);
      hit.exponent = lobes.exponent;
      hit.mirror = brdf::mirrorDirection(shadingNormal(at), -came.ray.direction);
    }
    hits.push_back(hit);
  }
}

// As collectHits and packPoint, with what both lobes need.
std::size_t BakePasses::traceGlossyHits(std::size_t point, const BakeState& state, KeptHits& hits) const {
  const std::size_t first = hits.glossy_hits.size(), first_sky = hits.skies.size();
  const std::size_t tiles = std::min<std::size_t>(state.bounce_tiles, state.sites[point].tiles);
  thread_local std::vector<MirrorRay> onward;
  BounceSums sums;
  traceBounceRays(point, state, 0, tiles, sums,
                  [&](const trace::RayPacket& rays, const trace::HitPacket& found, std::int32_t tile,
                      std::uint32_t lanes, const float* cosines) {
                    addGlossyHits(point, rays, found, std::size_t(tile), lanes, cosines, hits.glossy_hits,
                                  onward);
                  });
  sums.followed = followMirrors(
      point, onward,
      [&](const MirrorRay& came, const Meeting& at, const glm::vec3& diffuse) {
        if (diffuse != glm::vec3(0.0f)) hits.glossy_hits.push_back(glossyHit(came, at, diffuse));
      },
      [&](const MirrorRay& came) { hits.skies.push_back(skyHit(came)); });
  const float each = DirectionTables::solidAngle(tiles);
  const auto scaled = [&](float known, double seen) {
    return seen > 0.0 ? each * std::clamp(known / (each * float(seen)), 0.5f, 2.0f) : each;
  };
  const RaySite& site = state.sites[point];
  const float cosine_weight = scaled(site.blocked_cosine, sums.cosine);
  const float solid_angle = scaled(site.blocked_solid_angle, double(sums.rays));
  const auto weigh = [&](auto& hit) {
    hit.cosine *= cosine_weight;
    hit.solid_angle *= solid_angle;
  };
  std::for_each(hits.glossy_hits.begin() + std::ptrdiff_t(first), hits.glossy_hits.end(), weigh);
  std::for_each(hits.skies.begin() + std::ptrdiff_t(first_sky), hits.skies.end(), weigh);
  return sums.rays + sums.followed;
}

// M^b of a point, matrix and vector, from M^{b-1} of what it hits.
void BakePasses::gatherGlossy(std::size_t point, std::span<const GlossyHit> hits,
                              std::span<const SkyHit> skies, BakeState& state) const {
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
  const GatherSources sources = sourcesOf(state);
  for (const GlossyHit& hit : hits) {
    LightRow light = {};
    const GatherSource& source = sources.by_mirrors[hit.mirrors];
    if (source.rows == nullptr) continue;
    const std::size_t row = source.grey ? vector_count : state.row;
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
    if (has_matrix)
      addOuter(matrix_shape, glossy_->basisOf(hit.direction), hit.solid_angle, light, matrix.data());
  }
  for (const SkyHit& sky : skies) {
    if (int(sky.mirrors) != state.pass) continue;
    LightRow light = {};
    const sh::Sh y = sh::evaluate(tables_.order, sky.direction);
    for (int color = 0; color < 3; ++color) {
      for (int c = 0; c < y.size(); ++c) light.color[color][c] = sky.throughput[color] * y[c];
    }
    addOuter(vector_shape, kOne, sky.cosine, light, vector);
    if (has_matrix)
      addOuter(matrix_shape, glossy_->basisOf(sky.primary), sky.solid_angle, light, matrix.data());
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
    if (state.sites[begin + i].place != Place::kBuried) ray_count += traceGlossyHits(begin + i, state, fresh);
    fresh.points[i] = {.end = std::uint32_t(fresh.glossy_hits.size()),
                       .sky_end = std::uint32_t(fresh.skies.size())};
  }
  const KeptHits& use = kept ? kept_hits_[block] : fresh;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = use.begin(i);
    gatherGlossy(begin + i, {use.glossy_hits.data() + first, use.points[i].end - first}, use.skiesOf(i),
                 state);
  }
  if (!kept) keep(block, state, fresh);
  return ray_count;
}

}  // namespace gloam::prt
