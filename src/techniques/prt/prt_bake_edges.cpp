// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace gloam::prt {

std::size_t crowdedEdges(const Mesh& mesh) {
  std::vector<std::uint32_t> sorted(mesh.positions.size()), place(sorted.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const glm::vec3& p = mesh.positions[v];
    return std::array<float, 3>{p.x, p.y, p.z};
  };
  std::ranges::sort(sorted, {}, key);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    place[sorted[i]] = i > 0 && key(sorted[i]) == key(sorted[i - 1]) ? place[sorted[i - 1]] : sorted[i];
  std::vector<std::uint64_t> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t corners[3] = {place[mesh.indices[t]], place[mesh.indices[t + 1]],
                                      place[mesh.indices[t + 2]]};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      if (low != high) edges.push_back(std::uint64_t(low) << 32 | high);
    }
  }
  std::ranges::sort(edges);
  std::size_t crowded = 0;
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end] == edges[first]) ++end;
    crowded += end - first > 2;
  }
  return crowded;
}

std::string crowdedEdgesText(const Scene& scene, const PosedScene& posed) {
  std::vector<std::uint8_t> seen(scene.meshes.size(), 0);
  std::size_t edges = 0, meshes = 0;
  std::string first;
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (instance.deformed() || seen[std::size_t(instance.mesh)]++) continue;
    const std::size_t crowded = crowdedEdges(mesh);
    if (crowded == 0) continue;
    edges += crowded;
    if (++meshes == 1)
      first = mesh.name.empty() ? fmt::format("mesh {}", instance.mesh) : fmt::format("mesh '{}'", mesh.name);
  }
  if (edges == 0) return {};
  return fmt::format("{}{} no manifold: {} more than two triangles", first,
                     meshes > 1 ? fmt::format(" and {} more are", meshes - 1) : " is",
                     edges > 1 ? fmt::format("{} edges have", edges) : "1 edge has");
}

void warnOfCrowdedEdges(const Scene& scene, const PosedScene& posed, Warnings& warnings) {
  const std::string text = crowdedEdgesText(scene, posed);
  if (!text.empty())
    warnings.push_back(text + "; baked as it stands, every vertex by its own normal, backs block");
}

}  // namespace gloam::prt
