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
#include <limits>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_glossy_state.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;
float normOfOpenPoint(int order) {
  float sum = 0.0f;
  const sh::Sh open = sh::rotateZonal(sh::clampedCosine(order), {0.0f, 0.0f, 1.0f});
  for (int i = 0; i < open.size(); ++i) sum += open[i] * open[i];
  return std::sqrt(sum);
}

}  // namespace

/// What the points of a block have found so far; sums of coefficients, each direction counting 1.
struct BakePasses::ShadowWork {
  std::size_t begin, count;
  std::vector<std::uint16_t> blocked;  ///< [point][tile]
  float sums[kBlockSize][sh::kMaxCoefficients] = {};
  std::vector<float> visibility;   ///< [point][GlossyTables::stride]
  std::size_t active[kBlockSize];  ///< points of the block that take more directions
  std::size_t active_count;
};

BakePasses::BakePasses(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                       const trace::Tracer& tracer, const DirectionTables& tables,
                       const PassSettings& settings, const GlossyTables* glossy)
    : scene_(scene), points_(points), tracer_(tracer), tables_(tables), settings_(settings), glossy_(glossy) {
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const Material& material = scene.materials[std::size_t(mesh.material)];
    Surface surface{&mesh, material.double_sided};
    surface.uniform = !material.base_color_map && !material.metallic_roughness_map && mesh.colors.empty();
    if (surface.uniform && !mesh.indices.empty()) surface.albedo = trace::diffuseAlbedo(scene, mesh, {});
    surface.lobes =
        brdf::makeLobes(material.base_color, material.metallic, material.roughness, material.specular);
    if (glossy_ != nullptr) surface.glossy = glossy_->instances[surfaces_.size()] != 0;
    surface.mirrors = settings.caustics && greatestSpecular(scene, material) >= kShinySpecular;
    glm::vec3 least(std::numeric_limits<float>::max()), most(-least);
    const std::size_t first = points.first_triangle[surfaces_.size()];
    for (std::size_t t = first; t < first + mesh.triangleCount() && t < points.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        least = glm::min(least, points.positions[points.triangles[t][k]]);
        most = glm::max(most, points.positions[points.triangles[t][k]]);
      }
    diagonals_.push_back(glm::distance(least, most));
    surfaces_.push_back(surface);
  }
  if (settings.turned)
    turns_ = &Turns::of(std::max(tables.order, glossy ? glossy->layout.visibilityOrder() : 0));
  most_mirrors_ = std::uint32_t(std::min(settings.bounces, kMostMirrors));
  open_norm_ = normOfOpenPoint(tables.order);
  probes_ = sampling::fibonacciSphere(128);
  kept_hits_.resize((points.size() + kBlockSize - 1) / kBlockSize);
}

// The side of a triangle that a ray meets; the sign of direction . geometric normal tells it.
bool BakePasses::isBack(int instance, int triangle, float along_normal) const {
  const std::size_t t = points_.first_triangle[std::size_t(instance)] + std::size_t(triangle);
  return along_normal * float(points_.facing[t]) > 0.0f;
}

// Matrices are of vertices: where a surface has any, so is what it sends on.
TexelCorners BakePasses::sendersAt(int instance, int triangle, float u, float v) const {
  const std::size_t i = std::size_t(instance);
  if (points_.hasTexels(i) && !surfaces_[i].glossy)
    return texelsAt(points_.texel_maps[i], *surfaces_[i].mesh, triangle, u, v);
  return {points_.triangles[points_.first_triangle[i] + std::size_t(triangle)], {1.0f - u - v, u, v}};
}

// Projects what up to four points of a block found in a batch: sums[k * kMaxCoefficients] of the k-th of them. The block's
// bits begin with those of point `first`.
void BakePasses::projectPoints(const DirectionBatch& batch, std::span<const std::size_t> points,
                               std::size_t first, const std::uint16_t* blocked, float* sums) const {
  const std::size_t tiles = std::size_t(tables_.tiles);
  glm::vec3 normals[kProjectedTogether];
  const std::uint16_t* bits[kProjectedTogether];
  float unused[sh::kMaxCoefficients];
  float* out[kProjectedTogether];
  for (std::size_t k = 0; k < kProjectedTogether; ++k) {
    const std::size_t p = points[std::min(k, points.size() - 1)];  // fewer than four repeat the last
    normals[k] = points_.normals[p] * turnOf(p);
    bits[k] = blocked + (p - first) * tiles;
    out[k] = k < points.size() ? sums + k * sh::kMaxCoefficients : unused;
  }
  projectBlocked(tables_, batch, normals, bits, out);
}

// One batch for all points of the block that are not known well enough. The first decides where a point looks from.
std::size_t BakePasses::shadowBatch(const DirectionBatch& batch, BakeState& state, ShadowWork& work) const {
  const std::size_t tiles = std::size_t(tables_.tiles);
  const bool first_batch = batch.first == 0;
  const float before = float(batch.first), here = float(batch.end - batch.first), all = float(batch.end);
  std::size_t rays = 0, points[kBlockSize], still_active = 0;
  float sums[kBlockSize * sh::kMaxCoefficients];
  for (std::size_t a = 0; a < work.active_count; ++a) {
    const std::size_t i = work.active[a];
    points[a] = work.begin + i;
    const glm::mat3 turn = turnOf(points[a]);
    rays += traceBlocked(tracer_, tables_, batch, state.sites[points[a]].origin,
                         points_.normals[points[a]] * turn, turn, &work.blocked[i * tiles]);
  }
  for (std::size_t a = 0; a < work.active_count; a += kProjectedTogether) {
    const std::span<const std::size_t> together(
        points + a, std::min<std::size_t>(kProjectedTogether, work.active_count - a));
    projectPoints(batch, together, work.begin, work.blocked.data(), &sums[a * sh::kMaxCoefficients]);
  }
  for (std::size_t a = 0; a < work.active_count; ++a) {
    const std::size_t i = work.active[a];
    RaySite& site = state.sites[points[a]];
    float* sum = &sums[a * sh::kMaxCoefficients];
    if (first_batch) {
      // y_0 is a constant: its coefficient holds the blocked cosine.
      site.blocked_cosine = tables_.solidAngle(std::size_t(batch.end)) * std::sqrt(4.0f * kPi) * sum[0];
      rays += digOut(points[a], site, work.begin, work.blocked.data(), sum);
    }
    float error = 0.0f;
    if (!first_batch) {
      float squares = 0.0f;
      for (int c = 0; c < tables_.coefficients; ++c) {
        const float difference = sum[c] / here - work.sums[i][c] / before;
        squares += difference * difference;
      }
      error = std::sqrt(squares) * 4.0f * kPi / float(kTileSize) / open_norm_;
    }
    for (int c = 0; c < tables_.coefficients; ++c) work.sums[i][c] += sum[c];
    if (state.glossy.has(points[a])) {
      error = std::max(error,
                       addVisibility(batch, &work.blocked[i * tiles], &work.visibility[i * glossy_->stride]));
    }
    // Of two independent sets with a and b directions, both taken together.
    error *= std::sqrt(before * here) / all;
    if (!first_batch) site.error = std::max(error, kSteepestFall * site.error);
    site.tiles = std::uint32_t(batch.end);
    if (first_batch || site.error > settings_.error) work.active[still_active++] = i;
  }
  work.active_count = still_active;
  return rays;
}

void BakePasses::finishShadow(std::size_t point, const ShadowWork& work, std::size_t i,
                              BakeState& state) const {
  const std::size_t tiles = std::size_t(tables_.tiles), coefficients = std::size_t(tables_.coefficients);
  RaySite& site = state.sites[point];
  const float solid_angle = tables_.solidAngle(site.tiles);
  site.blocked_cosine = solid_angle * std::sqrt(4.0f * kPi) * work.sums[i][0];
  if (state.glossy.has(point)) writeVisibility(point, &work.visibility[i * glossy_->stride], state);
  const sh::Sh unshadowed = sh::rotateZonal(sh::clampedCosine(tables_.order), points_.normals[point]);
  float blocked[sh::kMaxCoefficients];
  std::copy_n(work.sums[i], coefficients, blocked);
  if (const auto* turn = coefficientTurn(point)) turn->apply(tables_.order, work.sums[i], 1, blocked, 1);
  float* direct = &state.direct[point * coefficients];
  for (std::size_t c = 0; c < coefficients; ++c) direct[c] = unshadowed[int(c)] - solid_angle * blocked[c];
  for (std::size_t t = 0; t < state.bounce_tiles; ++t) {
    state.blocked[point * state.bounce_tiles + t] =
        work.blocked[i * tiles + std::size_t(tables_.bounce_tile[t])];
  }
}

std::size_t BakePasses::shadowBlock(std::size_t block, BakeState& state) const {
  ShadowWork work;
  work.begin = state.blockBegin(block);
  work.count = work.active_count = state.blockEnd(block) - work.begin;
  work.blocked.resize(std::size_t(tables_.tiles) * work.count);
  if (!state.glossy.empty()) work.visibility.resize(glossy_->stride * work.count);
  for (std::size_t i = 0; i < work.count; ++i) {
    work.active[i] = i;
    state.sites[work.begin + i] = {.origin = startAtVertex(work.begin + i)};
  }
  std::size_t rays = 0;
  for (const DirectionBatch& batch : tables_.batches) {
    if (work.active_count > 0) rays += shadowBatch(batch, state, work);
  }
  for (std::size_t i = 0; i < work.count; ++i) finishShadow(work.begin + i, work, i, state);
  return rays;
}

// M^b has as many sources as there may be mirrors on the way: each is a bounce.
GatherSources BakePasses::sourcesOf(const BakeState& state) const {
  GatherSources sources;
  for (int mirrors = 0; mirrors < std::min(state.pass, kMostMirrors + 1); ++mirrors) {
    GatherSource& source = sources.by_mirrors[mirrors];
    if (mirrors == state.pass - 1) {
      source = {state.direct.data(), true};
    } else if (mirrors == 0) {
      source = {state.previous.data(), false};
    } else if (std::size_t(mirrors) <= state.earlier.size()) {
      source = {state.earlier[std::size_t(mirrors) - 1].data(), false};
    }
  }
  return sources;
}

// M^0 for all, however many mirrors are on the way.
GatherSources BakePasses::sourcesOfAll(const BakeState& state) const {
  GatherSources sources;
  for (GatherSource& source : sources.by_mirrors) source = {state.direct.data(), true};
  return sources;
}

}  // namespace gloam::prt
