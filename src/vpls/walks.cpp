// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "vpls/walks.h"

#include "math/punctual.h"
#include "shaders/vpls_shaders.h"
#include "vpls/walk_choice.h"
#include "vpls/walk_rows.h"

namespace gloam::vpls {

using visibility::SightPoint;
using visibility::SightSet;

float discCosine(float height, float squared_distance, float bound) {
  const float squared_height = height * height;
  const float beside = std::max(squared_distance - squared_height - kDiscReach * bound, 0.0f);
  return height / std::sqrt(std::max(squared_height + beside + kDiscSoftness * bound,
                                     punctual::kLeastSquaredDistance));
}

glm::vec3 walkIrradiance(const WalkVpl& vpl, const glm::vec3& position, glm::vec3& to_light) {
  to_light = vpl.end.position;
  if (vpl.end.kind == visibility::kSightDirectional) return vpl.light;
  const glm::vec3 between = vpl.end.position - position;
  const float squared = std::max(glm::dot(between, between), punctual::kLeastSquaredDistance);
  const float distance = std::sqrt(squared);
  to_light = between / distance;
  float cosine = -glm::dot(to_light, vpl.end.normal);
  if (vpl.end.kind == visibility::kSightLamp)
    return vpl.light * (punctual::rangeFactor(distance, vpl.range) *
                        punctual::coneFactor(cosine, vpl.cos_inner, vpl.cos_outer) / squared);
  cosine = vpl.end.kind == visibility::kSightBothSides
               ? std::abs(cosine)
               : discCosine(std::max(cosine, 0.0f) * distance, squared, vpl.bound);
  return vpl.light * (cosine / std::max(squared, vpl.bound));
}

struct Walker::State {
  Emitters emitters;
  EnvironmentTable environment;
  std::uint64_t environment_revision = 0, pose_revision = 0, layout_revision = 0;

  void follow(const visibility::HostWorld& world) {
    if (pose_revision == world.poseRevision() && layout_revision == world.layoutRevision()) return;
    emitters = Emitters(world);
    pose_revision = world.poseRevision();
    layout_revision = world.layoutRevision();
  }
};

namespace {

constexpr float kLeastHill = 0.01f;  // of the scene's size

/// Points that the camera sees.
gpu::BufferRef recordSeen(gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
  const gpu::BufferRef seen =
      graph.create("vpls.seen", gpu::BufferDesc{.bytes = kSeenPoints * sizeof(SightPoint)});
  graph.compute("vpls.seen", vpls_seen_spv)
      .read("frame_view", inputs.view)
      .read("depth", inputs.gbuffer.depth)
      .read("normals", inputs.gbuffer.normals)
      .write("seen", seen)
      .dispatchOver(int(kSeenPoints));
  return seen;
}

bool shinesFromAfar(const frame::FrameInputs& inputs) {
  return !inputs.environment.empty() ||
         std::ranges::any_of(inputs.shadow_maps.lights, [](const frame::LightRow& lamp) {
           return lamp.kind == frame::kLightDirectional;
         });
}

}  // namespace

Walker::Walker() : state_(std::make_unique<State>()) {}
Walker::~Walker() = default;

Walks Walker::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const WalkOptions& options,
                     visibility::HostWorld& world) {
  const std::vector<frame::LightRow>& lamps = inputs.shadow_maps.lights;
  const WalkPlan plan = planWalks(options, lamps.size(), 1);
  const WalkPlan candidates = planWalks(options, lamps.size(), options.candidates);
  Walks walks;
  walks.stride = plan.stride();
  walks.set_count = walks.stride > 0 ? std::uint32_t(plan.sets) : 0;
  if (walks.set_count == 0) return {};
  walks.rows = graph.create("vpls.walk_rows", gpu::BufferDesc{.bytes = std::size_t(walks.set_count) *
                                                                       walks.stride * sizeof(WalkVpl)});
  walks.sets = graph.create("vpls.walk_sets", gpu::BufferDesc{.bytes = walks.set_count * sizeof(SightSet)});
  State& s = *state_;
  if (s.environment_revision != inputs.environment.revision()) {
    s.environment = EnvironmentTable(inputs.environment);
    s.environment_revision = inputs.environment.revision();
  }
  const bool focuses = options.focus && plan.indirect() > 0 && shinesFromAfar(inputs);
  const gpu::BufferRef seen =
      options.candidates > 1 || focuses ? recordSeen(graph, inputs) : gpu::BufferRef();
  auto& pass = graph.host("vpls.walks");
  visibility::HostWorld::reads(pass, inputs.scene);
  if (seen) pass.read(seen);
  pass.write(walks.rows).write(walks.sets);
  pass.run([&s, &world, &scene = inputs.scene, plan, candidates, walks, lamps, seen, focuses,
            chooses = options.candidates > 1](gpu::HostAccess& access) {
    world.update(access, scene);
    const visibility::WorldTracer& tracer = world.tracer();  // built here, not by the threads that trace
    s.follow(world);
    std::vector<SightPoint> points;
    if (seen) points = access.download<SightPoint>(seen);
    std::erase_if(points, [](const SightPoint& point) { return point.normal == glm::vec3(0.0f); });
    WalkLights lights{world, lamps, s.emitters, s.environment, scene.boundsMin(), scene.boundsMax()};
    if (focuses) lights.focus = Focus(points, kLeastHill * glm::distance(lights.low, lights.high));
    std::vector<WalkVpl> rows = makeRows(candidates, lights);
    if (chooses) rows = chooseRows(candidates, rows, plan, tracer, points);
    std::vector<SightSet> sets;
    for (std::size_t k = 0; k < std::size_t(plan.sets); ++k) sets.push_back(packRows(plan, k, rows));
    access.upload(walks.rows, std::span<const WalkVpl>(rows));
    access.upload(walks.sets, std::span<const SightSet>(sets));
  });
  return walks;
}

}  // namespace gloam::vpls
