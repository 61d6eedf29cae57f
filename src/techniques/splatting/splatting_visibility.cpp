// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Beyond Nichols and Wyman 2009, who leave visibility out: a ray from every subsplat to every light that it faces.
#include "techniques/splatting/splatting_visibility.h"

#include <glm/gtc/packing.hpp>

#include "visibility/host_sight.h"

namespace gloam::splatting {

namespace {

/// A texel's mean lies below a surface that bulges, by a twentieth of its side at most where normals vary by as much as lets it stay whole.
constexpr float kSag = 0.05f;
/// A light of a cell lies below the surface that it stands for, too: parts of its radius.
constexpr float kLightOffset = 0.1f;
constexpr std::uint32_t kWords = vpls::kVplChunk / 32;

struct Sources {
  gpu::BufferRef view, counts, points, list, rows, light_count;
  const frame::GpuScene* scene;
};

int levelOf(const Counts& counts, std::uint32_t subsplat) {
  for (int k = 0; k < kMostLevels; ++k) {
    if (subsplat - counts.first_leaf[k] < counts.leaves[k]) return k;  // unsigned: before it is far beyond
  }
  return 0;
}

void loadPlaces(const Sources& from, const gpu::HostAccess& access, TracedPlaces& shared) {
  const auto counts = access.download<Counts>(from.counts).at(0);
  const auto view = access.download<frame::FrameView>(from.view).at(0);
  shared.lights = access.download<std::uint32_t>(from.light_count).at(0);
  shared.loaded = true;
  const std::size_t listed = counts.listed[0];
  if (listed == 0) return;
  const auto list = access.download<std::uint32_t>(from.list.slice(0, listed * sizeof(std::uint32_t)));
  const auto points = access.download<Subsplat>(from.points.slice(0, counts.subsplats * sizeof(Subsplat)));
  const float pixel = std::max(glm::length(view.step_x), glm::length(view.step_y));
  const float least = 1e-5f * glm::distance(from.scene->boundsMin(), from.scene->boundsMax());
  shared.points.reserve(listed);
  for (const std::uint32_t i : list) {
    const Subsplat& point = points.at(i);
    const glm::vec3 normal(glm::unpackSnorm2x16(point.normal.x), glm::unpackSnorm2x16(point.normal.y).x);
    const int k = levelOf(counts, i);
    const float along = view.depth_range > 0.0f ? 1.0f : glm::dot(point.position - view.eye, view.forward);
    const float side = float(1 << k) * pixel * along, length = glm::length(normal);
    shared.points.push_back({point.position, (k > 0 ? kSag * side : 0.0f) + least,
                             length > 0.0f ? normal / length : glm::vec3(0.0f), 0});
  }
}

std::vector<visibility::SightEnd> endsAt(std::span<const SplatLight> rows, float least) {
  std::vector<visibility::SightEnd> ends;
  for (const SplatLight& row : rows)
    ends.push_back(
        {row.position, visibility::kSightSurface, row.normal, kLightOffset * std::sqrt(row.bound) + least});
  return ends;
}

}  // namespace

void recordVisibility(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Subsplats& subsplats,
                      const LightSets& lights, visibility::HostWorld& world, const VisibilityChunk& chunk,
                      std::shared_ptr<TracedPlaces> shared) {
  const Sources from{inputs.view, subsplats.counts, subsplats.points, chunk.list,
                     lights.rows, lights.count,     &inputs.scene};
  auto& pass = graph.host("splatting.visibility");
  visibility::HostWorld::reads(pass, inputs.scene);
  pass.read(from.view)
      .read(from.counts)
      .read(from.points)
      .read(from.list)
      .read(from.rows)
      .read(from.light_count)
      .write(chunk.visible);
  pass.run([from, chunk, shared, rows = lights.chunk(0, chunk.chunk), &world](gpu::HostAccess& access) {
    world.update(access, *from.scene);
    if (!shared->loaded) loadPlaces(from, access, *shared);
    const std::span<const visibility::SightPoint> points = shared->points;
    if (points.empty() || std::size_t(chunk.chunk) * vpls::kVplChunk >= shared->lights) return;
    const float least = 1e-5f * glm::distance(from.scene->boundsMin(), from.scene->boundsMax());
    const auto ends = endsAt(access.download<SplatLight>(rows), least);
    const visibility::LightRows lights_of_chunk{.first = std::as_bytes(std::span(ends)).data(),
                                                .count = ends.size()};
    const visibility::SightSet all{.first = 0, .count = std::uint32_t(ends.size())};
    std::vector<std::uint32_t> bits(kWords * points.size());
    visibility::traceSight(world.tracer(), points, lights_of_chunk, {&all, 1}, kWords, bits);
    access.upload(chunk.visible.slice(0, bits.size() * sizeof(std::uint32_t)),
                  std::span<const std::uint32_t>(bits));
  });
}

}  // namespace gloam::splatting
