// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The passes of a bake (PRT-1, PRT-3), a block of points at a time.
#pragma once

#include <array>
#include <atomic>
#include <bit>

#include "math/brdf.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_state.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// Most memory for hits that bounces after the first need not trace again.
inline constexpr std::size_t kKeptHitsBytes = std::size_t(512) << 20;

/// A hit that sends transfer on through both lobes.
struct GlossyHit {
  std::uint32_t point[3];
  float share[3];           ///< barycentric
  std::uint32_t direction;  ///< of the ray: tile * 16 + lane
  float cosine;             ///< max(0, n.s) ds at the receiver
  float solid_angle;        ///< ds
  glm::vec3 albedo;         ///< k_d / pi
  glm::vec3 specular;       ///< k_s; 0 where the surface has no matrices
  float exponent;
  glm::vec3 mirror;  ///< direction from which a mirror would send light along the ray
};

/// Numbers of points, so many each: of all, or of those that have a row.
struct PointRows {
  std::vector<float>& values;
  std::size_t size = 0;
  const GlossyState* glossy = nullptr;
  bool has(std::size_t point) const { return glossy == nullptr || glossy->has(point); }
  float* of(std::size_t point) const {
    return &values[(glossy == nullptr ? point : glossy->first_row[point]) * size];
  }
};

/// All that passes read. Thread-safe: a block writes its own rows of the state alone.
class BakePasses {
 public:
  BakePasses(const Scene& scene, const PosedScene& posed, const BakePoints& points,
             const trace::Tracer& tracer, const DirectionTables& tables,
             const GlossyTables* glossy = nullptr);

  /// Shadow rays and DS of one block. Returns the number of rays.
  std::size_t shadowBlock(std::size_t block, BakeState& state) const;
  /// M^b of one block from M^{b-1}. Returns the number of rays.
  std::size_t bounceBlock(std::size_t block, BakeState& state);
  /// Gives points that cannot show what they see (Place) the mean of their neighbours. To be called between passes.
  void fillHidden(const BakeState& state, const PointRows& rows) const;

 private:
  glm::vec3 unobstructed(const glm::vec3& from, const glm::vec3& to) const;
  glm::vec3 startAtVertex(std::size_t point) const;
  glm::vec3 startOnFace(std::size_t point, std::uint32_t face, float share) const;
  Place placeOf(const glm::vec3& origin, const glm::vec3& normal, float reach) const;
  bool fillFromNeighbours(std::uint32_t point, const std::vector<std::uint8_t>& known,
                          const PointRows& rows) const;
  void projectPoints(std::size_t begin, std::size_t count, const std::uint16_t* blocked, float* sums) const;
  std::size_t digOut(std::size_t point, RaySite& site, std::uint16_t* blocked, float* sums) const;
  bool findBetterPlace(std::size_t point, RaySite& site) const;
  struct BounceSums {
    double cosine = 0.0;  ///< of the directions with the normal
    std::size_t rays = 0;
  };
  /// Traces the blocked directions of a point: visit(rays, found, tile, lanes, cosines) for each tile that has some.
  template <class Visit>
  BounceSums traceBounceRays(std::size_t point, const BakeState& state, const Visit& visit) const;
  std::size_t traceHits(std::size_t point, const BakeState& state, std::vector<GatheredHit>& hits) const;
  void addHits(const trace::RayPacket& rays, const trace::HitPacket& found, std::uint32_t lanes,
               const float* cosines, std::vector<GatheredHit>& hits) const;
  bool isBack(int instance, int triangle, float along_normal) const;
  // prt_glossy_passes.cpp
  void projectVisibility(std::size_t point, const std::uint16_t* blocked, BakeState& state) const;
  std::size_t glossyBounceBlock(std::size_t block, BakeState& state);
  std::size_t traceGlossyHits(std::size_t point, const BakeState& state, std::vector<GlossyHit>& hits) const;
  void addGlossyHits(const trace::RayPacket& rays, const trace::HitPacket& found, std::size_t tile,
                     std::uint32_t lanes, const float* cosines, std::vector<GlossyHit>& hits) const;
  void gatherGlossy(std::size_t point, std::span<const GlossyHit> hits, BakeState& state) const;

  const Scene& scene_;
  const BakePoints& points_;
  const trace::Tracer& tracer_;
  const DirectionTables& tables_;
  const GlossyTables* glossy_;
  struct Surface {
    const Mesh* mesh = nullptr;
    bool double_sided = false;
    bool uniform = false;    ///< one albedo everywhere
    glm::vec3 albedo{0.0f};  ///< where uniform
    brdf::Lobes lobes;       ///< the same, with the mirrored part
    bool glossy = false;     ///< its points have matrices
  };
  std::vector<Surface> surfaces_;  ///< [instance]
  std::vector<glm::vec3> probes_;  ///< directions of placeOf

  struct KeptHits {
    std::vector<GatheredHit> hits;
    std::vector<GlossyHit> glossy_hits;         ///< instead, where there are matrices
    std::array<std::size_t, kBlockSize> end{};  ///< of each point's hits
    bool complete = false;
  };
  std::vector<KeptHits> kept_hits_;  ///< [block]; each is touched by one thread at a time
  std::atomic<std::size_t> kept_bytes_{0};
};

template <class Visit>
BakePasses::BounceSums BakePasses::traceBounceRays(std::size_t point, const BakeState& state,
                                                   const Visit& visit) const {
  const glm::vec3& normal = points_.normals[point];
  trace::RayPacket rays;
  trace::LaneMask mask;
  trace::HitPacket found;
  rays.setOrigin(state.sites[point].origin);
  BounceSums sums;
  for (std::size_t t = 0; t < state.bounce_tiles; ++t) {
    const std::uint32_t lanes = state.blocked[point * state.bounce_tiles + t];
    if (lanes == 0) continue;
    const std::int32_t tile = tables_.bounce_tile[t];
    const float* directions = tables_.tileDirections(tile);
    std::copy_n(directions, kTileSize, rays.direction_x);
    std::copy_n(directions + kTileSize, kTileSize, rays.direction_y);
    std::copy_n(directions + 2 * kTileSize, kTileSize, rays.direction_z);
    float cosines[kTileSize];
    for (int k = 0; k < kTileSize; ++k) {
      cosines[k] = std::max(0.0f, glm::dot(normal, tables_.direction(tile, k)));
      if (lanes >> k & 1u) sums.cosine += double(cosines[k]);
    }
    mask.set(lanes);
    sums.rays += std::size_t(std::popcount(lanes));
    tracer_.closest(rays, mask, false,
                    found);  // tiles of the smaller set are wide: a fifth faster as incoherent
    visit(rays, found, tile, lanes, cosines);
  }
  return sums;
}

}  // namespace gloam::prt
