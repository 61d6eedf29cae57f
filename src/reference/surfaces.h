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

  struct Surface;
  /// What rays have met, gathered lane by lane.
  struct Arrivals {
    MeetingLanes meetings;
    PlaceLanes places;
    std::uint32_t varied = 0;  ///< bit i: lane i's lobes or normal come from textures or vertex colours
    bool glossy = false;
    bool shifted = false;  ///< textures are read beside where the ray met the triangle
    // Of varied lanes:
    const Surface* surface[kLanes];
    glm::uvec3 corners[kLanes];
    LaneFloats shift_u, shift_v;  ///< so far beside, on the triangle; where `shifted`
    void clear() {
      varied = 0;
      glossy = shifted = false;
    }
  };
  /// One more vertex. False where nothing is sent back: then the lane may be taken by another.
  bool arrive(Arrivals& arrivals, int lane, const trace::Hit& hit) const;
  /// The vertices of those lanes, a bit each, from to_view and what has arrived.
  void setVertices(PathLanes& lanes, Arrivals& arrivals, std::uint32_t mask) const;
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

  struct Surface {
    // What arrive() reads stands first.
    trace::Tracer::Triangles triangles;
    std::vector<WorldVertex> vertices;
    bool uniform = true;  // neither maps nor vertex colours in the lobes
    bool varied = false;  // not uniform, or a normal map
    bool textured = false, emits = false, holes = false;
    bool alike = true;      // the maps' texels have the same places
    bool split_uv = false;  // maps of several sets of texture coordinates: WorldVertex::uv is no use
    LobesReady lobes;       // where uniform
    MaterialFactors factors;
    TextureReader base_color, metallic_roughness, normal, emission;
    std::vector<glm::vec4> tangents;  // in the world, where there is a normal map
    const glm::vec4* colors = nullptr;
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
  };

 private:
  Surface makeSurface(const Instance& instance, trace::Tracer::Triangles triangles) const;
  static void setMaps(Surface& surface);

  const Scene& scene_;
  std::vector<Surface> instances_;
  bool any_emits_ = false;
};

}  // namespace gloam::reference
