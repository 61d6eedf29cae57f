// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Everything in a posed scene that light meets, made ready for paths: normals and tangents in the world, lobes worked out
// beforehand where a material is the same all over, textures ready to be read.
#pragma once

#include <gloam/scene.h>

#include "reference/lobes.h"
#include "reference/material_lanes.h"
#include "trace/tracer.h"

namespace gloam::reference {

class Surfaces {
 public:
  /// Keeps references to `scene` and `tracer`. Throws Error for a mesh without normals.
  Surfaces(const Scene& scene, const PosedScene& posed, const trace::Tracer& tracer);

  /// What rays have met, gathered lane by lane.
  struct Arrivals {
    CornerLanes corners;
    std::uint32_t varied = 0;  ///< bit i: lane i's lobes or normal come from textures or vertex colours
    bool glossy = false;
    std::int32_t instance[kLanes], triangle[kLanes];  ///< of varied lanes
    LaneFloats texture_u, texture_v;                  ///< the same: where textures are read
  };
  /// One more vertex. False where nothing is sent back: then the lane may be taken by another.
  bool arrive(PathLanes& lanes, Arrivals& arrivals, int lane, const trace::Hit& hit,
              const glm::vec2& texture_shift = glm::vec2(0.0f)) const;
  /// All lanes become copies of the first, but for `place`, `slot` and where textures are read.
  static void spreadFirst(PathLanes& lanes, Arrivals& arrivals);
  /// The vertices of all lanes, from to_view and what has arrived.
  void setVertices(PathLanes& lanes, const Arrivals& arrivals) const;
  /// Sends for what arrive() will need: first which vertices, then, when that has come, the vertices.
  void prefetchCorners(const trace::Hit& hit) const {
    __builtin_prefetch(&instances_[std::size_t(hit.instance)].triangles.vertices[hit.triangle]);
  }
  void prefetchVertices(const trace::Hit& hit) const {
    const Surface& s = instances_[std::size_t(hit.instance)];
    const glm::uvec3& corner = s.triangles.vertices[hit.triangle];
    for (int i = 0; i < 3; ++i) {
      __builtin_prefetch(&s.vertices[corner[i]]);
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

 private:
  struct alignas(32) WorldVertex {  // all of it comes from memory at once
    glm::vec3 position, normal;
  };
  struct Surface {
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
    trace::Tracer::Triangles triangles;
    std::vector<WorldVertex> vertices;
    std::vector<glm::vec4> tangents;  // in the world, where there is a normal map
    TextureReader base_color, metallic_roughness, normal, emission;
    const glm::vec4* colors = nullptr;
    LobesReady lobes;     // where uniform
    bool uniform = true;  // neither maps nor vertex colours in the lobes
    bool varied = false;  // not uniform, or a normal map
    bool textured = false, emits = false, holes = false;
    void setCoordinates(const TextureReader& texture, const Arrivals& arrivals, std::uint32_t mask,
                        LaneFloats& u, LaneFloats& v) const;
    void read(const TextureReader& texture, const Arrivals& arrivals, std::uint32_t mask,
              LaneVectors& color) const;
  };
  Surface makeSurface(const Instance& instance, trace::Tracer::Triangles triangles) const;
  template <class Visit>
  void forSurfaces(const Arrivals& arrivals, const Visit& visit) const;
  void setMaterial(PathLanes& lanes, const Arrivals& arrivals, std::uint32_t mask,
                   const Surface& surface) const;
  void setNormals(PathLanes& lanes, const Arrivals& arrivals, std::uint32_t mask,
                  const Surface& surface) const;
  static void setLobes(PathLanes& lanes, int lane, const LobesReady& lobes);

  const Scene& scene_;
  std::vector<Surface> instances_;
  bool any_emits_ = false;
};

}  // namespace gloam::reference
