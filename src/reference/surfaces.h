// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Everything in a posed scene that light meets, made ready for paths: normals in the world, and lobes worked out beforehand
// where a material is the same all over.
#pragma once

#include <gloam/scene.h>

#include <optional>

#include "reference/lobes.h"
#include "trace/surface.h"
#include "trace/tracer.h"

namespace gloam::reference {

/// A point on a surface, seen from a side.
struct Vertex {
  glm::vec3 position{0.0f};
  glm::vec3 geometric_normal{0.0f};   ///< unit, toward whoever looks
  glm::vec3 normal{0.0f};             ///< shading normal, by the rule of sides (frame/README.md)
  float ray_offset = 0.0f;            ///< rays start that far off, along the geometric normal (trace/rays.h)
  const LobesReady* lobes = nullptr;  ///< those of the whole surface, or own_lobes
  std::optional<LobesReady> own_lobes;

  Vertex() = default;
  Vertex(const Vertex&) = delete;
  glm::vec3 rayOrigin() const { return position + geometric_normal * ray_offset; }
};

class Surfaces {
 public:
  /// Keeps references to `scene` and `tracer`. Throws Error for a mesh without normals.
  Surfaces(const Scene& scene, const PosedScene& posed, const trace::Tracer& tracer);

  /// What a ray in that direction meets. `texture_shift` moves textures alone: by that much of the triangle's coordinates.
  void setVertex(Vertex& vertex, const trace::Hit& hit, const glm::vec3& direction,
                 const glm::vec2& texture_shift = glm::vec2(0.0f)) const;
  /// Sends for what setVertex will need: first which vertices, then, when that has come, the vertices.
  void prefetchCorners(const trace::Hit& hit) const {
    __builtin_prefetch(&instances_[std::size_t(hit.instance)].triangles.vertices[hit.triangle]);
  }
  void prefetchVertices(const trace::Hit& hit) const {
    const Surface& s = instances_[std::size_t(hit.instance)];
    const glm::uvec3& corner = s.triangles.vertices[hit.triangle];
    for (int i = 0; i < 3; ++i) {
      __builtin_prefetch(&s.triangles.positions[corner[i]]);
      __builtin_prefetch(&s.normals[corner[i]]);
    }
  }
  /// Whether a texture shift changes anything.
  bool textured(int instance) const { return instances_[std::size_t(instance)].textured; }

  bool emits(int instance) const { return instances_[std::size_t(instance)].emits; }
  bool anyEmits() const { return any_emits_; }
  /// Radiance that the surface itself sends, both sides alike.
  glm::vec3 emission(int instance, int triangle, float u, float v,
                     const glm::vec2& texture_shift = glm::vec2(0.0f)) const;
  /// Nothing is there: cut out by a mask.
  bool isHole(int instance, int triangle, float u, float v) const;

  int count() const { return int(instances_.size()); }
  std::size_t triangleCount(int instance) const {
    return instances_[std::size_t(instance)].mesh->triangleCount();
  }
  /// Sets the lobes alone: where neither maps nor vertex colours vary them, the same everywhere.
  void setLobes(Vertex& vertex, int instance, const trace::SurfacePoint& at,
                const trace::SurfacePoint& texture_at) const;

 private:
  struct Surface {
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
    trace::Tracer::Triangles triangles;
    const glm::vec3* normals = nullptr;  // in the world
    std::vector<glm::vec3> own_normals;
    std::vector<glm::vec4> own_tangents;  // of deformed instances
    const glm::vec4* tangents = nullptr;  // before world_from_tangent
    glm::mat3 world_from_tangent{1.0f};
    float handedness = 1.0f;
    LobesReady lobes;     // where uniform
    bool uniform = true;  // neither maps nor vertex colours in the lobes
    bool textured = false, normal_mapped = false, emits = false, holes = false;
  };
  Surface makeSurface(const Instance& instance, trace::Tracer::Triangles triangles) const;
  glm::vec3 tilted(const Surface& surface, const glm::uvec3& corners, const trace::SurfacePoint& at,
                   const trace::SurfacePoint& texture_at, const glm::vec3& normal) const;

  const Scene& scene_;
  std::vector<Surface> instances_;
  bool any_emits_ = false;
};

}  // namespace gloam::reference
