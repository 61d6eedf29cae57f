// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 7.3 (SL-8): parents that bound their children, and a cut of them for each cluster of receivers.
// Differs: a cut takes all of an object at one level of its tree, so that which spheres of a level meet is known beforehand; and the
// reflection ratio is taken for a receiver that faces the parent, since a cluster may hold many normals.
#include <gloam/spheres.h>

#include <algorithm>

#include "shaders/spherical_lights_shaders.h"
#include "techniques/spherical_lights/spherical_lights_step.h"

namespace gloam::spherical_lights {

namespace {

/// Largest first: small ones are then mostly inside already.
Sphere boundOf(const Rows& rows, std::vector<std::uint32_t> leaves) {
  std::ranges::stable_sort(leaves, [&](std::uint32_t a, std::uint32_t b) {
    return rows.spheres[a].radius > rows.spheres[b].radius;
  });
  Sphere bound;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const SphereRow& row = rows.spheres[leaves[i]];
    const Sphere leaf{row.center, row.radius};
    bound = i == 0 ? leaf : boundingSphere(bound, leaf);
  }
  return bound;
}

SentRow meanGlow(const Rows& rows, std::span<const std::uint32_t> leaves) {
  SentRow mean{};
  float areas = 0.0f;
  for (const std::uint32_t leaf : leaves) {
    const float area = rows.spheres[leaf].radius * rows.spheres[leaf].radius;
    for (int i = 0; i < 16; ++i) mean.at[i] += area * rows.glow[leaf].at[i];
    areas += area;
  }
  for (glm::vec3& value : mean.at) value /= std::max(areas, 1e-30f);
  return mean;
}

void addLevel(Rows& rows, const ObjectRow& object, std::uint32_t number,
              const std::vector<std::vector<int>>& groups) {
  const auto first = std::uint32_t(rows.spheres.size());
  for (const std::vector<int>& group : groups) {
    std::vector<std::uint32_t> leaves;
    for (const int leaf : group) leaves.push_back(object.first + std::uint32_t(leaf));
    const Sphere bound = boundOf(rows, leaves);
    rows.coarse.push_back({std::uint32_t(rows.leaves.size()), std::uint32_t(leaves.size())});
    rows.leaves.insert(rows.leaves.end(), leaves.begin(), leaves.end());
    if (!rows.glow.empty()) rows.glow.push_back(meanGlow(rows, leaves));
    rows.spheres.push_back(
        {bound.center, bound.radius, 1.0f, 0.0f, 0u, 0u, number, first, std::uint32_t(groups.size())});
  }
  for (std::size_t i = first; i < rows.spheres.size(); ++i) {
    SphereRow& row = rows.spheres[i];
    row.first_listed = std::uint32_t(rows.listed.size());
    for (std::size_t j = first; j < rows.spheres.size(); ++j) {
      const SphereRow& other = rows.spheres[j];
      if (i != j && glm::distance(row.center, other.center) >= row.radius + other.radius)
        rows.listed.push_back(std::uint32_t(j));
    }
    row.listed = std::uint32_t(rows.listed.size()) - row.first_listed;
  }
  rows.levels.push_back({first, std::uint32_t(groups.size())});
}

}  // namespace

void addCoarse(Rows& rows, const frame::Emission& emission) {
  for (std::size_t o = 0; o < rows.objects.size(); ++o) {
    ObjectRow& object = rows.objects[o];
    object.first_level = std::uint32_t(rows.levels.size());
    if (object.first >= emission.proxies.size()) continue;  // a lamp
    const frame::ProxyLevels* levels = emission.proxies[object.first].levels;
    if (levels == nullptr) continue;
    for (const auto& groups : *levels) addLevel(rows, object, std::uint32_t(o), groups);
    object.levels = std::uint32_t(rows.levels.size()) - object.first_level;
  }
}

void recordCoarse(const Step& step, gpu::BufferRef sent) {
  if (step.params.coarse == 0) return;
  step.graph.compute("spherical_lights.coarse", spherical_lights_coarse_spv)
      .read("spheres", step.spheres)
      .read("coarse", step.coarse)
      .read("leaves", step.leaves)
      .readWrite("sent", sent)
      .push(step.params.spheres)
      .dispatch(step.params.coarse);
}

Cuts recordCuts(const Step& step, gpu::BufferRef sent, gpu::ImageRef position) {
  const std::uint32_t columns = (std::uint32_t(position.width()) + kClusterSide - 1) / kClusterSide,
                      rows = (std::uint32_t(position.height()) + kClusterSide - 1) / kClusterSide;
  const std::size_t clusters = std::size_t(columns) * rows;
  const Cuts cuts{step.graph.create("spherical_lights.cuts",
                                    {.bytes = clusters * step.params.objects * sizeof(LevelRow)}),
                  step.graph.create("spherical_lights.ratios",
                                    {.bytes = clusters * step.params.coarse * sizeof(glm::vec4)})};
  step.graph.compute("spherical_lights.cut", spherical_lights_cut_spv)
      .read("receiver_position", position)
      .read("spheres", step.spheres)
      .read("objects", step.objects)
      .read("levels", step.levels)
      .read("coarse", step.coarse)
      .read("leaves", step.leaves)
      .read("listed", step.listed)
      .read("sent", sent)
      .read("light", step.light)
      .write("cuts", cuts.levels)
      .write("ratios", cuts.ratios)
      .write("ratio",
             step.graph.create("spherical_lights.ratio",
                               {.format = kHalves, .width = position.width(), .height = position.height()}))
      .push(CutParams{step.params, step.coarse_limit})
      .dispatchOver(position);
  return cuts;
}

}  // namespace gloam::spherical_lights
