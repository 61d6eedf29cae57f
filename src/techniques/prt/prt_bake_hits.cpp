// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Bounces (Sloan, Kautz, Snyder 2002, section 5; PRT-1): what the blocked directions of a point meet, and
//   M^b_i = sum over hits of max(0, n.s) ds (k_d / pi) M^{b-1}_q,i.
// Where rays have gone by way of m mirrors it is M^{b-1-m}; the sky, seen by way of b mirrors, adds y_i itself.
#include <gloam/sh.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_passes.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

}  // namespace

float directionWeight(float known, double seen, std::size_t tiles) {
  const float each = DirectionTables::solidAngle(tiles);
  return seen > 0.0 ? each * std::clamp(known / (each * float(seen)), 0.5f, 2.0f) : each;
}

void packHits(const std::vector<RawHit>& raw, std::vector<GatheredHit>& hits, PointHits& point) {
  float largest = 0.0f;
  for (const RawHit& hit : raw)
    largest = std::max(largest, std::max(hit.weight.x, std::max(hit.weight.y, hit.weight.z)));
  point.scale = largest / kHitSteps;
  const float steps = largest > 0.0f ? kHitSteps / largest : 0.0f;
  const auto quantised = [](float x, float by) {
    return std::uint16_t(std::clamp(x * by + 0.5f, 0.0f, kHitSteps));
  };
  for (const RawHit& hit : raw) {
    hits.push_back(
        {{hit.points.x, hit.points.y, hit.points.z},
         {quantised(hit.share.y, kHitSteps), quantised(hit.share.z, kHitSteps)},
         {quantised(hit.weight.x, steps), quantised(hit.weight.y, steps), quantised(hit.weight.z, steps)},
         std::uint16_t(hit.mirrors)});
  }
  point.end = std::uint32_t(hits.size());
}

// Who is hit sends its transfer on from the side that its normals look at. A back blocks and sends nothing: the transfer
// of a thin sheet's vertices says nothing of its other side.
void BakePasses::addHits(std::size_t point, const trace::RayPacket& rays, const trace::HitPacket& found,
                         std::size_t tile, std::uint32_t lanes, const float* cosines, PointWork& work) const {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int instance = found.instance[k], triangle = found.triangle[k];
    if (instance == trace::kNoHit) continue;
    const glm::vec3 s(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    const glm::vec3 normal(found.normal_x[k], found.normal_y[k], found.normal_z[k]);
    if (isBack(instance, triangle, glm::dot(s, normal))) continue;
    const Surface& surface = surfaces_[std::size_t(instance)];
    const float u = found.u[k], v = found.v[k];
    const glm::vec3 albedo =
        surface.uniform ? surface.albedo : trace::diffuseAlbedo(scene_, *surface.mesh, {triangle, u, v});
    if (albedo != glm::vec3(0.0f)) {
      const auto& [sender, share] = sendersAt(instance, triangle, u, v);
      work.hits.push_back({sender, share, albedo * (cosines[k] / kPi), 0});
    }
    if (!surface.mirrors) continue;
    const Meeting at{instance, triangle, u, v, normal};
    const brdf::Lobes lobes = lobesAt(surface, triangle, u, v);
    if (!isFollowed(surface, lobes, 0)) continue;
    MirrorRay came{.ray = {.direction = s}, .cosine = cosines[k]};
    came.primary = std::uint32_t(tile) * kTileSize + std::uint32_t(k);
    reflect(point, came, at, lobes, work.onward);
  }
}

const std::uint16_t* BakePasses::blockedOf(std::size_t point, const BakeState& state, std::size_t first,
                                           std::size_t end, BounceSums& sums) const {
  const RaySite& site = state.sites[point];
  if (state.bounce_used.empty() || end <= site.tiles) return &state.blocked[point * state.bounce_tiles];
  thread_local std::vector<std::uint16_t> blocked;
  blocked.resize(state.bounce_tiles);  // in steps, bounces have all tiles: the numbers are the same
  const glm::mat3 turn = turnOf(point);
  for (const DirectionBatch& batch : tables_.batches) {
    if (batch.first_bounce == first && batch.end_bounce == end)
      sums.asked += traceBlocked(tracer_, tables_, batch, site.origin, points_.normals[point] * turn, turn,
                                 blocked.data());
  }
  return blocked.data();
}

// What the blocked directions of a point meet, of some of the bounce tiles.
void BakePasses::collectHits(std::size_t point, const BakeState& state, std::size_t first, std::size_t end,
                             PointWork& work) const {
  traceBounceRays(
      point, state, first, end, work.sums,
      [&](const trace::RayPacket& rays, const trace::HitPacket& found, std::int32_t tile, std::uint32_t lanes,
          const float* cosines) { addHits(point, rays, found, std::size_t(tile), lanes, cosines, work); });
  work.sums.followed += followMirrors(
      point, work.onward,
      [&](const MirrorRay& came, const Meeting& at, const glm::vec3& diffuse) {
        const glm::vec3 weight = came.throughput * diffuse * (came.cosine / kPi);
        if (weight == glm::vec3(0.0f)) return;
        const auto& [sender, share] = sendersAt(at.instance, at.triangle, at.u, at.v);
        work.hits.push_back({sender, share, weight, came.mirrors});
      },
      [&](const MirrorRay& came) { work.skies.push_back(skyHit(came)); });
}

// Weighs a point's hits, which stand for so many bounce tiles, and appends them to those of its block.
void BakePasses::packPoint(std::size_t point, const BakeState& state, std::size_t tiles, PointWork& work,
                           KeptHits& hits, std::size_t i) const {
  const float weight = directionWeight(state.sites[point].blocked_cosine, work.sums.cosine, tiles);
  for (RawHit& hit : work.hits) hit.weight *= weight;
  for (SkyHit& sky : work.skies) sky.cosine *= weight;
  packHits(work.hits, hits.hits, hits.points[i]);
  hits.skies.insert(hits.skies.end(), work.skies.begin(), work.skies.end());
  hits.points[i].sky_end = std::uint32_t(hits.skies.size());
}

namespace {

void addSkies(std::span<const SkyHit> skies, int pass, int order, std::size_t stride, float* row) {
  for (const SkyHit& sky : skies) {
    if (pass != kAllPasses && int(sky.mirrors) != pass) continue;
    const sh::Sh y = sh::evaluate(order, sky.direction);
    for (int color = 0; color < 3; ++color) {
      const float weight = sky.cosine * sky.throughput[color];
      for (int c = 0; c < y.size(); ++c) row[std::size_t(color) * stride + std::size_t(c)] += weight * y[c];
    }
  }
}

}  // namespace

void BakePasses::gatherPoint(std::size_t point, const KeptHits& hits, std::size_t i, BakeState& state) const {
  float* row = &state.next[point * state.row];
  std::fill_n(row, state.row, 0.0f);
  const std::size_t first = hits.begin(i);
  gatherHits(sourcesOf(state), state.coefficients, {hits.hits.data() + first, hits.points[i].end - first},
             hits.points[i].scale, row);
  addSkies(hits.skiesOf(i), state.pass, tables_.order, rowStride(state.coefficients), row);
}

// The same hits in the same order as the first bounce.
void BakePasses::bounceAgain(std::size_t point, const BakeState& state, PointWork& work) const {
  PointWork of_batch;
  for (const DirectionBatch& batch : tables_.batches) {
    if (batch.end_bounce > state.bounce_used[point]) break;
    of_batch.clear();
    collectHits(point, state, batch.first_bounce, batch.end_bounce, of_batch);
    work.add(of_batch);
  }
}

// How many bounce tiles a point uses: batch after batch is added until the transfer of the first bounce is known as well as
// the first pass is. All that comes by way of mirrors counts as the light that it begins with, whichever bounce brings it.
void BakePasses::bounceUntilKnown(std::size_t point, BakeState& state, PointWork& work) const {
  const RaySite& site = state.sites[point];
  const std::size_t stride = rowStride(state.coefficients);
  KeptHits batch_hits;
  PointWork of_batch;
  std::vector<float> before(state.row, 0.0f), here(state.row);
  double cosine_before = 0.0;
  float error = 0.0f;
  std::size_t used = 0;
  for (const DirectionBatch& batch : tables_.batches) {
    of_batch.clear();
    collectHits(point, state, batch.first_bounce, batch.end_bounce, of_batch);
    work.add(of_batch);
    batch_hits = {};
    packHits(of_batch.hits, batch_hits.hits, batch_hits.points[0]);
    std::ranges::fill(here, 0.0f);
    gatherHits(sourcesOfAll(state), state.coefficients, batch_hits.hits, batch_hits.points[0].scale,
               here.data());
    addSkies(of_batch.skies, kAllPasses, tables_.order, stride, here.data());
    const std::size_t count = batch.end_bounce - batch.first_bounce;
    if (used > 0) {
      const float a = directionWeight(site.blocked_cosine, cosine_before, used),
                  b = directionWeight(site.blocked_cosine, of_batch.sums.cosine, count);
      float worst = 0.0f;
      for (std::size_t color = 0; color < 3; ++color) {
        float squares = 0.0f;
        for (std::size_t c = 0; c < stride; ++c) {
          const float difference = a * before[color * stride + c] - b * here[color * stride + c];
          squares += difference * difference;
        }
        worst = std::max(worst, squares);
      }
      const float all = float(used + count);
      error = std::max(kSteepestFall * error,
                       std::sqrt(worst) / open_norm_ * std::sqrt(float(used) * float(count)) / all);
    }
    const bool first_batch = used == 0;
    used += count;
    cosine_before += of_batch.sums.cosine;
    for (std::size_t c = 0; c < state.row; ++c) before[c] += here[c];
    if (!first_batch && error <= settings_.error) break;
  }
  state.bounce_used[point] = std::uint32_t(used);
}

// Every bounce has the same hits: they are kept for the next one, as many as memory is granted for.
void BakePasses::keep(std::size_t block, const BakeState& state, KeptHits& fresh) {
  const std::size_t bytes = fresh.bytes();
  if (state.pass >= state.bounces || kept_bytes_.fetch_add(bytes) + bytes > settings_.kept_bytes) return;
  fresh.hits.shrink_to_fit();
  fresh.glossy_hits.shrink_to_fit();
  fresh.skies.shrink_to_fit();
  fresh.complete = true;
  kept_hits_[block] = std::move(fresh);
}

std::size_t BakePasses::bounceBlock(std::size_t block, BakeState& state) {
  if (!state.glossy.empty()) return glossyBounceBlock(block, state);
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  KeptHits fresh;
  PointWork work;
  const bool kept = kept_hits_[block].complete;
  std::size_t rays = 0;
  for (std::size_t i = 0; i < count && !kept; ++i) {
    const std::size_t point = begin + i;
    work.clear();
    std::size_t used = 1;
    if (state.sites[point].place != Place::kBuried) {
      if (state.bounce_used.empty()) {
        collectHits(point, state, 0, state.bounce_tiles, work);
      } else if (state.pass == 1) {
        bounceUntilKnown(point, state, work);
      } else {
        bounceAgain(point, state, work);
      }
      used = state.bounce_used.empty() ? state.bounce_tiles : state.bounce_used[point];
      rays += work.sums.rays + work.sums.followed + work.sums.asked;
    }
    packPoint(point, state, std::max<std::size_t>(1, used), work, fresh, i);
  }
  const KeptHits& use = kept ? kept_hits_[block] : fresh;
  for (std::size_t i = 0; i < count; ++i) gatherPoint(begin + i, use, i, state);
  if (!kept) keep(block, state, fresh);
  return rays;
}

}  // namespace gloam::prt
