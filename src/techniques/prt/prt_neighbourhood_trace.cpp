// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 7: V_k = integral of V y_k over the sphere, which holds the matrix of what arrives of the
// distant light (math/sh_high_order.h), and what the object sends:
//   M_ij = integral of (1 - V(s)) y_i(s) R_qj(-s) ds,   R_qj = rho_q / pi DI_qj + k_s(q) R_q'j
// with q the point that the ray meets, DI its own diffuse transfer and R_q' what a mirror at q shows: the next surface,
// or y_j of the mirrored direction r times the band factors of q's Phong lobe. Differs from the paper, which runs its simulator
// over the grid's points with all other passes: here the object's transfer is baked already, and light is gathered from it.
#include "techniques/prt/prt_neighbourhood_trace.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/sampling.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_neighbourhood_state.h"
#include "trace/surface.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;
constexpr int kLongestChain = 8;        // mirrors one after the other
constexpr float kFaintest = 0.01f;      // share of mirrored light that is followed
constexpr float kInsideBlocked = 0.9f;  // of all directions, as seen from inside a closed object

glm::vec3 directionOf(const trace::RayPacket& rays, int k) {
  return {rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]};
}

trace::Hit hitOf(const trace::HitPacket& found, int k) {
  trace::Hit hit;
  hit.instance = found.instance[k];
  hit.triangle = found.triangle[k];
  hit.distance = found.distance[k];
  hit.u = found.u[k];
  hit.v = found.v[k];
  hit.geometric_normal = glm::normalize(glm::vec3(found.normal_x[k], found.normal_y[k], found.normal_z[k]));
  return hit;
}

void setDirections(trace::RayPacket& rays, const float* directions) {
  std::copy_n(directions, kTileSize, rays.direction_x);
  std::copy_n(directions + kTileSize, kTileSize, rays.direction_y);
  std::copy_n(directions + 2 * kTileSize, kTileSize, rays.direction_z);
}

}  // namespace

NeighbourhoodTracer::Directions NeighbourhoodTracer::directionsOf(const GlossyLayout& layout, int count,
                                                                  int bounce_count) {
  DirectionTables tables = makeDirectionTables(layout.light_order, count, bounce_count);
  GlossyTables basis(layout, tables);
  return {std::move(tables), std::move(basis)};
}

NeighbourhoodTracer::NeighbourhoodTracer(const Scene& scene, const NeighbourhoodObject& object,
                                         const NeighbourhoodOptions& options, const Progress& progress)
    : scene_(scene),
      object_(object),
      layout_{options.order, options.order},
      all_(
          directionsOf(layout_, options.directions, std::min(options.thrown_directions, options.directions))),
      few_(directionsOf(layout_, sampleDirections(options), sampleDirections(options))),
      tracer_(scene, object.posed, {.reproducible = true, .rigid_only = true}, progress),
      probes_(sampling::fibonacciSphere(128)) {
  if (!options.thrown) return;
  const std::size_t count = object.posed.instances.size();
  const bool baked =
      std::all_of(object.posed.instances.begin(), object.posed.instances.end(),
                  [&](const Instance& i) { return bool(scene.meshes[std::size_t(i.mesh)].transfer); });
  if (!baked) return;
  lit_.resize(count);
  for (std::size_t i = 0; i < count; ++i) light(i);
}

// Turns the transfer of an instance's points into these axes; columns beyond what it knows stay 0.
void NeighbourhoodTracer::light(std::size_t index) {
  const Instance& instance = object_.posed.instances[index];
  const Mesh& mesh = scene_.meshes[std::size_t(instance.mesh)];
  const Transfer& transfer = *mesh.transfer;
  Lit& lit = lit_[index];
  lit.mesh = &mesh;
  lit.texel_width = transfer.texel_width;
  lit.texel_height = transfer.texel_height;
  lit.uv_set = transfer.uv_set;
  bounces_ = std::max(bounces_, transfer.bounces + 1);
  const std::size_t coefficients = std::size_t(transfer.order * transfer.order),
                    stride = layout_.columnStride();
  const std::size_t points = transfer.direct.size() / coefficients;
  const std::size_t kept = std::min(coefficients, std::size_t(layout_.lightCount()));
  const auto rotation = sh::makeRotation(transfer.order, rotationFactor(instance.world_from_object));
  lit.rows.assign(points * 3 * stride + kRowPadding, 0.0f);
  for (std::size_t p = 0; p < points; ++p) {
    sh::ShRgb row(transfer.order);
    for (std::size_t i = 0; i < coefficients; ++i) {
      row.c[i] = glm::vec3(transfer.direct[p * coefficients + i]);
      if (transfer.indirect.empty()) continue;
      const float* indirect = &transfer.indirect[3 * (p * coefficients + i)];
      row.c[i] += glm::vec3(indirect[0], indirect[1], indirect[2]);
    }
    row = sh::rotate(rotation, row);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < kept; ++i) lit.rows[(3 * p + c) * stride + i] = row.c[i][int(c)];
    }
  }
  const glm::mat3 linear(instance.world_from_object), normal_matrix = normalTransform(linear);
  for (const glm::vec3& n : mesh.normals) lit.normals.push_back(glm::normalize(normal_matrix * n));
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t* v = &mesh.indices[t];
    glm::vec3 winding = glm::cross(linear * (mesh.positions[v[1]] - mesh.positions[v[0]]),
                                   linear * (mesh.positions[v[2]] - mesh.positions[v[0]]));
    if (glm::determinant(linear) < 0.0f) winding = -winding;
    const glm::vec3 shading = lit.normals[v[0]] + lit.normals[v[1]] + lit.normals[v[2]];
    lit.facing.push_back(glm::dot(winding, shading) < 0.0f ? -1 : 1);
  }
}

float NeighbourhoodTracer::visibility(const glm::vec3& place, std::vector<std::uint16_t>& blocked,
                                      float* visibility) const {
  return visibilityOf(all_, place, blocked, visibility);
}

float NeighbourhoodTracer::roughVisibility(const glm::vec3& place, float* visibility) const {
  thread_local std::vector<std::uint16_t> blocked;
  return visibilityOf(few_, place, blocked, visibility);
}

float NeighbourhoodTracer::visibilityOf(const Directions& set, const glm::vec3& place,
                                        std::vector<std::uint16_t>& blocked, float* visibility) const {
  const std::size_t tiles = std::size_t(set.tables.tiles), count = layout_.visibilityCount();
  blocked.assign(tiles, 0);
  trace::RayPacket rays;
  trace::LaneMask all;
  all.set(0xffffu);
  rays.setOrigin(place);
  std::size_t met = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    setDirections(rays, set.tables.tileDirections(int(t)));
    std::fill_n(rays.t_far, kTileSize, std::numeric_limits<float>::infinity());
    tracer_.occluded(rays, all, true);
    std::uint32_t bits = 0;
    for (int k = 0; k < kTileSize; ++k) bits |= (rays.t_far[k] < 0.0f ? 1u : 0u) << k;
    blocked[t] = std::uint16_t(bits);
    met += std::size_t(std::popcount(bits));
  }
  float sums[(sh::kMaxHighCoefficients + 15) / 16 * 16];
  sumBlocked(set.basis.basis.get(), set.basis.tile_sums.get(), set.basis.stride, blocked.data(), tiles, sums);
  const float solid_angle = sampling::TiledDirections::solidAngle(set.tables.tiles);
  for (std::size_t k = 0; k < count; ++k) visibility[k] = -solid_angle * sums[k];
  visibility[0] += std::sqrt(4.0f * kPi);
  return float(met) / float(tiles * kTileSize);
}

bool NeighbourhoodTracer::isInside(const glm::vec3& place) const {
  int backs = 0;
  for (const glm::vec3& direction : probes_) {
    const trace::Hit hit = tracer_.closest({place, direction});
    backs += hit && glm::dot(direction, hit.geometric_normal) > 0.0f;
  }
  return float(backs) > kInsideBlocked * float(probes_.size());
}

const float* NeighbourhoodTracer::rowAt(const trace::Hit& hit, const Lit& lit, int corner) const {
  const std::uint32_t vertex = lit.mesh->indices[3 * std::size_t(hit.triangle) + std::size_t(corner)];
  return &lit.rows[std::size_t(vertex) * 3 * layout_.columnStride()];
}

void NeighbourhoodTracer::addDiffuse(const trace::Hit& hit, const Lit& lit, const glm::vec3& weight,
                                     LightRow& light) const {
  const std::size_t stride = layout_.columnStride(), columns = std::size_t(layout_.lightCount());
  if (lit.texel_width > 0) {
    const trace::SurfacePoint at{hit.triangle, hit.u, hit.v};
    const glm::vec2 uv = trace::interpolate(*lit.mesh, lit.mesh->uv_sets[std::size_t(lit.uv_set)], at);
    const int x = std::clamp(int(uv.x * float(lit.texel_width)), 0, lit.texel_width - 1);
    const int y = std::clamp(int(uv.y * float(lit.texel_height)), 0, lit.texel_height - 1);
    const float* row = &lit.rows[std::size_t(y * lit.texel_width + x) * 3 * stride];
    for (int c = 0; c < 3; ++c)
      for (std::size_t j = 0; j < columns; ++j)
        light.color[c][j] += weight[c] * row[std::size_t(c) * stride + j];
    return;
  }
  const float shares[3] = {1.0f - hit.u - hit.v, hit.u, hit.v};
  for (int corner = 0; corner < 3; ++corner) {
    const float* row = rowAt(hit, lit, corner);
    for (int c = 0; c < 3; ++c) {
      const float w = weight[c] * shares[corner];
      for (std::size_t j = 0; j < columns; ++j) light.color[c][j] += w * row[std::size_t(c) * stride + j];
    }
  }
}

// What arrives along a ray that has met something: its diffuse light, and what its mirror shows, and so on. Returns the
// number of further rays.
std::size_t NeighbourhoodTracer::follow(trace::Hit hit, glm::vec3 origin, glm::vec3 direction,
                                        LightRow& light) const {
  glm::vec3 share(1.0f);
  float bands[sh::kMaxOrder];  // what lobes on the way have left of each band
  std::fill_n(bands, sh::kMaxOrder, 1.0f);
  for (int length = 0;; ++length) {
    const Lit& lit = lit_[std::size_t(hit.instance)];
    const float along = glm::dot(direction, hit.geometric_normal);
    if (along * float(lit.facing[std::size_t(hit.triangle)]) > 0.0f) return std::size_t(length);  // a back
    const trace::SurfacePoint at{hit.triangle, hit.u, hit.v};
    const trace::MaterialPoint material = trace::materialAt(scene_, *lit.mesh, at, at);
    const float specular = scene_.materials[std::size_t(lit.mesh->material)].specular;
    const brdf::Lobes lobes =
        brdf::makeLobes(material.base_color, material.metallic, material.roughness, specular);
    addDiffuse(hit, lit, share * glm::clamp(lobes.diffuse, 0.0f, 1.0f) / kPi, light);
    share *= glm::clamp(lobes.specular, 0.0f, 1.0f);
    if (std::max({share.r, share.g, share.b}) < kFaintest || length == kLongestChain)
      return std::size_t(length);

    const glm::vec3 sum = trace::interpolate(*lit.mesh, lit.normals, at);
    const float norm = glm::length(sum);
    const glm::vec3 outward = along > 0.0f ? -hit.geometric_normal : hit.geometric_normal;
    glm::vec3 normal = norm > 1e-6f ? sum / norm : outward;
    if (glm::dot(normal, outward) < 0.0f) normal = -normal;
    const glm::vec3 mirrored = brdf::mirrorDirection(normal, -direction);
    if (glm::dot(mirrored, outward) <= 0.0f) return std::size_t(length);  // into the surface itself
    for (int l = 0; l < layout_.light_order; ++l) bands[l] *= brdf::phongBandFactor(l, lobes.exponent);
    origin += hit.distance * direction + tracer_.surfaceOffset(hit) * outward;
    direction = mirrored;
    hit = tracer_.closest({origin, direction});
    if (hit) continue;
    const sh::Sh y = sh::evaluate(layout_.light_order, direction);
    for (int j = 0; j < layout_.lightCount(); ++j) {
      const float value = y[j] * bands[int(std::sqrt(double(j) + 0.5))];
      for (int c = 0; c < 3; ++c) light.color[c][j] += share[c] * value;
    }
    return std::size_t(length) + 1;
  }
}

std::size_t NeighbourhoodTracer::thrown(const glm::vec3& place, const std::vector<std::uint16_t>& blocked,
                                        float share, float* matrix) const {
  const OuterShape shape{std::size_t(layout_.fieldCount()), std::size_t(layout_.lightCount()),
                         layout_.columnStride(), layout_.colorSize()};
  std::size_t seen = 0, rays_done = 0;
  for (const std::int32_t tile : all_.tables.bounce_tile)
    seen += std::size_t(std::popcount(blocked[std::size_t(tile)]));
  if (seen == 0) return 0;
  // How much of the sphere is blocked is known better from all directions.
  const float each = sampling::TiledDirections::solidAngle(all_.tables.bounce_tiles),
              known = 4.0f * kPi * share;
  const float scale = each * std::clamp(known / (each * float(seen)), 0.5f, 2.0f);
  trace::RayPacket rays;
  trace::LaneMask mask;
  trace::HitPacket found;
  rays.setOrigin(place);
  for (const std::int32_t tile : all_.tables.bounce_tile) {
    std::uint32_t lanes = blocked[std::size_t(tile)];
    if (lanes == 0) continue;
    setDirections(rays, all_.tables.tileDirections(tile));
    mask.set(lanes);
    tracer_.closest(rays, mask, false, found);
    rays_done += std::size_t(std::popcount(lanes));
    for (; lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      if (found.instance[k] == trace::kNoHit) continue;
      LightRow light = {};
      rays_done += follow(hitOf(found, k), place, directionOf(rays, k), light);
      addOuter(shape, all_.basis.basisOf(std::size_t(tile) * kTileSize + std::size_t(k)), scale, light,
               matrix);
    }
  }
  return rays_done;
}

}  // namespace gloam::prt
