// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a point in free space near an object sees of it: visibility, and the light that it throws.
#pragma once

#include <gloam/neighbourhood.h>

#include <atomic>
#include <optional>

#include "math/brdf.h"
#include "techniques/prt/prt_bake_directions.h"
#include "techniques/prt/prt_glossy_kernels.h"
#include "techniques/prt/prt_glossy_state.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// The object by itself, in the axes of the node that carries it: metres, scale kept, the node at the origin.
struct NeighbourhoodObject {
  PosedScene posed;                  ///< its rigid instances alone
  glm::mat3 scale{1.0f};             ///< from the node's coordinates to these axes
  glm::vec3 bounds_min, bounds_max;  ///< in the node's coordinates
  std::size_t triangles = 0, vertices = 0;
};
/// Throws Error where there are no rigid triangles at or below the node.
NeighbourhoodObject neighbourhoodObject(const Scene& scene, int node, float time_s);

/// Thread-safe once built. Keeps references to `scene` and `object`.
class NeighbourhoodTracer {
 public:
  NeighbourhoodTracer(const Scene& scene, const NeighbourhoodObject& object,
                      const NeighbourhoodOptions& options, const Progress& progress);

  const GlossyLayout& layout() const { return layout_; }
  /// Whether the object's meshes carry transfer that can be thrown; and of how many bounces.
  bool throws() const { return !lit_.empty(); }
  int bounces() const { return bounces_; }

  /// Visibility of all directions from a place (not blocked: 1), layout().visibilityCount() numbers. `blocked` gets a bit a
  /// direction. Returns the share of directions that meet something.
  float visibility(const glm::vec3& place, std::vector<std::uint16_t>& blocked, float* visibility) const;
  /// The same by fewer directions (sampleDirections), for places that are many and lie close together.
  float roughVisibility(const glm::vec3& place, float* visibility) const;
  /// Whether the place is inside the object: backs wherever it looks.
  bool isInside(const glm::vec3& place) const;
  /// [rgb][row i][column j, padded] (GlossyLayout): radiance that arrives from the object by the light's coefficients.
  /// Returns the number of rays. `blocked` as visibility() left it.
  std::size_t thrown(const glm::vec3& place, const std::vector<std::uint16_t>& blocked, float share,
                     float* matrix) const;
  std::size_t raysOfPoint() const { return std::size_t(all_.tables.tiles) * kTileSize; }
  std::size_t raysOfSample() const { return std::size_t(few_.tables.tiles) * kTileSize; }

 private:
  /// A mesh's surface as it sends light on: rows of DI in these axes, [vertex][rgb][column].
  struct Lit {
    const Mesh* mesh = nullptr;
    std::vector<float> rows;
    std::vector<glm::vec3> normals;
    std::vector<std::int8_t> facing;
    int texel_width = 0, texel_height = 0, uv_set = 0;
  };
  struct Directions {
    DirectionTables tables;
    GlossyTables basis;
  };
  static Directions directionsOf(const GlossyLayout& layout, int count, int bounce_count);
  float visibilityOf(const Directions& set, const glm::vec3& place, std::vector<std::uint16_t>& blocked,
                     float* visibility) const;
  void light(std::size_t instance);
  void addDiffuse(const trace::Hit& hit, const Lit& lit, const glm::vec3& weight, LightRow& light) const;
  std::size_t follow(trace::Hit hit, glm::vec3 origin, glm::vec3 direction, LightRow& light) const;
  const float* rowAt(const trace::Hit& hit, const Lit& lit, int corner) const;

  const Scene& scene_;
  const NeighbourhoodObject& object_;
  GlossyLayout layout_;
  Directions all_, few_;
  trace::Tracer tracer_;
  std::vector<Lit> lit_;  ///< [instance]; empty where nothing is thrown
  std::vector<glm::vec3> probes_;
  int bounces_ = 0;
};

}  // namespace gloam::prt
