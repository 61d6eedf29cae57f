// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_rays.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstring>

#include "trace/tracer.h"

namespace gloam::visibility {

struct HostRays::State {
  Scene scene;
  std::unique_ptr<trace::Tracer> tracer;
  std::uint64_t layout = 0;
  std::vector<frame::InstanceRow> rows;  // as the tracer has them
  std::vector<glm::vec3> positions;      // of meshes that do not deform
  std::vector<std::uint32_t> indices;
  mutable std::atomic<std::uint64_t> rays{0};
};

namespace {

bool anyDeformed(const frame::GpuScene& scene) {
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    if (scene.deformed(i)) return true;
  }
  return false;
}

bool sameRows(std::span<const frame::InstanceRow> a, std::span<const frame::InstanceRow> b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].world_from_object != b[i].world_from_object || a[i].first_vertex != b[i].first_vertex)
      return false;
  }
  return true;
}

/// One mesh of all triangles in the world.
Mesh worldMesh(const frame::GpuScene& scene, std::span<const glm::vec3> positions,
               std::span<const std::uint32_t> indices) {
  Mesh mesh;
  mesh.name = "scene";
  for (const frame::InstanceRow& row : scene.instances()) {
    const frame::GpuMesh& part = scene.meshes()[row.mesh];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t v = 0; v < part.vertex_count; ++v)
      mesh.positions.push_back(row.world_from_object * glm::vec4(positions[row.first_vertex + v], 1.0f));
    for (std::uint32_t i = 0; i < part.index_count; ++i)
      mesh.indices.push_back(first + indices[part.row.first_index + i]);
  }
  return mesh;
}

}  // namespace

HostRays::HostRays() : state_(std::make_unique<State>()) {}
HostRays::~HostRays() = default;

void HostRays::reads(gpu::HostPass& pass, const frame::GpuScene& scene) {
  pass.read(scene.positions()).read(scene.indices());
}

void HostRays::update(const gpu::HostAccess& access, const frame::GpuScene& scene) {
  State& s = *state_;
  const bool deformed = anyDeformed(scene), same_layout = s.tracer && s.layout == scene.layoutRevision();
  if (same_layout && !deformed && sameRows(s.rows, scene.instances())) return;
  if (!same_layout || deformed) s.positions = access.download<glm::vec3>(scene.positions());
  if (!same_layout) s.indices = access.download<std::uint32_t>(scene.indices());
  s.layout = scene.layoutRevision();
  s.rows.assign(scene.instances().begin(), scene.instances().end());
  s.tracer.reset();
  s.scene = Scene{};
  s.scene.materials.emplace_back();
  s.scene.meshes.push_back(worldMesh(scene, s.positions, s.indices));
  s.scene.meshes.back().material = 0;
  PosedScene posed;
  Instance whole;
  whole.mesh = 0;
  posed.instances.push_back(whole);
  s.tracer = std::make_unique<trace::Tracer>(s.scene, posed);
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
      s.tracer->occluded(packet, mask, false);
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
