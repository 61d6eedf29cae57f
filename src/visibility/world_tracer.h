// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "trace/tracer.h"

namespace gloam::visibility {

/// Rays against what stands still and what moves, in a hierarchy each: where little moves, little is built anew in a frame. Thread-safe
/// once built. Instances count as in the posed scene.
class WorldTracer {
 public:
  /// `moves[i]`: instance i is in the second hierarchy. The first is taken over from `before` where it holds the same; else both are
  /// built. `scene` has to live as long, and holds an empty mesh at its end. Throws Error where they do not fit into memory.
  WorldTracer(const Scene& scene, const PosedScene& posed, std::vector<bool> moves,
              std::unique_ptr<WorldTracer> before);

  std::size_t triangleCount() const;
  float surfaceOffset(const trace::Hit& hit) const;
  trace::Tracer::Triangles triangles(int instance) const;
  trace::Hit closest(const trace::Ray& ray) const;
  bool occluded(const trace::Ray& ray) const;
  /// As trace::Tracer has it.
  void occluded(trace::RayPacket& rays, const trace::LaneMask& mask, bool coherent) const;
  /// As trace::Tracer has it; only where nothing moves: else some rays are traced twice.
  std::size_t replay(std::span<const trace::LoggedRay> rays) const;

 private:
  std::vector<bool> moves_;
  std::unique_ptr<trace::Tracer> still_, moving_;  // null: nothing
};

}  // namespace gloam::visibility
