// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 4 and 6.1: incident lighting is sampled at one or several points near the object
// and taken for all of it, or blended. Differs from the paper: light is kept apart by what sent it, so that direct and
// indirect stay apart in the picture; objects see one another as they were lit a pass before, all within the frame.
#include "techniques/prt/prt_local.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "scene/transforms.h"
#include "shaders/prt_shaders.h"

namespace gloam::prt {

namespace {

constexpr int kSurfacePoints = 3000;
/// Weights have no peak nearer to a probe than this share of the spacing of an object's probes.
constexpr float kSoftness = 0.2f;
constexpr float kNear = 1e-3f;  ///< where a cube's picture begins, of the object's extent

std::array<float, 6> bandFactors(frame::Window window, int order) {
  std::array<float, 6> factors;
  for (int l = 0; l < 6; ++l) {
    const float x = std::numbers::pi_v<float> * float(l) / float(order);
    factors[std::size_t(l)] = 1.0f;
    if (window == frame::Window::kHann) factors[std::size_t(l)] = 0.5f + 0.5f * std::cos(x);
    if (window == frame::Window::kLanczos && l > 0) factors[std::size_t(l)] = std::sin(x) / x;
  }
  return factors;
}

glm::mat4 worldFromObject(const frame::InstanceRow& row) {
  return glm::mat4(row.world_from_object);
}

}  // namespace

LocalLight::LocalLight(const frame::GpuScene& scene, const TransferBuffers& transfer, int points)
    : points_(points) {
  findObjects(scene, transfer);
  pick(scene, transfer);
}

// The k-th copy of a mesh belongs to the k-th copy of its object.
void LocalLight::findObjects(const frame::GpuScene& scene, const TransferBuffers& transfer) {
  std::map<std::uint32_t, int> copies;
  std::map<std::pair<int, int>, std::uint32_t> known;
  groups_.assign(scene.instances().size(), frame::kNoGroup);
  for (const std::uint32_t i : transfer.litInstances()) {
    const std::uint32_t mesh = scene.instances()[i].mesh;
    const std::pair key(scene.meshes()[mesh].transfer->object, copies[mesh]++);
    const auto [place, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(objects_.size()));
    if (is_new) objects_.push_back({.anchor = i, .points = {}});
    object_of_lit_.push_back(place->second);
    groups_[i] = place->second;
  }
}

void LocalLight::pick(const frame::GpuScene& scene, const TransferBuffers& transfer) {
  const auto positions = scene.positions().buffer().download<glm::vec3>();
  const auto normals = scene.normals().buffer().download<glm::vec3>();
  const auto indices = scene.indices().buffer().download<std::uint32_t>();
  std::vector<SurfaceSampler> surfaces(objects_.size());
  for (std::size_t n = 0; n < object_of_lit_.size(); ++n) {
    const frame::InstanceRow& row = scene.instances()[transfer.litInstances()[n]];
    const frame::GpuMesh& mesh = scene.meshes()[row.mesh];
    const LocalObject& object = objects_[object_of_lit_[n]];
    const glm::mat4 anchor = worldFromObject(scene.instances()[object.anchor]);
    surfaces[object_of_lit_[n]].add(std::span(positions).subspan(row.first_vertex, mesh.vertex_count),
                                    std::span(normals).subspan(row.first_vertex, mesh.vertex_count),
                                    std::span(indices).subspan(mesh.row.first_index, mesh.index_count),
                                    transfer.litInstances()[n] == object.anchor
                                        ? glm::mat4(1.0f)
                                        : glm::inverse(anchor) * worldFromObject(row));
  }
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    const SurfacePoints surface = surfaces[o].points(kSurfacePoints);
    objects_[o].points = pickPoints(surface, points_);
    glm::vec3 low(0.0f), high(0.0f);
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      low = i == 0 ? surface.positions[i] : glm::min(low, surface.positions[i]);
      high = i == 0 ? surface.positions[i] : glm::max(high, surface.positions[i]);
    }
    objects_[o].extent = std::max(glm::length(high - low), 1e-6f);
  }
}

std::vector<frame::ProbePlace> LocalLight::placesNow(const frame::GpuScene& scene) const {
  std::vector<frame::ProbePlace> places;
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    const glm::mat4 world = worldFromObject(scene.instances()[objects_[o].anchor]);
    const float scale = std::cbrt(std::abs(glm::determinant(glm::mat3(world))));
    for (const glm::vec3& point : objects_[o].points)
      places.push_back({glm::vec3(world * glm::vec4(point, 1.0f)),
                        std::max(kNear * objects_[o].extent * scale, 1e-6f), static_cast<std::uint32_t>(o)});
  }
  return places;
}

std::vector<LocalRow> LocalLight::rowsNow(const frame::GpuScene& scene, const TransferBuffers& transfer,
                                          std::vector<frame::ProbeReceiver>& receivers) const {
  std::vector<LocalRow> rows;
  std::vector<std::uint32_t> first_of_known;  // of jobs, an object and rotation each
  std::vector<std::pair<std::uint32_t, glm::mat3>> known;
  std::uint32_t output = 0;
  for (std::size_t n = 0; n < object_of_lit_.size(); ++n) {
    const std::uint32_t o = object_of_lit_[n];
    const frame::InstanceRow& instance = scene.instances()[transfer.litInstances()[n]];
    const frame::GpuMesh& mesh = scene.meshes()[instance.mesh];
    const glm::mat4 world = worldFromObject(instance);
    const glm::mat3 object_from_world = glm::transpose(rotationFactor(glm::mat3(world)));
    const auto same = std::ranges::find(known, std::pair(o, object_from_world));
    const auto first_job = same == known.end() ? static_cast<std::uint32_t>(receivers.size())
                                               : first_of_known[std::size_t(same - known.begin())];
    const auto first_probe = o * static_cast<std::uint32_t>(points_);
    if (same == known.end()) {
      known.emplace_back(o, object_from_world);
      first_of_known.push_back(first_job);
      for (std::uint32_t k = 0; k < std::uint32_t(points_); ++k)
        receivers.push_back({first_probe + k, object_from_world});
    }
    const glm::mat3 anchor(worldFromObject(scene.instances()[objects_[o].anchor]));
    const float spacing = kSoftness * objects_[o].extent * std::cbrt(std::abs(glm::determinant(anchor))) /
                          std::sqrt(float(points_));
    LocalRow row{};
    row.world_from_object = glm::mat4x3(world);
    row.object_from_world = object_from_world;
    row.middle = glm::vec3(world * glm::vec4(0.5f * (mesh.bounds_min + mesh.bounds_max), 1.0f));
    row.first_output = output;
    row.first_vertex = mesh.transfer->ofTexels() ? kUnbaked : instance.first_vertex;
    row.first_job = first_job;
    row.first_probe = first_probe;
    row.softness = spacing * spacing;
    rows.push_back(row);
    output += static_cast<std::uint32_t>(mesh.transfer->direct.size() /
                                         std::size_t(mesh.transfer->order * mesh.transfer->order));
  }
  return rows;
}

std::vector<LocalRow> LocalLight::rowsOf(const frame::GpuScene& scene, const TransferBuffers& transfer,
                                         std::span<const std::uint32_t> first_outputs) const {
  std::vector<LocalRow> rows;
  for (std::size_t n = 0; n < lit_rows_.size(); ++n) {
    const std::uint32_t instance = transfer.litInstances()[n];
    if (first_outputs[instance] == kUnbaked) continue;
    rows.push_back(lit_rows_[n]);
    rows.back().first_output = first_outputs[instance];
    rows.back().first_vertex = scene.instances()[instance].first_vertex;
  }
  return rows;
}

void LocalLight::lightVertices(gpu::FrameGraph& graph, const frame::GpuScene& scene,
                               const frame::ShadowMaps& lamps, const TransferBuffers& transfer,
                               const LocalOptions& options, gpu::BufferRef output) const {
  const gpu::Limits& limits = graph.device().limits();
  LocalVerticesParams params{.lamp_count = static_cast<std::uint32_t>(lamps.lights.size()),
                             .lamps_direct = options.lamps ? 1u : 0u};
  std::ranges::copy(bandFactors(options.window, transfer.order()), params.band);
  for (const TransferChunk& chunk : transfer.chunks()) {
    params.block_count = chunk.block_count;
    const std::uint32_t columns = std::min(chunk.block_count, limits.max_group_count[0]);
    graph.compute("prt.local_vertices", prt_local_vertices_spv)
        .specialize("order", transfer.order())
        .specialize("has_indirect", transfer.hasIndirect())
        .specialize("half_float", transfer.options().half_float)
        .specialize("damped", options.damped)
        .specialize("points", points_)
        .read("blocks", chunk.blocks)
        .read("transfer_direct", chunk.direct)
        .read("transfer_indirect", chunk.indirect)
        .read("lights", lights_)
        .read("rows", rows_)
        .read("probe_places", places_)
        .read("trust", trust_)
        .read("positions", scene.positions())
        .read("normals", scene.normals())
        .read("lamps", lamps.light_rows)
        .read("lamps_seen", lamps_seen_)
        .write("vertex_light", output)
        .push(params)
        .dispatch(columns, (chunk.block_count + columns - 1) / columns);
  }
}

gpu::BufferRef LocalLight::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                  const TransferBuffers& transfer, frame::ProbeTables& tables,
                                  const LocalOptions& options) {
  const frame::GpuScene& scene = inputs.scene;
  const std::vector<frame::ProbePlace> places = placesNow(scene);
  std::vector<frame::ProbeReceiver> receivers;
  lit_rows_ = rowsNow(scene, transfer, receivers);
  std::vector<glm::vec3> positions;
  for (const frame::ProbePlace& place : places) positions.push_back(place.position);
  frame::Probes probes(graph, inputs, tables, "prt.local_cube", places, groups_,
                       {.size = options.size,
                        .order = transfer.order(),
                        .band_factors = bandFactors(options.window, transfer.order())});
  probes.setReceivers(receivers);
  rows_ = graph.upload("prt.local_rows", lit_rows_);
  places_ = graph.upload("prt.local_places", positions);
  lights_ = probes.lights();
  lamp_lights_ = probes.lampLights();
  lamps_seen_ = probes.lampsSeen();
  trust_ = probes.trust();

  const auto output = graph.create("prt.vertex_light",
                                   gpu::BufferDesc{.bytes = transfer.outputVertices() * sizeof(VertexLight)});
  graph.clear("prt.local_dark", output);
  const sh::ShRgb unlit =
      sh::convolve(frame::windowed(inputs.environment.sh(), transfer.order(), options.window),
                   sh::clampedCosine(transfer.order()));
  for (int pass = 0; pass <= options.bounces; ++pass) {
    // What transfer has made of lamps' light holds their direct part, too, where they shine through it.
    probes.gather({transfer.outputRows(), output}, pass == 0 || !options.lamps, unlit);
    lightVertices(graph, scene, inputs.shadow_maps, transfer, options, output);
  }
  return output;
}

}  // namespace gloam::prt
