// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Beyond Nichols and Wyman 2009, who leave visibility out: a ray from every subsplat to every light that it faces.
#include "techniques/splatting/splatting_visibility.h"

namespace gloam::splatting {

namespace {

/// A texel's mean lies below a surface that bulges, by a twentieth of its side at most where normals vary by as much as lets it stay whole.
constexpr float kSag = 0.05f;
/// A light of a cell lies below the surface that it stands for, too: parts of its radius.
constexpr float kLightOffset = 0.1f;

struct Sources {
  gpu::BufferRef view, counts, points, rows, vpl_count;
  const frame::GpuScene* scene;
};

void loadPlaces(const Sources& from, int k, const gpu::HostAccess& access, LevelPlaces& shared) {
  const auto counts = access.download<Counts>(from.counts).at(0);
  const auto view = access.download<frame::FrameView>(from.view).at(0);
  const std::size_t count = counts.leaves[k], first = counts.first_leaf[k];
  shared.lights = access.download<std::uint32_t>(from.vpl_count).at(0);
  shared.loaded = true;
  if (count == 0) return;
  const auto points = access.download<Subsplat>(from.points.slice(0, (first + count) * sizeof(Subsplat)));
  const float pixel = std::max(glm::length(view.step_x), glm::length(view.step_y));
  const float least = 1e-5f * glm::distance(from.scene->boundsMin(), from.scene->boundsMax());
  for (std::size_t i = first; i < first + count; ++i) {
    const float along =
        view.depth_range > 0.0f ? 1.0f : glm::dot(points[i].position - view.eye, view.forward);
    const float side = float(1 << k) * pixel * along, length = glm::length(points[i].normal);
    shared.places.push_back({points[i].position, length > 0.0f ? points[i].normal / length : glm::vec3(0.0f),
                             (k > 0 ? kSag * side : 0.0f) + least});
  }
}

std::vector<visibility::Place> lightsOf(std::span<const vpls::VplRow> rows, float least) {
  std::vector<visibility::Place> lights;
  for (const vpls::VplRow& row : rows)
    lights.push_back({row.position, row.normal, kLightOffset * std::sqrt(row.bound) + least});
  return lights;
}

}  // namespace

void recordVisibility(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Subsplats& subsplats,
                      const vpls::Vpls& vpls, visibility::HostRays& rays, const VisibilityChunk& chunk,
                      std::shared_ptr<LevelPlaces> shared) {
  const Sources from{inputs.view, subsplats.counts, subsplats.points, vpls.rows, vpls.count, &inputs.scene};
  auto& pass = graph.host("splatting.visibility");
  visibility::HostRays::reads(pass, inputs.scene);
  pass.read(from.view)
      .read(from.counts)
      .read(from.points)
      .read(from.rows)
      .read(from.vpl_count)
      .write(chunk.visible);
  pass.run([from, chunk, shared, rows = vpls.chunk(chunk.chunk), &rays](gpu::HostAccess& access) {
    rays.update(access, *from.scene);
    if (!shared->loaded) loadPlaces(from, chunk.level, access, *shared);
    if (shared->places.empty() || chunk.chunk * std::size_t(vpls::kVplChunk) >= shared->lights) return;
    const float least = 1e-5f * glm::distance(from.scene->boundsMin(), from.scene->boundsMax());
    const auto lights = lightsOf(access.download<vpls::VplRow>(rows), least);
    std::vector<std::uint64_t> bits(shared->places.size());
    rays.trace(shared->places, lights, bits);
    access.upload(chunk.visible, std::span<const std::uint64_t>(bits));
  });
}

}  // namespace gloam::splatting
