// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_rays.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "trace/tracer.h"
#include "visibility/host_world.h"

namespace gloam::visibility {

struct HostRays::State {
  HostWorld world;
  mutable std::atomic<std::uint64_t> rays{0};
};

HostRays::HostRays() : state_(std::make_unique<State>()) {}
HostRays::~HostRays() = default;

void HostRays::reads(gpu::HostPass& pass, const frame::GpuScene& scene) {
  HostWorld::reads(pass, scene);
}

void HostRays::update(const gpu::HostAccess& access, const frame::GpuScene& scene) {
  state_->world.update(access, scene);
  state_->world.tracer();  // built here, not by the threads that trace
}

void HostRays::trace(std::span<const Place> from, std::span<const Place> to,
                     std::span<std::uint64_t> visible) const {
  const State& s = *state_;
  const auto traceOne = [&](const Place& place) {
    const glm::vec3 origin = place.position + place.offset * place.normal;
    std::uint64_t seen = 0, rays = 0;
    for (std::size_t first = 0; first < to.size(); first += trace::kPacketSize) {
      trace::RayPacket packet;
      packet.setOrigin(origin);
      std::uint32_t lanes = 0;
      for (std::size_t i = 0; i < trace::kPacketSize && first + i < to.size(); ++i) {
        const Place& other = to[first + i];
        const glm::vec3 between = other.position + other.offset * other.normal - origin;
        const float distance = glm::length(between);
        if (glm::dot(other.position - place.position, place.normal) <= 0.0f ||
            glm::dot(other.position - place.position, other.normal) >= 0.0f || !(distance > 0.0f))
          continue;
        trace::Ray ray{origin, between / distance, 0.0f, std::max(distance - other.offset, 0.0f)};
        packet.setRay(int(i), ray);
        lanes |= 1u << i;
        ++rays;
      }
      if (lanes == 0) continue;
      trace::LaneMask mask;
      mask.set(lanes);
      s.world.tracer().occluded(packet, mask, false);
      for (std::size_t i = 0; i < trace::kPacketSize; ++i) {
        const bool open = (lanes >> i & 1u) != 0 && !(packet.t_far[i] < 0.0f);
        seen |= std::uint64_t(open) << (first + i);
      }
    }
    s.rays.fetch_add(rays, std::memory_order_relaxed);
    return seen;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) visible[k] = traceOne(from[k]);
  });
}

std::uint64_t HostRays::tracedRays() const {
  return state_->rays.load();
}

}  // namespace gloam::visibility
