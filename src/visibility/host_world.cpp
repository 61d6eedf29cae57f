// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/host_world.h"

#include "visibility/host_scene.h"

namespace gloam::visibility {

struct HostWorld::State {
  Scene scene;
  PosedScene posed;
  std::vector<bool> moves;                      // that ever moved, since the set of instances is this one
  mutable std::unique_ptr<WorldTracer> tracer;  // as of tracer_pose
  mutable std::uint64_t tracer_pose = 0;
  std::uint64_t layout = 0, pose = 0;
};

namespace {

/// All vertices as the device has them, where any instance is deformed; else none.
std::vector<glm::vec3> deformedVertices(const gpu::HostAccess& access, const frame::GpuScene& scene) {
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    if (scene.deformed(i)) return access.download<glm::vec3>(scene.positions());
  }
  return {};
}

Instance instanceOf(const frame::GpuScene& scene, std::size_t index, std::span<const glm::vec3> vertices) {
  const frame::InstanceRow& row = scene.instances()[index];
  Instance instance;
  instance.mesh = int(row.mesh);
  if (scene.deformed(index)) {
    const auto own = vertices.subspan(row.first_vertex, scene.meshes()[row.mesh].vertex_count);
    instance.deformed_positions.assign(own.begin(), own.end());
  } else {
    instance.world_from_object = glm::mat4(row.world_from_object);
  }
  return instance;
}

bool same(const Instance& a, const Instance& b) {
  return a.mesh == b.mesh && a.world_from_object == b.world_from_object &&
         a.deformed_positions == b.deformed_positions;
}

}  // namespace

HostWorld::HostWorld() : state_(std::make_unique<State>()) {}
HostWorld::~HostWorld() = default;

void HostWorld::reads(gpu::HostPass& pass, const frame::GpuScene& scene) {
  pass.read(scene.positions()).read(scene.indices());
}

void HostWorld::update(const gpu::HostAccess& access, const frame::GpuScene& scene) {
  State& s = *state_;
  const std::vector<glm::vec3> vertices = deformedVertices(access, scene);
  PosedScene posed;
  for (std::size_t i = 0; i < scene.instances().size(); ++i)
    posed.instances.push_back(instanceOf(scene, i, vertices));
  posed.bounds_min = scene.boundsMin();
  posed.bounds_max = scene.boundsMax();
  bool moved = false;
  if (s.layout != scene.layoutRevision()) {
    s.tracer.reset();  // refers to the scene
    s.scene = downloadScene(scene);
    s.layout = scene.layoutRevision();
    s.moves.assign(posed.instances.size(), false);
    moved = true;
  } else {
    for (std::size_t i = 0; i < posed.instances.size(); ++i) {
      if (same(posed.instances[i], s.posed.instances[i])) continue;
      s.moves[i] = moved = true;
    }
  }
  if (!moved) return;
  s.posed = std::move(posed);
  ++s.pose;
}

const WorldTracer& HostWorld::tracer() const {
  const State& s = *state_;
  if (!s.tracer || s.tracer_pose != s.pose)
    s.tracer = std::make_unique<WorldTracer>(s.scene, s.posed, s.moves, std::move(s.tracer));
  s.tracer_pose = s.pose;
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
