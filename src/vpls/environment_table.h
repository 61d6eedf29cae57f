// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "frame/environment_light.h"
#include "vpls/choice.h"

namespace gloam::vpls {

/// Distant light to choose directions from: what the environment's picture shows, at most kEnvironmentWidth texels wide.
class EnvironmentTable {
 public:
  EnvironmentTable() = default;
  /// Reads the picture back from the device: between frames, or inside a host pass.
  explicit EnvironmentTable(const frame::EnvironmentLight& environment);

  struct Sample {
    glm::vec3 direction{0.0f, 1.0f, 0.0f};  ///< unit, towards the light
    glm::vec3 light{0.0f};                  ///< radiance over density: their mean over all u is irradiance()
  };
  /// Half of all directions go where power is, half are spread over what is not black: a sun of a few texels takes no
  /// more than its half of what the sky has.
  Sample sample(const glm::vec2& u) const;
  /// Integral of radiance over all directions.
  const glm::vec3& irradiance() const { return total_; }
  bool black() const { return rows_.empty(); }

 private:
  void fill(const std::vector<float>& texels, const frame::EnvironmentRow& row, const glm::vec3& exact);
  glm::vec3 texelDirection(float column, float row) const;

  int width_ = 0, height_ = 0;
  float cos_rotation_ = 1.0f, sin_rotation_ = 0.0f;
  std::vector<glm::vec3> radiance_;
  std::vector<frame::DiscRow> discs_;
  std::vector<Choice> columns_;  // a row
  Choice rows_;                  // rows of the map, then discs
  glm::vec3 total_{0.0f};
};

inline constexpr int kEnvironmentWidth = 1024;

}  // namespace gloam::vpls
