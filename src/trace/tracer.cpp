// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/tracer.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <vector>

#include "trace/alpha_filter.h"
#include "trace/embree.h"

namespace gloam::trace {

static_assert(sizeof(RayPacket) == sizeof(RTCRay16) && alignof(RayPacket) >= alignof(RTCRay16));
static_assert(offsetof(RayPacket, t_near) == offsetof(RTCRay16, tnear));
static_assert(offsetof(RayPacket, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket, t_far) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket, flags) == offsetof(RTCRay16, flags));

struct Tracer::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<AlphaMask> alpha_masks;  // one an instance, never moved: filters point into it
  std::vector<std::uint8_t> mirrored;  // one an instance
  std::vector<Triangles> buffers;      // one an instance; the geometry owns them
  std::atomic<std::int64_t> memory_bytes{0};

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

namespace {

bool countMemory(void* bytes, ssize_t change, bool) {
  static_cast<std::atomic<std::int64_t>*>(bytes)->fetch_add(change, std::memory_order_relaxed);
  return true;
}

// Embree calls from several threads at once, listeners are promised one at a time: who finds it taken skips its turn.
struct BuildListener {
  const Progress& progress;
  std::mutex mutex;
};

bool monitorBuild(void* data, double fraction) {
  auto& listener = *static_cast<BuildListener*>(data);
  const std::unique_lock lock(listener.mutex, std::try_to_lock);
  if (!lock) return true;
  listener.progress.report(fraction, "building the ray hierarchy");
  return !listener.progress.stopRequested();
}

// The arrays are written anew rather than shared: the tracing library wants world space and padding at the end.
Tracer::Triangles fillBuffers(RTCGeometry geometry, const Mesh& mesh, const Instance& instance) {
  const std::size_t vertices = mesh.vertexCount();
  auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertices));
  auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangleCount()));
  if (!positions || !indices)
    throw Error("ray hierarchy", "no memory for the triangles of mesh '" + mesh.name + "'");
  for (std::size_t i = 0; i < vertices; ++i) {
    positions[i] = instance.deformed()
                       ? instance.deformed_positions[i]
                       : glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f));
  }
  std::memcpy(indices, mesh.indices.data(), mesh.triangleCount() * sizeof(glm::uvec3));
  return {positions, indices};
}

RTCGeometry makeGeometry(RTCDevice device, const Mesh& mesh, const Instance& instance,
                         Tracer::Triangles& buffers) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!geometry) throw Error("ray hierarchy", "no memory");
  try {
    buffers = fillBuffers(geometry, mesh, instance);
  } catch (...) {
    rtcReleaseGeometry(geometry);
    throw;
  }
  return geometry;
}

void checkBuilt(RTCDevice device, std::size_t triangles) {
  switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_CANCELLED:
      throw Interrupted("stopped while the ray hierarchy was built");
    case RTC_ERROR_OUT_OF_MEMORY:
      throw Error("ray hierarchy", fmt::format("{} triangles do not fit into memory", triangles));
    default:
      throw Error("ray hierarchy", "Embree could not build it");
  }
}

RTCRay embreeRay(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          ray.t_near,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0.0f,
          ray.t_far,
          ~0u,
          0u,
          0u};
}

glm::vec3 unit(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0.0f ? v * (1.0f / length) : v;
}

}  // namespace

Tracer::Tracer(const Scene& scene, const PosedScene& posed, const TracerOptions& options,
               const Progress& progress)
    : embree_(std::make_unique<Embree>()) {
  Embree& e = *embree_;
  e.device = rtcNewDevice(nullptr);
  if (!e.device) throw Error("ray hierarchy", "Embree cannot start on this machine");
  rtcSetDeviceMemoryMonitorFunction(e.device, countMemory, &e.memory_bytes);
  e.scene = rtcNewScene(e.device);
  rtcSetSceneFlags(e.scene, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  e.alpha_masks.resize(posed.instances.size());
  e.mirrored.resize(posed.instances.size());
  e.buffers.resize(posed.instances.size());
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const Instance& instance = posed.instances[i];
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (mesh.indices.empty() || (options.rigid_only && instance.deformed())) continue;
    RTCGeometry geometry = makeGeometry(e.device, mesh, instance, e.buffers[i]);
    e.mirrored[i] = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
    e.alpha_masks[i] = {&scene, &mesh};
    if (hasHoles(scene, mesh)) setAlphaFilter(geometry, e.alpha_masks[i]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(e.scene, geometry, unsigned(i));
    rtcReleaseGeometry(geometry);
    triangle_count_ += mesh.triangleCount();
  }
  BuildListener listener{progress, {}};
  rtcSetSceneProgressMonitorFunction(e.scene, monitorBuild, &listener);
  if (options.reproducible) {
    tbb::task_arena(1).execute([&] { rtcCommitScene(e.scene); });
  } else {
    rtcCommitScene(e.scene);
  }
  rtcSetSceneProgressMonitorFunction(e.scene, nullptr, nullptr);
  checkBuilt(e.device, triangle_count_);
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

std::size_t Tracer::memoryBytes() const {
  return std::size_t(std::max<std::int64_t>(0, embree_->memory_bytes.load()));
}

Tracer::Triangles Tracer::triangles(int instance) const {
  return embree_->buffers[std::size_t(instance)];
}

float Tracer::surfaceOffset(const Hit& hit) const {
  const auto& [positions, vertices] = embree_->buffers[std::size_t(hit.instance)];
  const glm::uvec3& v = vertices[hit.triangle];
  return trace::surfaceOffset(positions[v.x], positions[v.y], positions[v.z]);
}

Hit Tracer::closest(const Ray& ray) const {
  RTCRayHit query;
  query.ray = embreeRay(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embreeIntersect1(embree_->scene, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const glm::vec3 normal = unit({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
  return {int(query.hit.geomID), int(query.hit.primID),
          query.ray.tfar,        query.hit.u,
          query.hit.v,           embree_->mirrored[query.hit.geomID] ? -normal : normal};
}

bool Tracer::occluded(const Ray& ray) const {
  RTCRay query = embreeRay(ray);
  embreeOccluded1(embree_->scene, &query);
  return query.tfar < 0.0f;
}

std::size_t Tracer::replay(std::span<const LoggedRay> rays) const {
  std::size_t hits = 0;
  for (const LoggedRay& logged : rays) {
    RTCRayHit query;
    query.ray = embreeRay(logged.ray);
    if (logged.occlusion) {
      embreeOccluded1(embree_->scene, &query.ray);
      hits += query.ray.tfar < 0.0f ? 1 : 0;
      continue;
    }
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embreeIntersect1(embree_->scene, &query);
    hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
  }
  return hits;
}

void Tracer::occluded(RayPacket& rays, const LaneMask& mask, bool coherent) const {
  embreeOccluded16(mask.lane, embree_->scene, reinterpret_cast<RTCRay16*>(&rays), coherent);
}

void Tracer::closest(const RayPacket& rays, const LaneMask& mask, bool coherent, HitPacket& hits) const {
  RTCRayHit16 query;
  std::memcpy(&query.ray, &rays, sizeof rays);
  std::fill(std::begin(query.hit.geomID), std::end(query.hit.geomID), RTC_INVALID_GEOMETRY_ID);
  embreeIntersect16(mask.lane, embree_->scene, &query, coherent);
  for (int i = 0; i < kPacketSize; ++i) {
    const unsigned geometry = query.hit.geomID[i];
    hits.instance[i] = kNoHit;
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    const float sign = embree_->mirrored[geometry] ? -1.0f : 1.0f;
    hits.instance[i] = std::int32_t(geometry);
    hits.triangle[i] = std::int32_t(query.hit.primID[i]);
    hits.distance[i] = query.ray.tfar[i];
    hits.u[i] = query.hit.u[i];
    hits.v[i] = query.hit.v[i];
    hits.normal_x[i] = sign * query.hit.Ng_x[i];
    hits.normal_y[i] = sign * query.hit.Ng_y[i];
    hits.normal_z[i] = sign * query.hit.Ng_z[i];
  }
}

}  // namespace gloam::trace
