// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which meshes have a lightmap, of which texture coordinates and how large.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "techniques/prt/prt_bake_texels.h"

namespace gloam::prt {
namespace {

/// Overlap is looked for on a grid of this many places a side; charts may share that much of what they cover.
constexpr int kOverlapGrid = 1024;
constexpr double kOverlapShare = 0.001;
constexpr float kOutside = 1.0e-4f;  // of 0 to 1: rounding

float cross2(const glm::vec2& a, const glm::vec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool overlaps(const Mesh& mesh, const std::vector<glm::vec2>& uvs) {
  std::vector<std::uint8_t> seen(std::size_t(kOverlapGrid) * kOverlapGrid, 0);
  std::size_t covered = 0, twice = 0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    glm::vec2 p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = uvs[mesh.indices[t + k]] * float(kOverlapGrid);
    const float area = cross2(p[1] - p[0], p[2] - p[0]);
    if (area == 0.0f) continue;
    const glm::vec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    const int x_end = std::min(int(high.x), kOverlapGrid - 1),
              y_end = std::min(int(high.y), kOverlapGrid - 1);
    for (int y = std::max(int(low.y), 0); y <= y_end; ++y) {
      for (int x = std::max(int(low.x), 0); x <= x_end; ++x) {
        const glm::vec2 q = glm::vec2(float(x), float(y)) + 0.5f - p[0];
        const float u = cross2(q, p[2] - p[0]) / area, v = cross2(p[1] - p[0], q) / area;
        constexpr float kInside = 1.0e-3f;  // triangles may share an edge
        if (u < kInside || v < kInside || u + v > 1.0f - kInside) continue;
        std::uint8_t& place = seen[std::size_t(y) * kOverlapGrid + std::size_t(x)];
        twice += place, covered += 1 - place;
        place = 1;
      }
    }
  }
  return double(twice) > kOverlapShare * double(covered);
}

double uvArea(const Mesh& mesh, const std::vector<glm::vec2>& uvs) {
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    glm::vec2 p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = glm::clamp(uvs[mesh.indices[t + k]], 0.0f, 1.0f);
    area += 0.5 * double(std::abs(cross2(p[1] - p[0], p[2] - p[0])));
  }
  return area;
}

/// Texels a side: metres that a step of u or v takes, root mean square over the surface, times the density.
int sideOf(double squared_metres, double area, const BakeOptions& options) {
  const int most = options.texels > 0 ? options.texels : kMostTexels;
  const double metres = area > 0.0 ? std::sqrt(squared_metres / area) : 0.0;
  return int(std::clamp(std::ceil(metres * double(options.texels_per_metre)), double(kLeastTexels),
                        double(std::max(most, kLeastTexels))));
}

LightmapSize sizeOf(const Mesh& mesh, const Instance& instance, int uv_set, const BakeOptions& options) {
  if (!(options.texels_per_metre > 0.0f)) return {options.texels, options.texels, uv_set};
  const glm::mat3 world(instance.world_from_object);
  const std::vector<glm::vec2>& uvs = mesh.uv_sets[std::size_t(uv_set)];
  double along_u = 0.0, along_v = 0.0, sum = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t* c = &mesh.indices[t];
    const glm::dvec2 b = glm::dvec2(uvs[c[1]]) - glm::dvec2(uvs[c[0]]),
                     d = glm::dvec2(uvs[c[2]]) - glm::dvec2(uvs[c[0]]);
    const glm::dvec3 e1(world * (mesh.positions[c[1]] - mesh.positions[c[0]])),
        e2(world * (mesh.positions[c[2]] - mesh.positions[c[0]]));
    const double determinant = b.x * d.y - b.y * d.x, area = glm::length(glm::cross(e1, e2));
    if (std::abs(determinant) < 1.0e-12) continue;
    const glm::dvec3 du = (d.y * e1 - b.y * e2) / determinant, dv = (b.x * e2 - d.x * e1) / determinant;
    along_u += area * glm::dot(du, du);
    along_v += area * glm::dot(dv, dv);
    sum += area;
  }
  return {sideOf(along_u, sum, options), sideOf(along_v, sum, options), uv_set};
}

/// "'a', 'b' and 3 more"
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::size_t shown = std::min(names.size(), kMost);
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("{}'{}'", i > 0 ? ", " : "", names[i]);
  return names.size() > shown ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

constexpr const char* kExpected =
    "expected texture coordinates within 0 to 1 in which no two triangles lie over each other";

constexpr std::size_t kMostTexelsOfAll = std::size_t(1) << 30;

std::string placeOf(const Scene& scene) {
  return scene.name.empty() ? "bake" : scene.name;
}

}  // namespace

std::string unfitForLightmap(const Mesh& mesh, int uv_set) {
  if (uv_set < 0 || std::size_t(uv_set) >= mesh.uv_sets.size()) return fmt::format("no TEXCOORD_{}", uv_set);
  const std::vector<glm::vec2>& uvs = mesh.uv_sets[std::size_t(uv_set)];
  for (const std::uint32_t i : mesh.indices) {
    const glm::vec2& uv = uvs[i];
    const bool inside = std::min(uv.x, uv.y) >= -kOutside && std::max(uv.x, uv.y) <= 1.0f + kOutside;
    if (!inside) return fmt::format("TEXCOORD_{} leaves 0 to 1", uv_set);
  }
  constexpr double kLeastArea = 1.0e-6;
  if (uvArea(mesh, uvs) < kLeastArea) return fmt::format("TEXCOORD_{} covers nothing", uv_set);
  if (overlaps(mesh, uvs)) return fmt::format("triangles lie over each other in TEXCOORD_{}", uv_set);
  return "";
}

std::vector<LightmapSize> chooseLightmaps(const Scene& scene, const PosedScene& posed,
                                          const BakeOptions& options, Warnings& warnings) {
  if (!wantsTexels(options)) return {};
  std::vector<LightmapSize> sizes(posed.instances.size());
  std::map<std::string, std::vector<std::string>> unfit;  // names of meshes by reason
  std::map<int, std::string> known;                       // by mesh: why not
  std::size_t texels = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Instance& instance = posed.instances[i];
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (instance.deformed() || mesh.indices.empty()) continue;
    const auto [found, is_new] = known.try_emplace(instance.mesh);
    std::string& reason = found->second;
    if (is_new) reason = unfitForLightmap(mesh, options.uv_set);
    if (!reason.empty()) {
      std::vector<std::string>& names = unfit[reason];
      if (std::ranges::find(names, mesh.name) == names.end()) names.push_back(mesh.name);
      continue;
    }
    sizes[i] = sizeOf(mesh, instance, options.uv_set, options);
    texels += std::size_t(sizes[i].width) * std::size_t(sizes[i].height);
  }
  for (const auto& [reason, names] : unfit)
    warnings.push_back(
        fmt::format("vertices instead of texels for {}: {}; {}", listed(names), reason, kExpected));
  if (texels > kMostTexelsOfAll) {
    throw Error(placeOf(scene), fmt::format("{} texels are too many; at most {}", texels, kMostTexelsOfAll));
  }
  return sizes;
}

std::size_t countTexels(const Scene& scene, const PosedScene& posed, const BakeOptions& options) {
  requireLightmaps(scene, posed, options);
  Warnings unused;
  const std::vector<LightmapSize> sizes = chooseLightmaps(scene, posed, options, unused);
  std::size_t count = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i].width == 0) continue;
    const auto covered = coveredTexels(scene.meshes[std::size_t(posed.instances[i].mesh)], sizes[i]);
    count += std::size_t(std::ranges::count_if(
        covered, [](const CoveredTexel& texel) { return texel.triangle != CoveredTexel::kNoTriangle; }));
  }
  return count;
}

void requireLightmaps(const Scene& scene, const PosedScene& posed, const BakeOptions& options) {
  Warnings warnings;
  const std::vector<LightmapSize> sizes = chooseLightmaps(scene, posed, options, warnings);
  const bool any = std::ranges::any_of(sizes, [](const LightmapSize& size) { return size.width > 0; });
  if (!sizes.empty() && !any)
    throw Error(placeOf(scene),
                "no mesh has room for texels: " + (warnings.empty() ? "all deform" : warnings.front()));
}

}  // namespace gloam::prt
