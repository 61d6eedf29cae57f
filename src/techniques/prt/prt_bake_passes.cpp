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
}  // namespace

BakePasses::BakePasses(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                       const trace::Tracer& tracer, const DirectionTables& tables, const GlossyTables* glossy)
    : scene_(scene), points_(points), tracer_(tracer), tables_(tables), glossy_(glossy) {
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const Material& material = scene.materials[std::size_t(mesh.material)];
    Surface surface{&mesh, material.double_sided};
    surface.uniform = !material.base_color_map && !material.metallic_roughness_map && mesh.colors.empty();
    if (surface.uniform && !mesh.indices.empty()) surface.albedo = trace::diffuseAlbedo(scene, mesh, {});
    surface.lobes =
        brdf::makeLobes(material.base_color, material.metallic, material.roughness, material.specular);
    if (glossy_ != nullptr) surface.glossy = glossy_->instances[surfaces_.size()] != 0;
    surfaces_.push_back(surface);
  }
  probes_ = sampling::fibonacciSphere(128);
  kept_hits_.resize((points.size() + kBlockSize - 1) / kBlockSize);
}

// The side of a triangle that a ray meets; the sign of direction . geometric normal tells it.
bool BakePasses::isBack(int instance, int triangle, float along_normal) const {
  const std::size_t t = points_.first_triangle[std::size_t(instance)] + std::size_t(triangle);
  return along_normal * float(points_.facing[t]) > 0.0f;
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

std::size_t BakePasses::shadowBlock(std::size_t block, BakeState& state) const {
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  const std::size_t tiles = std::size_t(tables_.tiles), coefficients = std::size_t(tables_.coefficients);
  std::vector<std::uint16_t> blocked(tiles * count);
  float sums[kBlockSize * sh::kMaxCoefficients];
  std::size_t rays = 0;
  for (std::size_t i = 0; i < count; ++i) {
    RaySite& site = state.sites[begin + i];
    site = {.origin = startAtVertex(begin + i)};
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
    if (state.glossy.has(point)) projectVisibility(point, &blocked[i * tiles], state);
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
void BakePasses::addHits(const trace::RayPacket& rays, const trace::HitPacket& found, std::uint32_t lanes,
                         const float* cosines, std::vector<GatheredHit>& hits) const {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int instance = found.instance[k], triangle = found.triangle[k];
    if (instance == trace::kNoHit) continue;
    const float along = rays.direction_x[k] * found.normal_x[k] + rays.direction_y[k] * found.normal_y[k] +
                        rays.direction_z[k] * found.normal_z[k];
    if (isBack(instance, triangle, along)) continue;
    const Surface& surface = surfaces_[std::size_t(instance)];
    const float u = found.u[k], v = found.v[k];
    const glm::vec3 albedo =
        surface.uniform ? surface.albedo : trace::diffuseAlbedo(scene_, *surface.mesh, {triangle, u, v});
    const glm::vec3 weight = albedo * (cosines[k] / kPi);
    const glm::uvec3& corner =
        points_.triangles[points_.first_triangle[std::size_t(instance)] + std::size_t(triangle)];
    hits.push_back({{corner.x, corner.y, corner.z}, {1.0f - u - v, u, v}, {weight.r, weight.g, weight.b}});
  }
}

// Appends what the blocked directions of a point meet, weighted. Returns the number of rays.
std::size_t BakePasses::traceHits(std::size_t point, const BakeState& state,
                                  std::vector<GatheredHit>& hits) const {
  const std::size_t first = hits.size();
  const BounceSums sums = traceBounceRays(
      point, state,
      [&](const trace::RayPacket& rays, const trace::HitPacket& found, std::int32_t, std::uint32_t lanes,
          const float* cosines) { addHits(rays, found, lanes, cosines, hits); });
  // The share of the hemisphere that these directions stand for is known better from the first pass.
  const float solid_angle = tables_.bounceSolidAngle();
  const float seen = float(sums.cosine) * solid_angle;
  const float scale = seen > 0.0f ? std::clamp(state.sites[point].blocked_cosine / seen, 0.5f, 2.0f) : 1.0f;
  for (std::size_t h = first; h < hits.size(); ++h) {
    for (float& weight : hits[h].weight) weight *= scale * solid_angle;
  }
  return sums.rays;
}

// Every bounce has the same hits: they are kept for the next one, as many as memory is granted for.
std::size_t BakePasses::bounceBlock(std::size_t block, BakeState& state) {
  if (!state.glossy.empty()) return glossyBounceBlock(block, state);
  const std::size_t begin = state.blockBegin(block), count = state.blockEnd(block) - begin;
  KeptHits fresh;
  const bool kept = kept_hits_[block].complete;
  std::size_t ray_count = 0;
  for (std::size_t i = 0; i < count && !kept; ++i) {
    if (state.sites[begin + i].place != Place::kBuried) ray_count += traceHits(begin + i, state, fresh.hits);
    fresh.end[i] = fresh.hits.size();
  }
  const KeptHits& use = kept ? kept_hits_[block] : fresh;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i > 0 ? use.end[i - 1] : 0;
    gatherHits(state.previous.data(), state.coefficients, {use.hits.data() + first, use.end[i] - first},
               &state.next[(begin + i) * state.row]);
  }
  const std::size_t bytes = fresh.hits.size() * sizeof(GatheredHit);
  if (!kept && state.pass < state.bounces && kept_bytes_.fetch_add(bytes) + bytes <= kKeptHitsBytes) {
    fresh.hits.shrink_to_fit();
    fresh.complete = true;
    kept_hits_[block] = std::move(fresh);
  }
  return ray_count;
}

}  // namespace gloam::prt
