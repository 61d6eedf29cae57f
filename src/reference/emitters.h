// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Triangles that shine by themselves, as sources to be sampled.
#pragma once

#include "reference/distribution.h"
#include "reference/surfaces.h"

namespace gloam::reference {

/// Chosen by power: area times emission, averaged over its texture. Both sides shine.
class Emitters {
 public:
  Emitters() = default;
  /// Keeps a reference to `surfaces`.
  Emitters(const Scene& scene, const PosedScene& posed, const Surfaces& surfaces,
           const trace::Tracer& tracer);

  bool empty() const { return choice_.empty(); }
  struct Sample {
    glm::vec3 position{0.0f}, normal{0.0f};  ///< normal unit, of either side
    float ray_offset = 0.0f;
    float area_pdf = 0.0f;  ///< 1/m^2
    glm::vec3 radiance{0.0f};
  };
  Sample sample(std::uint32_t number, const glm::vec2& u) const;
  /// Density with which sample() takes a point of a triangle, 1/m^2; 0 for what does not shine.
  float areaPdf(int instance, int triangle) const {
    const std::size_t first = first_[std::size_t(instance)];
    return first == kNotHere ? 0.0f : area_pdf_[first + std::size_t(triangle)];
  }
  /// The same over solid angle, 1/sr: `cosine` between the triangle's normal and the way to it.
  static float solidAnglePdf(float area_pdf, float squared_distance, float cosine) {
    return cosine > 0.0f ? area_pdf * squared_distance / cosine : 0.0f;
  }

 private:
  static constexpr std::size_t kNotHere = ~std::size_t(0);
  struct Triangle {
    glm::vec3 corner{0.0f}, edge_u{0.0f}, edge_v{0.0f}, normal{0.0f};
    float ray_offset = 0.0f;
    int instance = 0, triangle = 0;
  };
  void add(const Scene& scene, const Mesh& mesh, int instance, trace::Tracer::Triangles triangles,
           std::vector<float>& power);

  const Surfaces* surfaces_ = nullptr;
  std::vector<Triangle> triangles_;
  std::vector<float> area_pdf_;
  std::vector<std::size_t> first_;  // of each instance, in the two above
  Distribution choice_;
};

}  // namespace gloam::reference
