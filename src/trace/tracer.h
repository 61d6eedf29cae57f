// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rays against a posed scene, by Embree (3.13 or 4). src/trace is the only folder that includes it.
//
// Every instance becomes one geometry of world-space triangles in one flat hierarchy: no instancing, since a flat hierarchy
// is traced 1.2 to 1.5 times faster and whoever bakes has unique instances anyway. It costs about 120 bytes a triangle
// that is drawn.
#pragma once

#include <gloam/scene.h>

#include <memory>
#include <span>

#include "trace/rays.h"

namespace gloam::trace {

struct TracerOptions {
  /// Builds on one core. A parallel build may order triangles differently from run to run, and where two coincide the first
  /// one found is the hit: a result that must have the same bits every time needs this.
  bool reproducible = false;
  /// Watertight along shared edges, at about a tenth of the speed. Without it rays slip through edges: of those that cross
  /// faces at a fair angle about one in a million, but far more where they run along a surface and meet its edges edge-on.
  bool robust = false;
  /// Leaves out skinned and morphed instances.
  bool rigid_only = false;
};

/// Thread-safe once built. Keeps a reference to `scene` for alpha masks; `posed` is not needed afterwards.
class Tracer {
 public:
  /// Triangles of positive area are taken, masked ones (Material::alpha_mask) are asked for their alpha at every hit.
  /// Throws Error where the hierarchy does not fit into memory, Interrupted when asked to stop.
  Tracer(const Scene& scene, const PosedScene& posed, const TracerOptions& options = {},
         const Progress& progress = {});
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  std::size_t triangleCount() const { return triangle_count_; }
  std::size_t memoryBytes() const;  ///< what the hierarchy holds now

  /// surfaceOffset (rays.h) of the triangle that was hit.
  float surfaceOffset(const Hit& hit) const;

  /// The triangles of an instance, in the world; null where it has none.
  struct Triangles {
    const glm::vec3* positions = nullptr;
    const glm::uvec3* vertices = nullptr;
  };
  Triangles triangles(int instance) const;

  Hit closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const;

  /// Sixteen at once, those whose lane of `mask` is set. `coherent` promises that the rays are near to each other.
  void occluded(RayPacket& rays, const LaneMask& mask, bool coherent) const;
  void closest(const RayPacket& rays, const LaneMask& mask, bool coherent, HitPacket& hits) const;

  /// Hands the rays one by one to the tracing library, and does nothing else: what is left when all else is taken away.
  /// The number of those that hit.
  std::size_t replay(std::span<const LoggedRay> rays) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  std::size_t triangle_count_ = 0;
};

}  // namespace gloam::trace
