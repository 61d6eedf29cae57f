// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How far transfer that is interpolated over triangles is from what it is there.
#pragma once

#include <gloam/bake.h>

#include <array>
#include <unordered_map>

#include "techniques/prt/prt_bake_directions.h"
#include "techniques/prt/prt_bake_points.h"

namespace gloam::prt {

/// Measures triangles of a scene that is split again and again; remembers what it knows of vertices.
class TessellationError {
 public:
  /// `spacing`: metres between the places at which triangles are measured that are larger.
  TessellationError(const TessellateOptions& options, float spacing);

  /// [instance][triangle]: in place of kUnknown the greatest |T there - T between the corners| / |DU| over the triangle, places
  /// that nobody sees left out; T is DS with the light of one bounce, the greatest of three colours counts. Other values stay. Triangles for which `rays` do not suffice stay unknown. Returns the number
  /// of rays that it took. Told as work that begins and ends at these fractions.
  std::size_t measure(const Scene& scene, const PosedScene& posed, const Progress& progress,
                      glm::vec2 fractions, std::size_t rays, std::vector<std::vector<float>>& errors) const;

  /// Stands for an error that is to be measured.
  static constexpr float kUnknown = -1.0f;
  int directions() const { return tables_.tiles * kTileSize; }

 private:
  struct Samples;
  struct KeyHash {
    std::size_t operator()(const std::array<std::uint32_t, 6>& key) const;
  };
  Samples placeSamples(BakePoints& points, std::size_t most,
                       const std::vector<std::vector<float>>& errors) const;

  DirectionTables tables_;
  float spacing_, unshadowed_;
  mutable std::unordered_map<std::array<std::uint32_t, 6>, std::uint32_t, KeyHash> known_;
  mutable std::vector<float> rows_;
};

}  // namespace gloam::prt
