// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_world.h"

#include "visibility/host_scene.h"

namespace gloam::visibility {

struct HostWorld::State {
  Scene scene;
  PosedScene posed;
  mutable std::unique_ptr<trace::Tracer> tracer;  // made when it is first asked for
  std::uint64_t layout = 0, pose = 0;
  std::vector<frame::InstanceRow> rows;  // as the tracer has them
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

}  // namespace

HostWorld::HostWorld() : state_(std::make_unique<State>()) {}
HostWorld::~HostWorld() = default;

void HostWorld::reads(gpu::HostPass& pass, const frame::GpuScene& scene) {
  pass.read(scene.positions()).read(scene.indices());
}

void HostWorld::update(const gpu::HostAccess& access, const frame::GpuScene& scene) {
  State& s = *state_;
  const bool deformed = anyDeformed(scene), same_layout = s.layout == scene.layoutRevision();
  if (same_layout && !deformed && sameRows(s.rows, scene.instances())) return;
  s.tracer.reset();  // refers to the scene
  if (!same_layout) s.scene = downloadScene(scene);
  std::vector<glm::vec3> positions;
  if (deformed) positions = access.download<glm::vec3>(scene.positions());
  s.layout = scene.layoutRevision();
  ++s.pose;
  s.rows.assign(scene.instances().begin(), scene.instances().end());
  s.posed = PosedScene{};
  s.posed.bounds_min = scene.boundsMin();
  s.posed.bounds_max = scene.boundsMax();
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    Instance& instance = s.posed.instances.emplace_back();
    instance.mesh = int(s.rows[i].mesh);
    if (scene.deformed(i)) {
      const auto first = positions.begin() + s.rows[i].first_vertex;
      instance.deformed_positions.assign(first,
                                         first + std::ptrdiff_t(scene.meshes()[s.rows[i].mesh].vertex_count));
    } else {
      instance.world_from_object = glm::mat4(s.rows[i].world_from_object);
    }
  }
}

const trace::Tracer& HostWorld::tracer() const {
  const State& s = *state_;
  if (!s.tracer) s.tracer = std::make_unique<trace::Tracer>(s.scene, s.posed);
  return *s.tracer;
}
const Scene& HostWorld::scene() const {
  return state_->scene;
}
const PosedScene& HostWorld::posed() const {
  return state_->posed;
}
std::uint64_t HostWorld::layoutRevision() const {
  return state_->layout;
}
std::uint64_t HostWorld::poseRevision() const {
  return state_->pose;
}

}  // namespace gloam::visibility
