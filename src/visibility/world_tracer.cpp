// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/world_tracer.h"

#include <algorithm>

namespace gloam::visibility {

namespace {

/// Those instances, the others without triangles; null where that leaves none.
std::unique_ptr<trace::Tracer> tracerOf(const Scene& scene, const PosedScene& posed,
                                        const std::vector<bool>& moves, bool moving) {
  PosedScene part = posed;
  bool any = false;
  for (std::size_t i = 0; i < part.instances.size(); ++i) {
    if (moves[i] == moving) {
      any = true;
      continue;
    }
    part.instances[i] = Instance{};
    part.instances[i].mesh = int(scene.meshes.size()) - 1;
  }
  return any ? std::make_unique<trace::Tracer>(scene, part) : nullptr;
}

}  // namespace

WorldTracer::WorldTracer(const Scene& scene, const PosedScene& posed, std::vector<bool> moves,
                         std::unique_ptr<WorldTracer> before)
    : moves_(std::move(moves)) {
  if (before && before->moves_ == moves_)
    still_ = std::move(before->still_);
  else
    still_ = tracerOf(scene, posed, moves_, false);
  moving_ = tracerOf(scene, posed, moves_, true);
}

std::size_t WorldTracer::triangleCount() const {
  return (still_ ? still_->triangleCount() : 0) + (moving_ ? moving_->triangleCount() : 0);
}

float WorldTracer::surfaceOffset(const trace::Hit& hit) const {
  return (moves_[std::size_t(hit.instance)] ? moving_ : still_)->surfaceOffset(hit);
}

trace::Tracer::Triangles WorldTracer::triangles(int instance) const {
  return (moves_[std::size_t(instance)] ? moving_ : still_)->triangles(instance);
}

trace::Hit WorldTracer::closest(const trace::Ray& ray) const {
  trace::Hit hit;
  if (still_) hit = still_->closest(ray);
  if (!moving_) return hit;
  trace::Ray nearer = ray;
  nearer.t_far = std::min(ray.t_far, hit.distance);
  const trace::Hit other = moving_->closest(nearer);
  return other ? other : hit;
}

bool WorldTracer::occluded(const trace::Ray& ray) const {
  return (still_ && still_->occluded(ray)) || (moving_ && moving_->occluded(ray));
}

void WorldTracer::occluded(trace::RayPacket& rays, const trace::LaneMask& mask, bool coherent) const {
  if (still_) still_->occluded(rays, mask, coherent);
  if (moving_) moving_->occluded(rays, mask, coherent);  // lanes that met something end before they begin
}

std::size_t WorldTracer::replay(std::span<const trace::LoggedRay> rays) const {
  return (still_ ? still_->replay(rays) : 0) + (moving_ ? moving_->replay(rays) : 0);
}

}  // namespace gloam::visibility
