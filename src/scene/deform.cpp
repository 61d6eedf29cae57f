// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Linear blend skinning as in the glTF 2.0 specification, 3.7.3: x' = sum_j w_j world_from_joint_j
// joint_from_mesh_j x. The node that holds a skinned mesh does not move it; its joints do.
#include "scene/deform.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "scene/transforms.h"

namespace gloam {
namespace {

constexpr std::size_t kGrain = 2048;  // vertices a task: small enough to share, large enough to pay

struct Vertex {
  glm::vec3 position{0.0f}, normal{0.0f}, tangent{0.0f};
};

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 0.0f ? v / length : fallback;
}

Vertex morphed(const Mesh& mesh, std::span<const float> weights, std::size_t i) {
  Vertex v;
  v.position = mesh.positions[i];
  if (!mesh.normals.empty()) v.normal = mesh.normals[i];
  if (!mesh.tangents.empty()) v.tangent = glm::vec3(mesh.tangents[i]);
  for (std::size_t t = 0; t < mesh.morph_targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0.0f) continue;
    const MorphTarget& target = mesh.morph_targets[t];
    if (!target.positions.empty()) v.position += weights[t] * target.positions[i];
    if (!target.normals.empty()) v.normal += weights[t] * target.normals[i];
    if (!target.tangents.empty()) v.tangent += weights[t] * target.tangents[i];
  }
  return v;
}

glm::mat4 blended(const Mesh& mesh, std::span<const glm::mat4> world_from_mesh, std::size_t i) {
  glm::mat4 sum(0.0f);
  const std::size_t first = i * std::size_t(mesh.influences);
  for (std::size_t k = first; k < first + std::size_t(mesh.influences); ++k) {
    if (mesh.weights[k] != 0.0f) sum += mesh.weights[k] * world_from_mesh[mesh.joints[k]];
  }
  return sum;
}

void place(const Vertex& vertex, const glm::mat4& world_from_vertex, const Mesh& mesh, std::size_t i,
           Instance& instance) {
  const glm::mat3 linear(world_from_vertex);
  instance.deformed_positions[i] = glm::vec3(world_from_vertex * glm::vec4(vertex.position, 1.0f));
  if (mesh.normals.empty()) return;
  const glm::vec3 normal =
      unitOr(normalTransform(linear) * vertex.normal, unitOr(vertex.normal, {0.0f, 1.0f, 0.0f}));
  instance.deformed_normals[i] = normal;
  if (mesh.tangents.empty()) return;
  glm::vec3 tangent = linear * vertex.tangent;
  tangent -= normal * glm::dot(normal, tangent);
  const float mirror = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  instance.deformed_tangents[i] =
      glm::vec4(unitOr(tangent, glm::vec3(mesh.tangents[i])), mirror * mesh.tangents[i].w);
}

}  // namespace

void deformMesh(const Mesh& mesh, std::span<const float> morph_weights,
                std::span<const glm::mat4> world_from_mesh, const glm::mat4& world_from_object,
                Instance& instance) {
  const std::size_t count = mesh.vertexCount();
  instance.deformed_positions.resize(count);
  instance.deformed_normals.resize(mesh.normals.empty() ? 0 : count);
  instance.deformed_tangents.resize(mesh.tangents.empty() ? 0 : count);
  const bool skinned = !world_from_mesh.empty() && mesh.influences > 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const glm::mat4 world = skinned ? blended(mesh, world_from_mesh, i) : world_from_object;
      place(morphed(mesh, morph_weights, i), world, mesh, i, instance);
    }
  });
}

}  // namespace gloam
