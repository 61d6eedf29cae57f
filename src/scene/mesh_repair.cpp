// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/epsilon.hpp>

#include "scene/transforms.h"

namespace gloam {
namespace {

constexpr std::uint32_t kUnused = 0xffffffffu;

/// `stride` values a vertex.
template <typename T>
void remapArray(std::vector<T>& array, std::span<const std::uint32_t> source, std::size_t stride = 1) {
  if (array.empty()) return;
  std::vector<T> out;
  out.reserve(source.size() * stride);
  for (const std::uint32_t from : source)
    out.insert(out.end(), array.begin() + static_cast<std::ptrdiff_t>(from * stride),
               array.begin() + static_cast<std::ptrdiff_t>((from + 1) * stride));
  array = std::move(out);
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Twice the area over the longest edge squared: 0 for a triangle without area, whatever its size.
double flatness(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0.0;
}

glm::vec3 anyPerpendicular(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

}  // namespace

void remapVertices(Mesh& mesh, std::span<const std::uint32_t> source) {
  const auto influences = static_cast<std::size_t>(mesh.influences);
  remapArray(mesh.positions, source);
  remapArray(mesh.normals, source);
  remapArray(mesh.tangents, source);
  remapArray(mesh.colors, source);
  for (auto& uv : mesh.uv_sets) remapArray(uv, source);
  remapArray(mesh.joints, source, influences);
  remapArray(mesh.weights, source, influences);
  for (MorphTarget& target : mesh.morph_targets) {
    remapArray(target.positions, source);
    remapArray(target.normals, source);
    remapArray(target.tangents, source);
  }
  if (mesh.transfer) {
    auto transfer = std::make_shared<Transfer>(*mesh.transfer);
    const auto coefficients = static_cast<std::size_t>(transfer->order * transfer->order);
    if (!transfer->ofTexels()) {
      remapArray(transfer->direct, source, coefficients);
      remapArray(transfer->indirect, source, 3 * coefficients);
    }
    remapArray(transfer->glossy.visibility, source, transfer->glossy.visibilityCount());
    remapArray(transfer->glossy.indirect, source, 3 * transfer->glossy.matrixCount());
    mesh.transfer = std::move(transfer);
  }
}

void removeUnusedVertices(Mesh& mesh) {
  std::vector<std::uint32_t> target(mesh.vertexCount(), kUnused), source;
  for (const std::uint32_t index : mesh.indices) target[index] = 0;
  for (std::uint32_t i = 0; i < target.size(); ++i)
    if (target[i] != kUnused) {
      target[i] = static_cast<std::uint32_t>(source.size());
      source.push_back(i);
    }
  if (source.size() == mesh.vertexCount()) return;
  remapVertices(mesh, source);
  for (std::uint32_t& index : mesh.indices) index = target[index];
}

std::size_t removeDegenerateTriangles(Mesh& mesh) {
  // Below this a float normal of the triangle is rounding noise.
  constexpr double kLeastFlatness = 1e-10;
  std::size_t kept = 0;
  const std::size_t before = mesh.indices.size();
  for (std::size_t i = 0; i + 2 < before; i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    if (a == b || b == c || c == a) continue;
    if (mesh.morph_targets.empty() &&
        flatness(mesh.positions[a], mesh.positions[b], mesh.positions[c]) <= kLeastFlatness)
      continue;
    mesh.indices[kept] = a, mesh.indices[kept + 1] = b, mesh.indices[kept + 2] = c;
    kept += 3;
  }
  mesh.indices.resize(kept);
  return (before - kept) / 3;
}

std::size_t repairNormals(Mesh& mesh) {
  std::vector<bool> bad(mesh.vertexCount(), false);
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const double length = finite(mesh.normals[i]) ? glm::length(glm::dvec3(mesh.normals[i])) : 0.0;
    if (isUnitLength(length)) continue;
    if (length > 1e-12)
      mesh.normals[i] = glm::vec3(glm::dvec3(mesh.normals[i]) / length);
    else
      bad[i] = true, ++count, mesh.normals[i] = glm::vec3(0.0f);
  }
  if (count == 0) return 0;
  std::vector<glm::dvec3> sums(mesh.vertexCount(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &mesh.indices[i];
    const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    for (int k = 0; k < 3; ++k) sums[t[k]] += glm::cross(b - a, c - a);
  }
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    if (!bad[i]) continue;
    const double length = glm::length(sums[i]);
    mesh.normals[i] = length > 0.0 ? glm::vec3(sums[i] / length) : glm::vec3(0, 1, 0);
  }
  return count;
}

void setAnyTangents(Mesh& mesh) {
  mesh.tangents.resize(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
    mesh.tangents[i] = glm::vec4(anyPerpendicular(mesh.normals[i]), 1.0f);
}

std::size_t repairTangents(Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    glm::vec4& tangent = mesh.tangents[i];
    const glm::vec3 direction(tangent);
    const bool good =
        finite(direction) && glm::length(glm::cross(glm::dvec3(direction), glm::dvec3(mesh.normals[i]))) >
                                 1e-4 * glm::length(glm::dvec3(direction));
    const float sign = tangent.w < 0.0f ? -1.0f : 1.0f;
    if (!good) ++count;
    const double length = glm::length(glm::dvec3(direction));
    const glm::vec3 unit = !good                  ? anyPerpendicular(mesh.normals[i])
                           : isUnitLength(length) ? direction
                                                  : glm::vec3(glm::dvec3(direction) / length);
    tangent = glm::vec4(unit, sign);
  }
  return count;
}

std::size_t normalizeWeights(Mesh& mesh) {
  const auto n = static_cast<std::size_t>(mesh.influences);
  std::size_t without = 0;
  for (std::size_t vertex = 0; n > 0 && vertex < mesh.vertexCount(); ++vertex) {
    float* weights = &mesh.weights[vertex * n];
    std::uint16_t* joints = &mesh.joints[vertex * n];
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k) sum += weights[k] = std::max(weights[k], 0.0f);
    if (sum <= 0.0) {
      ++without;
      weights[0] = 1.0f;
      sum = 1.0;
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (!isUnitLength(sum)) weights[k] = static_cast<float>(weights[k] / sum);
      if (weights[k] == 0.0f) joints[k] = 0;
    }
  }
  return without;
}

void checkPositions(const Mesh& mesh, std::span<const std::uint32_t> original, const std::string& place,
                    const std::string& label) {
  constexpr float kFarthest =
      1e12f;  // its square, and a product of two edges, are still far from a float's end
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    const std::size_t vertex = original.empty() ? i : original[i];
    if (!finite(p)) throw Error(place, fmt::format("{}: position of vertex {} is not finite", label, vertex));
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kFarthest)
      throw Error(place, fmt::format("{}: position of vertex {} lies beyond 1e12", label, vertex));
  }
}

bool fillUvSets(Mesh& mesh, const Material& material) {
  std::size_t wanted = 0;
  for (const TextureSlot* slot : {&material.base_color_map, &material.metallic_roughness_map,
                                  &material.normal_map, &material.occlusion_map, &material.emission_map})
    if (*slot) wanted = std::max(wanted, static_cast<std::size_t>(slot->uv_set) + 1);
  if (wanted <= mesh.uv_sets.size()) return false;
  mesh.uv_sets.resize(wanted, std::vector<glm::vec2>(mesh.vertexCount(), glm::vec2(0.0f)));
  return true;
}

void MeshRepairs::note(Kind kind, std::size_t count, const std::string& label) {
  if (count == 0) return;
  Tally& tally = tallies_[kind];
  tally.count += count;
  if (tally.meshes++ == 0) tally.first = label;
}

Warnings MeshRepairs::lines() const {
  constexpr const char* kWhat[kKinds] = {
      "triangles without area are left out", "normals were zero or not finite and are computed",
      "tangents were zero, not finite or along the normal and are replaced",
      "vertices had no joint weights and follow their first joint",
      "sets of texture coordinates that materials want are missing and taken as 0"};
  Warnings out;
  for (int kind = 0; kind < kKinds; ++kind) {
    const Tally& tally = tallies_[static_cast<std::size_t>(kind)];
    if (tally.count == 0) continue;
    const std::string where = tally.meshes == 1
                                  ? fmt::format("in {}", tally.first)
                                  : fmt::format("in {} meshes, first {}", tally.meshes, tally.first);
    out.push_back(fmt::format("{} {} ({})", tally.count, kWhat[kind], where));
  }
  return out;
}

bool finishMesh(Mesh& mesh, const Material& material, float crease_rad, const std::string& label,
                MeshRepairs& repairs) {
  repairs.note(MeshRepairs::kNoArea, removeDegenerateTriangles(mesh), label);
  if (mesh.indices.empty()) return false;
  removeUnusedVertices(mesh);
  repairs.note(MeshRepairs::kUvSets, fillUvSets(mesh, material) ? 1 : 0, label);
  if (mesh.normals.empty()) {
    mesh.tangents.clear();  // tangents without normals mean nothing
    computeNormals(mesh, crease_rad);
  } else {
    repairs.note(MeshRepairs::kNormals, repairNormals(mesh), label);
  }
  if (!mesh.tangents.empty())
    repairs.note(MeshRepairs::kTangents, repairTangents(mesh), label);
  else if (material.normal_map)
    computeTangents(mesh, material.normal_map);
  else
    setAnyTangents(mesh);
  repairs.note(MeshRepairs::kWeights, normalizeWeights(mesh), label);
  return true;
}

}  // namespace gloam
