// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What bounce rays meet where matrices are baked (Sloan, Kautz, Snyder 2002, section 5; PRT-2, PRT-3): as prt_bake_hits.cpp, with
// what both lobes of a surface need.
#include <algorithm>
#include <bit>
#include <cmath>

#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_glossy_kernels.h"

namespace gloam::prt {
namespace {

constexpr float kPi = 3.14159265f;

/// The norm of GS where nothing is blocked: of b^2 rows and a^2 columns half is left, as of the sphere.
float normOfOpenMatrix(const GlossyLayout& layout) {
  return std::sqrt(0.5f * float(std::min(layout.fieldCount(), layout.lightCount())));
}

/// Of three colours that stand end to end: |a first - b second|, the greatest.
float greatestDifference(const float weights[2], const float* first, const float* second, std::size_t size) {
  float worst = 0.0f;
  for (std::size_t color = 0; color < 3; ++color) {
    float squares = 0.0f;
    for (std::size_t c = color * size; c < (color + 1) * size; ++c) {
      const float difference = weights[0] * first[c] - weights[1] * second[c];
      squares += difference * difference;
    }
    worst = std::max(worst, squares);
  }
  return std::sqrt(worst);
}

}  // namespace

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

// As collectHits.
void BakePasses::collectGlossy(std::size_t point, const BakeState& state, std::size_t first, std::size_t end,
                               GlossyWork& work) const {
  traceBounceRays(point, state, first, end, work.sums,
                  [&](const trace::RayPacket& rays, const trace::HitPacket& found, std::int32_t tile,
                      std::uint32_t lanes, const float* cosines) {
                    addGlossyHits(point, rays, found, std::size_t(tile), lanes, cosines, work.hits,
                                  work.onward);
                  });
  work.sums.followed += followMirrors(
      point, work.onward,
      [&](const MirrorRay& came, const Meeting& at, const glm::vec3& diffuse) {
        if (diffuse != glm::vec3(0.0f)) work.hits.push_back(glossyHit(came, at, diffuse));
      },
      [&](const MirrorRay& came) { work.skies.push_back(skyHit(came)); });
}

// As packPoint.
void BakePasses::packGlossy(std::size_t point, const BakeState& state, std::size_t tiles, GlossyWork& work,
                            KeptHits& hits) const {
  const RaySite& site = state.sites[point];
  const float cosine_weight = directionWeight(site.blocked_cosine, work.sums.cosine, tiles);
  const float solid_angle = directionWeight(site.blocked_solid_angle, double(work.sums.rays), tiles);
  const auto weigh = [&](auto& hit) {
    hit.cosine *= cosine_weight;
    hit.solid_angle *= solid_angle;
  };
  std::ranges::for_each(work.hits, weigh);
  std::ranges::for_each(work.skies, weigh);
  hits.glossy_hits.insert(hits.glossy_hits.end(), work.hits.begin(), work.hits.end());
  hits.skies.insert(hits.skies.end(), work.skies.begin(), work.skies.end());
}

// As bounceUntilKnown, by the difference of vectors, and of matrices where the point has one.
void BakePasses::glossyUntilKnown(std::size_t point, BakeState& state, GlossyWork& work) const {
  const RaySite& site = state.sites[point];
  const GlossyLayout& layout = state.glossy.layout;
  const bool has_matrix = state.glossy.has(point);
  const std::size_t matrix_size = has_matrix ? layout.matrixSize() : 0;
  // A vector, then a matrix, each direction counting 1.
  std::vector<float> before(state.row + matrix_size, 0.0f), here(before.size() + 2 * kRowPadding);
  GlossyWork of_batch;
  double cosine_before = 0.0;
  std::size_t rays_before = 0, used = 0;
  float error = 0.0f;
  for (const DirectionBatch& batch : tables_.batches) {
    of_batch.clear();
    collectGlossy(point, state, batch.first_bounce, batch.end_bounce, of_batch);
    work.add(of_batch);
    std::ranges::fill(here, 0.0f);
    sumGlossy(of_batch.hits, of_batch.skies, sourcesOfAll(state), kAllPasses, state.glossy, here.data(),
              has_matrix ? here.data() + state.row : nullptr);
    const std::size_t count = batch.end_bounce - batch.first_bounce;
    if (used > 0) {
      const float cosine[2] = {directionWeight(site.blocked_cosine, cosine_before, used),
                               directionWeight(site.blocked_cosine, of_batch.sums.cosine, count)};
      const float angle[2] = {directionWeight(site.blocked_solid_angle, double(rays_before), used),
                              directionWeight(site.blocked_solid_angle, double(of_batch.sums.rays), count)};
      float differs = greatestDifference(cosine, before.data(), here.data(), state.row / 3) / open_norm_;
      if (has_matrix)
        differs = std::max(differs, greatestDifference(angle, before.data() + state.row,
                                                       here.data() + state.row, layout.colorSize()) /
                                        normOfOpenMatrix(layout));
      error = std::max(kSteepestFall * error,
                       differs * std::sqrt(float(used) * float(count)) / float(used + count));
    }
    const bool first_batch = used == 0;
    used += count;
    cosine_before += of_batch.sums.cosine;
    rays_before += of_batch.sums.rays;
    for (std::size_t c = 0; c < before.size(); ++c) before[c] += here[c];
    if (!first_batch && error <= settings_.error) break;
  }
  state.bounce_used[point] = std::uint32_t(used);
}

void BakePasses::collectGlossyOf(std::size_t point, BakeState& state, GlossyWork& work) const {
  if (state.bounce_used.empty()) return collectGlossy(point, state, 0, state.bounce_tiles, work);
  if (state.pass == 1) return glossyUntilKnown(point, state, work);
  GlossyWork of_batch;
  for (const DirectionBatch& batch : tables_.batches) {
    if (batch.end_bounce > state.bounce_used[point]) break;
    of_batch.clear();
    collectGlossy(point, state, batch.first_bounce, batch.end_bounce, of_batch);
    work.add(of_batch);
  }
}

std::size_t BakePasses::glossyBounceBlock(std::size_t block, BakeState& state) {
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  KeptHits fresh;
  GlossyWork work;
  const bool kept = kept_hits_[block].complete;
  std::size_t ray_count = 0;
  for (std::size_t i = 0; i < count && !kept; ++i) {
    const std::size_t point = begin + i;
    work.clear();
    if (state.sites[point].place != Place::kBuried) {
      collectGlossyOf(point, state, work);
      ray_count += work.sums.rays + work.sums.followed + work.sums.asked;
      const std::size_t used =
          state.bounce_used.empty() ? state.bounce_tiles : std::size_t(state.bounce_used[point]);
      packGlossy(point, state, std::max<std::size_t>(1, used), work, fresh);
    }
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
