// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The passes of a bake (PRT-1, PRT-3), a block of points at a time. Long, since five files implement one class whose parts
// share what they read.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <span>

#include "math/brdf.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_state.h"
#include "techniques/prt/prt_bake_texels.h"
#include "techniques/prt/prt_bake_turn.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// Most memory for hits that bounces after the first need not trace again.
inline constexpr std::size_t kKeptHitsBytes = std::size_t(512) << 20;

/// How the passes are to go about it.
struct PassSettings {
  int bounces = 0;
  bool caustics = false;  ///< lobes that matrices cannot show are followed
  float error = 0.0f;     ///< BakeOptions::error
  std::size_t kept_bytes = kKeptHitsBytes;
  bool turned = false;  ///< each point has the set of directions turned by itself (prt_bake_turn.h)
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
             const trace::Tracer& tracer, const DirectionTables& tables, const PassSettings& settings = {},
             const GlossyTables* glossy = nullptr);

  /// Shadow rays and DS of one block. Returns the number of rays.
  std::size_t shadowBlock(std::size_t block, BakeState& state) const;
  /// M^b of one block from M^{b-1}. Returns the number of rays.
  std::size_t bounceBlock(std::size_t block, BakeState& state);
  /// Gives points that cannot show what they see (Place) the mean of their neighbours. To be called between passes.
  void fillHidden(const BakeState& state, const PointRows& rows) const;

 private:
  /// From the axes of the set of directions to the world, at a point.
  glm::mat3 turnOf(std::size_t point) const {
    return turns_ == nullptr ? glm::mat3(1.0f)
                             : turns_->at(points_.positions[point], points_.normals[point]).matrix;
  }
  const sh::HighRotation* coefficientTurn(std::size_t point) const {
    return turns_ == nullptr ? nullptr
                             : &turns_->at(points_.positions[point], points_.normals[point]).coefficients;
  }
  glm::vec3 unobstructed(const glm::vec3& from, const glm::vec3& to) const;
  glm::vec3 startAtVertex(std::size_t point) const;
  glm::vec3 startOnFace(std::size_t point, std::uint32_t face, float share) const;
  Place placeOf(const glm::vec3& origin, const glm::vec3& normal, float reach) const;
  bool fillFromNeighbours(std::uint32_t point, const std::vector<std::uint8_t>& known,
                          const PointRows& rows) const;
  // Points of a block, some of which still take directions.
  struct ShadowWork;
  std::size_t shadowBatch(const DirectionBatch& batch, BakeState& state, ShadowWork& work) const;
  void projectPoints(const DirectionBatch& batch, std::span<const std::size_t> points, std::size_t first,
                     const std::uint16_t* blocked, float* sums) const;
  std::size_t digOut(std::size_t point, RaySite& site, std::size_t first, std::uint16_t* blocked,
                     float* sums) const;
  void finishShadow(std::size_t point, const ShadowWork& work, std::size_t i, BakeState& state) const;
  float nookReach(std::size_t point) const;
  bool findBetterPlace(std::size_t point, RaySite& site) const;
  struct BounceSums {
    double cosine = 0.0;       ///< of the directions with the normal
    std::size_t rays = 0;      ///< blocked directions
    std::size_t followed = 0;  ///< rays from mirrors
    std::size_t asked = 0;     ///< rays of blockedOf
  };
  /// Traces the blocked directions of a point among some bounce tiles: visit(rays, found, tile, lanes, cosines) for each
  /// tile that has some.
  template <class Visit>
  void traceBounceRays(std::size_t point, const BakeState& state, std::size_t first, std::size_t end,
                       BounceSums& sums, const Visit& visit) const;
  /// Which of a point's directions are blocked, by bounce tile. Light that mirrors throw may want more directions than its shadow
  /// did: those are then found here, from `first` on to `end`.
  const std::uint16_t* blockedOf(std::size_t point, const BakeState& state, std::size_t first,
                                 std::size_t end, BounceSums& sums) const;
  bool isBack(int instance, int triangle, float along_normal) const;
  GatherSources sourcesOf(const BakeState& state) const;
  GatherSources sourcesOfAll(const BakeState& state) const;

  /// What one point's blocked directions met, before it is packed.
  template <class OneHit>
  struct HitWork;
  // prt_bake_hits.cpp
  using PointWork = HitWork<RawHit>;
  struct KeptHits;
  void collectHits(std::size_t point, const BakeState& state, std::size_t first, std::size_t end,
                   PointWork& work) const;
  void addHits(std::size_t point, const trace::RayPacket& rays, const trace::HitPacket& found,
               std::size_t tile, std::uint32_t lanes, const float* cosines, PointWork& work) const;
  void packPoint(std::size_t point, const BakeState& state, std::size_t tiles, PointWork& work,
                 KeptHits& hits, std::size_t i) const;
  void gatherPoint(std::size_t point, const KeptHits& hits, std::size_t i, BakeState& state) const;
  void bounceUntilKnown(std::size_t point, BakeState& state, PointWork& work) const;
  void bounceAgain(std::size_t point, const BakeState& state, PointWork& work) const;

  // prt_bake_mirrors.cpp
  /// A ray on its way from a mirror, or from the receiver.
  struct MirrorRay {
    trace::Ray ray;
    glm::vec3 throughput{1.0f};
    float cosine = 0.0f;        ///< max(0, n.s) at the receiver
    std::uint32_t primary = 0;  ///< direction at the receiver: tile * 16 + lane
    std::uint32_t mirrors = 0;  ///< it has met
  };
  struct Meeting {
    int instance, triangle;
    float u, v;
    glm::vec3 geometric_normal;  ///< on the side that was met; need not be unit
  };
  struct Surface;
  brdf::Lobes lobesAt(const Surface& surface, int triangle, float u, float v) const;
  glm::vec3 shadingNormal(const Meeting& at) const;
  static SkyHit skyHit(const MirrorRay& came);
  bool isFollowed(const Surface& surface, const brdf::Lobes& lobes, std::uint32_t mirrors) const;
  void reflect(std::size_t point, const MirrorRay& came, const Meeting& at, const brdf::Lobes& lobes,
               std::vector<MirrorRay>& onward) const;
  /// Follows all rays to their ends: surface(came, at, k_d) and sky(came).
  template <class OnSurface, class OnSky>
  std::size_t followMirrors(std::size_t point, std::vector<MirrorRay>& rays, const OnSurface& surface,
                            const OnSky& sky) const;

  /// Points whose transfer is sent on from a place, and their shares: the triangle's vertices, or three texels.
  TexelCorners sendersAt(int instance, int triangle, float u, float v) const;
  // prt_glossy_passes.cpp
  float addVisibility(const DirectionBatch& batch, const std::uint16_t* blocked, float* sums) const;
  void writeVisibility(std::size_t point, const float* sums, BakeState& state) const;
  std::size_t glossyBounceBlock(std::size_t block, BakeState& state);
  void sumGlossy(std::span<const GlossyHit> hits, std::span<const SkyHit> skies, const GatherSources& sources,
                 int sky_pass, const GlossyState& glossy, float* vector, float* matrix) const;
  // prt_glossy_hits.cpp
  using GlossyWork = HitWork<GlossyHit>;
  void collectGlossy(std::size_t point, const BakeState& state, std::size_t first, std::size_t end,
                     GlossyWork& work) const;
  void collectGlossyOf(std::size_t point, BakeState& state, GlossyWork& work) const;
  void glossyUntilKnown(std::size_t point, BakeState& state, GlossyWork& work) const;
  void packGlossy(std::size_t point, const BakeState& state, std::size_t tiles, GlossyWork& work,
                  KeptHits& hits) const;
  void addGlossyHits(std::size_t point, const trace::RayPacket& rays, const trace::HitPacket& found,
                     std::size_t tile, std::uint32_t lanes, const float* cosines,
                     std::vector<GlossyHit>& hits, std::vector<MirrorRay>& onward) const;
  GlossyHit glossyHit(const MirrorRay& came, const Meeting& at, const glm::vec3& diffuse) const;
  void turnRows(std::size_t point, const float* matrix, float* to) const;
  void gatherGlossy(std::size_t point, std::span<const GlossyHit> hits, std::span<const SkyHit> skies,
                    BakeState& state) const;

  const Scene& scene_;
  const BakePoints& points_;
  const trace::Tracer& tracer_;
  const DirectionTables& tables_;
  const PassSettings settings_;
  const GlossyTables* glossy_;
  const Turns* turns_ = nullptr;    ///< null: all points have the same directions
  std::uint32_t most_mirrors_ = 0;  ///< that are worth following
  float open_norm_ = 1.0f;          ///< of the transfer of a point that sees all of the sky
  struct Surface {
    const Mesh* mesh = nullptr;
    bool double_sided = false;
    bool uniform = false;    ///< one albedo everywhere
    glm::vec3 albedo{0.0f};  ///< where uniform
    brdf::Lobes lobes;       ///< the same, with the mirrored part
    bool glossy = false;     ///< its points have matrices
    bool mirrors = false;    ///< enough, somewhere, to be followed
  };
  std::vector<Surface> surfaces_;  ///< [instance]
  std::vector<glm::vec3> probes_;  ///< directions of placeOf
  std::vector<float> diagonals_;   ///< [instance], metres

  struct KeptHits {
    std::vector<GatheredHit> hits;
    std::vector<GlossyHit> glossy_hits;  ///< instead, where there are matrices
    std::vector<SkyHit> skies;
    std::array<PointHits, kBlockSize> points{};
    bool complete = false;
    std::size_t bytes() const {
      return hits.size() * sizeof(GatheredHit) + glossy_hits.size() * sizeof(GlossyHit) +
             skies.size() * sizeof(SkyHit);
    }
    /// Of point i of the block.
    std::size_t begin(std::size_t i) const { return i > 0 ? points[i - 1].end : 0; }
    std::span<const SkyHit> skiesOf(std::size_t i) const {
      const std::size_t first = i > 0 ? points[i - 1].sky_end : 0;
      return {skies.data() + first, points[i].sky_end - first};
    }
  };
  void keep(std::size_t block, const BakeState& state, KeptHits& fresh);
  std::vector<KeptHits> kept_hits_;  ///< [block]; each is touched by one thread at a time
  std::atomic<std::size_t> kept_bytes_{0};
};

template <class OneHit>
struct BakePasses::HitWork {
  std::vector<OneHit> hits;
  std::vector<SkyHit> skies;
  std::vector<MirrorRay> onward;
  BounceSums sums;
  void clear() {
    hits.clear();
    skies.clear();
    sums = {};
  }
  void add(const HitWork& other) {
    hits.insert(hits.end(), other.hits.begin(), other.hits.end());
    skies.insert(skies.end(), other.skies.begin(), other.skies.end());
    sums.cosine += other.sums.cosine;
    sums.rays += other.sums.rays;
    sums.followed += other.sums.followed;
    sums.asked += other.sums.asked;
  }
};

template <class Visit>
void BakePasses::traceBounceRays(std::size_t point, const BakeState& state, std::size_t first,
                                 std::size_t end, BounceSums& sums, const Visit& visit) const {
  const glm::mat3 turn = turnOf(point);
  const glm::vec3& normal = points_.normals[point];
  trace::RayPacket rays;
  trace::LaneMask mask;
  trace::HitPacket found;
  rays.setOrigin(state.sites[point].origin);
  const std::uint16_t* blocked = blockedOf(point, state, first, end, sums);
  for (std::size_t t = first; t < end; ++t) {
    const std::uint32_t lanes = blocked[t];
    if (lanes == 0) continue;
    const std::int32_t tile = tables_.bounce_tile[t];
    float cosines[kTileSize];
    for (int k = 0; k < kTileSize; ++k) {
      const glm::vec3 direction = turn * tables_.direction(tile, k);
      rays.direction_x[k] = direction.x;
      rays.direction_y[k] = direction.y;
      rays.direction_z[k] = direction.z;
      cosines[k] = std::max(0.0f, glm::dot(normal, direction));
      if (lanes >> k & 1u) sums.cosine += double(cosines[k]);
    }
    mask.set(lanes);
    sums.rays += std::size_t(std::popcount(lanes));
    tracer_.closest(rays, mask, false,
                    found);  // tiles of the smaller set are wide: a fifth faster as incoherent
    visit(rays, found, tile, lanes, cosines);
  }
}

template <class OnSurface, class OnSky>
std::size_t BakePasses::followMirrors(std::size_t point, std::vector<MirrorRay>& onward,
                                      const OnSurface& on_surface, const OnSky& on_sky) const {
  trace::RayPacket rays;
  trace::LaneMask mask;
  trace::HitPacket found;
  for (std::size_t first = 0; first < onward.size();) {
    const std::size_t count = std::min<std::size_t>(kTileSize, onward.size() - first);
    for (std::size_t k = 0; k < count; ++k) rays.setRay(int(k), onward[first + k].ray);
    mask.set((1u << count) - 1u);
    tracer_.closest(rays, mask, false, found);
    for (std::size_t k = 0; k < count; ++k) {
      const MirrorRay came = onward[first + k];
      const int instance = found.instance[k], triangle = found.triangle[k];
      if (instance == trace::kNoHit) {
        on_sky(came);
        continue;
      }
      const glm::vec3 normal(found.normal_x[k], found.normal_y[k], found.normal_z[k]);
      if (isBack(instance, triangle, glm::dot(came.ray.direction, normal))) continue;
      const Meeting at{instance, triangle, found.u[k], found.v[k], normal};
      const brdf::Lobes lobes = lobesAt(surfaces_[std::size_t(instance)], triangle, at.u, at.v);
      if (int(came.mirrors) < settings_.bounces) on_surface(came, at, glm::clamp(lobes.diffuse, 0.0f, 1.0f));
      if (isFollowed(surfaces_[std::size_t(instance)], lobes, came.mirrors))
        reflect(point, came, at, lobes, onward);
    }
    first += count;
  }
  const std::size_t all = onward.size();
  onward.clear();
  return all;
}

}  // namespace gloam::prt
