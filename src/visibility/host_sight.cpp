// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A packet is one point and sixteen lights of its set: rays of one origin. Lights are laid out by lanes once a batch.
#include "visibility/host_sight.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

namespace gloam::visibility {

namespace {

constexpr int kLanes = trace::kPacketSize;
constexpr float kFar = std::numeric_limits<float>::infinity();

/// Sixteen lights. A ray goes to end + side * offset * normal - near * origin.
struct alignas(64) LightLanes {
  float x[kLanes], y[kLanes], z[kLanes];
  float normal_x[kLanes], normal_y[kLanes], normal_z[kLanes];
  float offset[kLanes];
  float near[kLanes];  // 1, or 0 where it is infinitely far away
  float limit
      [kLanes];  // it is seen where normal . (light - point) is less: 0 for one side, infinity for all, -infinity for none
  float both[kLanes];  // 1: it sends to both sides
};

void setLane(LightLanes& lanes, int i, const SightEnd& end) {
  const bool surface = end.kind == kSightSurface || end.kind == kSightBothSides;
  lanes.x[i] = end.position.x, lanes.y[i] = end.position.y, lanes.z[i] = end.position.z;
  lanes.normal_x[i] = surface ? end.normal.x : 0.0f;
  lanes.normal_y[i] = surface ? end.normal.y : 0.0f;
  lanes.normal_z[i] = surface ? end.normal.z : 0.0f;
  lanes.offset[i] = surface ? end.offset : 0.0f;
  lanes.near[i] = end.kind == kSightDirectional ? 0.0f : 1.0f;
  lanes.both[i] = end.kind == kSightBothSides ? 1.0f : 0.0f;
  lanes.limit[i] = end.kind == kSightSurface ? 0.0f : end.kind < kSightNothing ? kFar : -kFar;
}

/// The lights of each set, as far as bits tell of them.
struct SetLanes {
  std::vector<LightLanes> lanes;
  std::vector<std::size_t> first, groups;  // of each set, in `lanes`
};

SetLanes layOut(const LightRows& lights, std::span<const SightSet> sets, std::uint32_t words) {
  SetLanes result;
  for (const SightSet& set : sets) {
    const std::size_t left = set.first < lights.count ? lights.count - set.first : 0;
    const std::size_t count = std::min({std::size_t(set.count), left, std::size_t(words) * 32});
    result.first.push_back(result.lanes.size());
    result.groups.push_back((count + kLanes - 1) / kLanes);
    for (std::size_t k = 0; k < result.groups.back() * kLanes; ++k) {
      if (k % kLanes == 0) result.lanes.emplace_back();
      SightEnd end{};
      end.kind = kSightNothing;
      if (k < count) std::memcpy(&end, lights.first + (set.first + k) * lights.stride, sizeof end);
      setLane(result.lanes.back(), int(k % kLanes), end);
    }
  }
  return result;
}

/// Rays from a point whose surface the lights stand before, and which stand in front of theirs: a bit each.
std::uint32_t makeRays(const SightPoint& point, const glm::vec3& origin, const LightLanes& lights,
                       trace::RayPacket& packet, trace::LaneMask& mask) {
  for (int i = 0; i < kLanes; ++i) {
    const float px = lights.x[i] - lights.near[i] * origin.x, py = lights.y[i] - lights.near[i] * origin.y,
                pz = lights.z[i] - lights.near[i] * origin.z;
    const float facing = lights.normal_x[i] * px + lights.normal_y[i] * py + lights.normal_z[i] * pz;
    const float side = lights.offset[i] * (facing > 0.0f ? 1.0f - 2.0f * lights.both[i] : 1.0f);
    const float x = px + side * lights.normal_x[i], y = py + side * lights.normal_y[i],
                z = pz + side * lights.normal_z[i];
    const float squared = x * x + y * y + z * z;
    const float length = std::sqrt(squared), inverse = 1.0f / length;
    packet.direction_x[i] = x * inverse, packet.direction_y[i] = y * inverse,
    packet.direction_z[i] = z * inverse;
    packet.t_far[i] = lights.near[i] > 0.0f ? length : kFar;
    const bool seen = (facing < lights.limit[i]) &
                      (point.normal.x * px + point.normal.y * py + point.normal.z * pz > 0.0f) &
                      (squared > 0.0f);
    mask.lane[i] = -std::int32_t(seen);
  }
  std::uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= std::uint32_t(mask.lane[i] & 1) << i;
  return bits;
}

glm::vec3 originOf(const SightPoint& point) {
  return point.position + point.offset * point.normal;
}

bool asks(const SightPoint& point, std::size_t set_count) {
  return point.set < set_count && point.normal != glm::vec3(0.0f);
}

}  // namespace

std::uint64_t traceSight(const trace::Tracer& tracer, std::span<const SightPoint> points,
                         const LightRows& lights, std::span<const SightSet> sets, std::uint32_t words,
                         std::span<std::uint32_t> visible) {
  const SetLanes by_set = layOut(lights, sets, words);
  std::atomic<std::uint64_t> rays{0};
  const auto traceRange = [&](std::size_t begin, std::size_t end) {
    trace::RayPacket packet;
    trace::LaneMask mask;
    std::uint64_t traced = 0;
    for (std::size_t p = begin; p < end; ++p) {
      for (std::uint32_t w = 0; w < words; ++w) visible[w * points.size() + p] = 0;
      if (!asks(points[p], sets.size())) continue;
      const glm::vec3 origin = originOf(points[p]);
      packet.setOrigin(origin);
      for (std::size_t g = 0; g < by_set.groups[points[p].set]; ++g) {
        const std::uint32_t bits =
            makeRays(points[p], origin, by_set.lanes[by_set.first[points[p].set] + g], packet, mask);
        if (bits == 0) continue;
        tracer.occluded(packet, mask, true);
        std::uint32_t open = 0;
        for (int i = 0; i < kLanes; ++i) open |= std::uint32_t(!(packet.t_far[i] < 0.0f)) << i;
        visible[g / 2 * points.size() + p] |= (open & bits) << (g % 2 * 16);
        traced += std::uint64_t(__builtin_popcount(bits));
      }
    }
    rays.fetch_add(traced, std::memory_order_relaxed);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256),
                    [&](const auto& range) { traceRange(range.begin(), range.end()); });
  return rays.load();
}

std::vector<trace::LoggedRay> sightRays(std::span<const SightPoint> points, const LightRows& lights,
                                        std::span<const SightSet> sets, std::uint32_t words) {
  const SetLanes by_set = layOut(lights, sets, words);
  std::vector<trace::LoggedRay> rays;
  trace::RayPacket packet;
  trace::LaneMask mask;
  for (const SightPoint& point : points) {
    if (!asks(point, sets.size())) continue;
    const glm::vec3 origin = originOf(point);
    for (std::size_t g = 0; g < by_set.groups[point.set]; ++g) {
      const std::uint32_t bits =
          makeRays(point, origin, by_set.lanes[by_set.first[point.set] + g], packet, mask);
      for (int i = 0; i < kLanes; ++i) {
        if ((bits >> i & 1u) == 0) continue;
        const glm::vec3 direction(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
        rays.push_back({{origin, direction, 0.0f, packet.t_far[i]}, true});
      }
    }
  }
  return rays;
}

}  // namespace gloam::visibility
