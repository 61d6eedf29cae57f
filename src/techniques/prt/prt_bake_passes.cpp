// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, equation 10 and section 5 (PRT-1, PRT-3). Two things differ, to the better:
// - DS is DU, which is exact, less the projection of what is blocked: M_i = A_l y_i(N) - sum over blocked directions. Points
//   that see all of the sky have no quadrature error at all.
// - Bounce weights at a point are scaled so that the hits of the smaller set stand for just as much cosine as the blocked
//   directions of the full one. What the sky does not send, surfaces do: a white furnace is 1, not 1 plus the error of two
//   sets after many bounces.
#include "techniques/prt/prt_bake_passes.h"

#include <gloam/sh.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;
constexpr int kProbes = 128;
// From where on a point is taken for one inside something. A wall that reaches through a floor made of one sheet sees the
// sheet's back over half its hemisphere; inside a closed box it is all of it. Backs of double-sided sheets are seen by any
// point behind a leaf, so there only being shut in counts.
constexpr float kBuriedBySheets = 1.0f / 3.0f;
constexpr float kBuriedByAll = 0.9f;
// A point is cramped where nearly all that it sees is nearer than half the spacing of its mesh: under the rounded edge of
// a box, say. Its darkness is real, but its mesh would spread it over whole cells.
constexpr float kCramped = 0.6f;
constexpr float kCrampedReach = 0.5f;

}  // namespace

struct BakePasses::Scratch {
  trace::RayPacket rays;
  trace::LaneMask mask;
  trace::HitPacket hits;
  std::vector<GatheredHit> gathered;
  std::size_t ray_count = 0;
};

BakePasses::BakePasses(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                       const trace::Tracer& tracer, const DirectionTables& tables)
    : scene_(scene), points_(points), tracer_(tracer), tables_(tables) {
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const Material& material = scene.materials[std::size_t(mesh.material)];
    Surface surface{&mesh, material.double_sided};
    surface.uniform = !material.base_color_map && !material.metallic_roughness_map && mesh.colors.empty();
    if (surface.uniform && !mesh.indices.empty()) surface.albedo = trace::diffuseAlbedo(scene, mesh, {});
    surfaces_.push_back(surface);
  }
  probes_ = sampling::fibonacciSphere(kProbes);
}

// The side of a triangle that a ray meets; the sign of direction . geometric normal tells it.
bool BakePasses::isBack(int instance, int triangle, float along_normal) const {
  const std::size_t t = points_.first_triangle[std::size_t(instance)] + std::size_t(triangle);
  return along_normal * float(points_.facing[t]) > 0.0f;
}

Place BakePasses::placeOf(const glm::vec3& origin, const glm::vec3& normal, float reach) const {
  float total = 0.0f, near = 0.0f, backs = 0.0f, sheet_backs = 0.0f;
  for (const glm::vec3& direction : probes_) {
    const float cosine = glm::dot(direction, normal);
    if (cosine <= 0.0f) continue;
    total += cosine;
    const trace::Hit hit = tracer_.closest({origin, direction});
    if (!hit) continue;
    if (hit.distance < reach) near += cosine;
    if (!isBack(hit.instance, hit.triangle, glm::dot(direction, hit.geometric_normal))) continue;
    backs += cosine;
    if (!surfaces_[std::size_t(hit.instance)].double_sided) sheet_backs += cosine;
  }
  if (sheet_backs > kBuriedBySheets * total || backs > kBuriedByAll * total) return Place::kBuried;
  return near > kCramped * total ? Place::kCramped : Place::kOpen;
}

// Looks for an open place on the faces around a point that is not, the nearest first. Returns whether the site was moved.
bool BakePasses::findBetterPlace(std::size_t point, RaySite& site) const {
  constexpr std::size_t kMostFaces = 12;
  const glm::vec3& normal = points_.normals[point];
  const float reach = kCrampedReach * meshSpacing(points_, point);
  site.place = placeOf(site.origin, normal, reach);
  if (site.place == Place::kOpen) return false;
  const auto faces = points_.facesOf(point);
  for (const float share : {0.05f, 0.2f, 0.5f, 0.8f}) {
    for (std::size_t f = 0; f < std::min(kMostFaces, faces.size()); ++f) {
      const glm::vec3 origin = rayOriginOnFace(points_, point, faces[f], share);
      if (placeOf(origin, normal, reach) != Place::kOpen) continue;
      site = {.origin = origin, .place = Place::kOpen};
      return true;
    }
  }
  return false;
}

// Projects what four neighbouring points of a block found.
void BakePasses::projectPoints(std::size_t begin, std::size_t count, const std::uint16_t* blocked,
                               float* sums) const {
  const std::size_t tiles = std::size_t(tables_.tiles);
  glm::vec3 normals[kProjectedTogether];
  const std::uint16_t* bits[kProjectedTogether];
  float unused[sh::kMaxCoefficients];
  float* out[kProjectedTogether];
  for (std::size_t k = 0; k < kProjectedTogether; ++k) {
    const std::size_t i = std::min(k, count - 1);  // a block that ends early repeats its last point
    normals[k] = points_.normals[begin + i];
    bits[k] = blocked + i * tiles;
    out[k] = k < count ? sums + k * sh::kMaxCoefficients : unused;
  }
  projectBlocked(tables_, normals, bits, out);
}

// A point that is inside something, or in a nook too small for its mesh, gets another place to look from.
std::size_t BakePasses::digOut(std::size_t point, RaySite& site, std::uint16_t* blocked, float* sums) const {
  // Such points have much of the hemisphere blocked; the others are spared the question.
  if (site.blocked_cosine <= kBuriedBySheets * kPi || !findBetterPlace(point, site)) return 0;
  const std::size_t rays = traceBlocked(tracer_, tables_, site.origin, points_.normals[point], blocked);
  projectPoints(point, 1, blocked, sums);
  return rays;
}

std::size_t BakePasses::shadowBlock(std::size_t block, BakeState& state) const {
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  const std::size_t tiles = std::size_t(tables_.tiles), coefficients = std::size_t(tables_.coefficients);
  std::vector<std::uint16_t> blocked(tiles * count);
  float sums[kBlockSize * sh::kMaxCoefficients];
  std::size_t rays = 0;
  for (std::size_t i = 0; i < count; ++i) {
    RaySite& site = state.sites[begin + i];
    site = {rayOrigin(points_, begin + i)};
    rays += traceBlocked(tracer_, tables_, site.origin, points_.normals[begin + i], &blocked[i * tiles]);
  }
  for (std::size_t i = 0; i < count; i += kProjectedTogether) {
    projectPoints(begin + i, count - i, &blocked[i * tiles], &sums[i * sh::kMaxCoefficients]);
  }
  // y_0 is a constant: its coefficient holds the blocked cosine.
  const float solid_angle = tables_.solidAngle(), cosine_from_y0 = solid_angle * std::sqrt(4.0f * kPi);
  const sh::Zh cosine = sh::clampedCosine(tables_.order);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t point = begin + i;
    float* sum = &sums[i * sh::kMaxCoefficients];
    RaySite& site = state.sites[point];
    site.blocked_cosine = cosine_from_y0 * sum[0];
    rays += digOut(point, site, &blocked[i * tiles], sum);
    site.blocked_cosine = cosine_from_y0 * sum[0];
    const sh::Sh unshadowed = sh::rotateZonal(cosine, points_.normals[point]);
    float* direct = &state.direct[point * coefficients];
    for (std::size_t c = 0; c < coefficients; ++c) direct[c] = unshadowed[int(c)] - solid_angle * sum[c];
    for (std::size_t t = 0; t < state.bounce_tiles; ++t) {
      state.blocked[point * state.bounce_tiles + t] =
          blocked[i * tiles + std::size_t(tables_.bounce_tile[t])];
    }
  }
  return rays;
}

// Who is hit sends its transfer on from the side that its normals look at. A back blocks and sends nothing: the transfer
// of a thin sheet's vertices says nothing of its other side.
void BakePasses::addHits(const trace::HitPacket& hits, std::uint32_t lanes, const float* cosines,
                         Scratch& scratch) const {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int instance = hits.instance[k], triangle = hits.triangle[k];
    if (instance == trace::kNoHit) continue;
    const trace::RayPacket& r = scratch.rays;
    const float along = r.direction_x[k] * hits.normal_x[k] + r.direction_y[k] * hits.normal_y[k] +
                        r.direction_z[k] * hits.normal_z[k];
    if (isBack(instance, triangle, along)) continue;
    const Surface& surface = surfaces_[std::size_t(instance)];
    const float u = hits.u[k], v = hits.v[k];
    const glm::vec3 albedo =
        surface.uniform ? surface.albedo : trace::diffuseAlbedo(scene_, *surface.mesh, {triangle, u, v});
    const glm::vec3 weight = albedo * (cosines[k] / kPi);
    const glm::uvec3& corner =
        points_.triangles[points_.first_triangle[std::size_t(instance)] + std::size_t(triangle)];
    scratch.gathered.push_back(
        {{corner.x, corner.y, corner.z}, {1.0f - u - v, u, v}, {weight.r, weight.g, weight.b}});
  }
}

void BakePasses::gatherPoint(std::size_t point, const BakeState& state, Scratch& scratch) const {
  const glm::vec3& normal = points_.normals[point];
  scratch.rays.setOrigin(state.sites[point].origin);
  scratch.gathered.clear();
  double cosine_sum = 0.0;
  for (std::size_t t = 0; t < state.bounce_tiles; ++t) {
    const std::uint32_t lanes = state.blocked[point * state.bounce_tiles + t];
    if (lanes == 0) continue;
    const float* directions = tables_.tileDirections(tables_.bounce_tile[t]);
    std::copy_n(directions, kTileSize, scratch.rays.direction_x);
    std::copy_n(directions + kTileSize, kTileSize, scratch.rays.direction_y);
    std::copy_n(directions + 2 * kTileSize, kTileSize, scratch.rays.direction_z);
    float cosines[kTileSize];
    for (int k = 0; k < kTileSize; ++k) {
      cosines[k] = std::max(0.0f, glm::dot(normal, tables_.direction(tables_.bounce_tile[t], k)));
      if (lanes >> k & 1u) cosine_sum += double(cosines[k]);
    }
    scratch.mask.set(lanes);
    scratch.ray_count += std::size_t(std::popcount(lanes));
    tracer_.closest(scratch.rays, scratch.mask, false,
                    scratch.hits);  // a fifth faster: tiles of the smaller set are wide
    addHits(scratch.hits, lanes, cosines, scratch);
  }
  // The share of the hemisphere that these directions stand for is known better from the first pass.
  const float solid_angle = tables_.bounceSolidAngle();
  const float found = float(cosine_sum) * solid_angle;
  const float scale = found > 0.0f ? std::clamp(state.sites[point].blocked_cosine / found, 0.5f, 2.0f) : 1.0f;
  for (GatheredHit& hit : scratch.gathered) {
    for (float& weight : hit.weight) weight *= scale * solid_angle;
  }
}

std::size_t BakePasses::bounceBlock(std::size_t block, BakeState& state) const {
  Scratch scratch;
  for (std::size_t point = state.blockBegin(block); point < state.blockEnd(block); ++point) {
    scratch.gathered.clear();
    if (state.sites[point].place != Place::kBuried) gatherPoint(point, state, scratch);
    gatherHits(state.previous.data(), state.coefficients, scratch.gathered, &state.next[point * state.row]);
  }
  return scratch.ray_count;
}

// Mean of the neighbours whose value was known before this ring; false where there are none.
bool BakePasses::fillFromNeighbours(std::uint32_t point, const std::vector<std::uint8_t>& known,
                                    std::size_t row, std::vector<float>& values) const {
  std::vector<double> sum(row, 0.0);
  int neighbours = 0;
  for (const std::uint32_t face : points_.facesOf(point)) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t q = points_.triangles[face][k];
      if (!known[q] || q == point) continue;
      ++neighbours;
      for (std::size_t i = 0; i < row; ++i) sum[i] += double(values[q * row + i]);
    }
  }
  for (std::size_t i = 0; i < row && neighbours > 0; ++i)
    values[point * row + i] = float(sum[i] / neighbours);
  return neighbours > 0;
}

// Ring by ring from the open. After the first ring what is cramped keeps its own: it lies in a gap that its mesh shows.
// Meshes that are buried as a whole keep what they have.
void BakePasses::fillHidden(const BakeState& state, std::size_t row, std::vector<float>& values) const {
  std::vector<std::uint8_t> known(state.points);
  std::vector<std::uint32_t> waiting, filled;
  for (std::size_t p = 0; p < state.points; ++p) {
    known[p] = state.sites[p].place == Place::kOpen;
    if (!known[p]) waiting.push_back(std::uint32_t(p));
  }
  for (bool first_ring = true; !waiting.empty(); first_ring = false) {
    std::vector<std::uint32_t> later;
    filled.clear();
    for (const std::uint32_t p : waiting) {
      const bool done = fillFromNeighbours(p, known, row, values);
      const bool stays = first_ring && state.sites[p].place == Place::kCramped;
      (done || stays ? filled : later).push_back(p);
    }
    if (filled.empty()) return;
    for (const std::uint32_t p : filled) known[p] = 1;
    waiting.swap(later);
  }
}

}  // namespace gloam::prt
