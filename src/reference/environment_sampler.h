// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light for paths: its radiance in a direction, directions in which there is much of it, and their density.
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include "reference/distribution.h"

namespace gloam::reference {

/// The environment's pixels as radianceFrom() reads them (bilinear), or its projection to some bands of spherical harmonics,
/// which may be negative. Keeps no reference to the environment.
class EnvironmentSampler {
 public:
  /// order 0: the pixels; 1 to 6: that many bands of projectEnvironment, no window.
  EnvironmentSampler(const Environment& environment, int order);

  /// No light from anywhere.
  bool black() const { return marginal_.empty(); }
  struct Light {
    glm::vec3 radiance{0.0f};
    float pdf = 0.0f;  ///< with which sample() takes the direction, 1/sr; positive wherever there is light
  };
  /// Of a unit direction.
  Light from(const glm::vec3& direction) const;
  struct Sample {
    glm::vec3 direction{0.0f, 1.0f, 0.0f};
    Light light;
  };
  Sample sample(const glm::uvec2& numbers) const;

 private:
  struct Place {
    int cell_x, cell_y;
    float x, y;  // within the cell
  };
  void fillPixels(const Environment& environment);
  void fillProjection(const Environment& environment, int order);
  void finish();
  glm::vec4 interpolated(const Place& place) const;
  Light lightAt(const Place& place, const glm::vec3& direction, float cos_elevation) const;

  int width_ = 0, height_ = 0;     // texels
  std::vector<glm::vec4> texels_;  // (width + 1) x (height + 2), a border around; w: importance
  float cos_rotation_ = 1.0f, sin_rotation_ = 0.0f;
  sh::ShRgb projection_;  // order 0: pixels are the light
  Distribution marginal_;
  std::vector<Distribution> rows_;
  float polar_height_ = 0.0f;       // of the caps above and below the outermost texel centres
  std::vector<float> row_density_;  // times importance / cos(elevation): the density
};

}  // namespace gloam::reference
