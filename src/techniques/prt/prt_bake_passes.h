// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The passes of a bake (PRT-1, PRT-3), a block of points at a time.
#pragma once

#include <array>
#include <atomic>

#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_state.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// Most memory for hits that bounces after the first need not trace again.
inline constexpr std::size_t kKeptHitsBytes = std::size_t(512) << 20;

/// All that passes read. Thread-safe: a block writes its own rows of the state alone.
class BakePasses {
 public:
  BakePasses(const Scene& scene, const PosedScene& posed, const BakePoints& points,
             const trace::Tracer& tracer, const DirectionTables& tables);

  /// Shadow rays and DS of one block. Returns the number of rays.
  std::size_t shadowBlock(std::size_t block, BakeState& state) const;
  /// M^b of one block from M^{b-1}. Returns the number of rays.
  std::size_t bounceBlock(std::size_t block, BakeState& state);
  /// Gives points that cannot show what they see (Place) the mean of their neighbours; `row` floats a point. To be called
  /// between passes.
  void fillHidden(const BakeState& state, std::size_t row, std::vector<float>& values) const;

 private:
  glm::vec3 unobstructed(const glm::vec3& from, const glm::vec3& to) const;
  glm::vec3 startAtVertex(std::size_t point) const;
  glm::vec3 startOnFace(std::size_t point, std::uint32_t face, float share) const;
  Place placeOf(const glm::vec3& origin, const glm::vec3& normal, float reach) const;
  bool fillFromNeighbours(std::uint32_t point, const std::vector<std::uint8_t>& known, std::size_t row,
                          std::vector<float>& values) const;
  void projectPoints(std::size_t begin, std::size_t count, const std::uint16_t* blocked, float* sums) const;
  std::size_t digOut(std::size_t point, RaySite& site, std::uint16_t* blocked, float* sums) const;
  bool findBetterPlace(std::size_t point, RaySite& site) const;
  std::size_t traceHits(std::size_t point, const BakeState& state, std::vector<GatheredHit>& hits) const;
  void addHits(const trace::RayPacket& rays, const trace::HitPacket& found, std::uint32_t lanes,
               const float* cosines, std::vector<GatheredHit>& hits) const;
  bool isBack(int instance, int triangle, float along_normal) const;

  const Scene& scene_;
  const BakePoints& points_;
  const trace::Tracer& tracer_;
  const DirectionTables& tables_;
  struct Surface {
    const Mesh* mesh = nullptr;
    bool double_sided = false;
    bool uniform = false;    ///< one albedo everywhere
    glm::vec3 albedo{0.0f};  ///< where uniform
  };
  std::vector<Surface> surfaces_;  ///< [instance]
  std::vector<glm::vec3> probes_;  ///< directions of placeOf

  struct KeptHits {
    std::vector<GatheredHit> hits;
    std::array<std::size_t, kBlockSize> end{};  ///< of each point's hits
    bool complete = false;
  };
  std::vector<KeptHits> kept_hits_;  ///< [block]; each is touched by one thread at a time
  std::atomic<std::size_t> kept_bytes_{0};
};

}  // namespace gloam::prt
