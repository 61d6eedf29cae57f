// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light for paths: its radiance in a direction, directions in which there is much of it, and their density.
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include "reference/distribution.h"
#include "reference/lanes.h"

namespace gloam::reference {

/// The environment's pixels as radianceFrom() reads them (bilinear), or its projection to some bands of spherical harmonics,
/// which may be negative. Keeps no reference to the environment.
class EnvironmentSampler {
 public:
  /// order 0: the pixels; 1 to 6: that many bands of projectEnvironment, no window.
  EnvironmentSampler(const Environment& environment, int order);

  /// No light from anywhere.
  bool black() const { return block_rows_.empty(); }

  struct Light {
    glm::vec3 radiance{0.0f};
    float pdf = 0.0f;  ///< with which sample() takes the direction, 1/sr; positive wherever there is light
  };
  /// Where a unit direction lies. Its light is on its way from memory as soon as this is known: ask for it later.
  struct Place {
    int cell_x, cell_y;
    float x, y;  ///< within the cell
    float cos_elevation;
  };
  Place place(const glm::vec3& direction) const;
  /// The same for lanes 0 to count - 1.
  void places(const LaneVectors& directions, int count, Place* places) const;
  /// Surely no light around there.
  bool isDark(const Place& place) const {
    return lit_[std::size_t(place.cell_y / kBlock) * std::size_t(block_columns_) +
                std::size_t(place.cell_x / kBlock)] == 0;
  }
  Light at(const Place& place, const glm::vec3& direction) const;
  Light from(const glm::vec3& direction) const { return black() ? Light{} : at(place(direction), direction); }

  /// A part of the sphere, chosen by its light; the same holds for memory.
  struct Block {
    int column = 0, row = 0;
    float rest_x = 0.0f, rest_y = 0.0f;
  };
  /// Of two numbers as Sampler::bits gives them. Not of a black one.
  Block choose(const glm::uvec2& numbers) const;
  struct Sample {
    glm::vec3 direction{0.0f, 1.0f, 0.0f};
    Light light;
  };
  Sample sample(const Block& block) const;

 private:
  static constexpr int kBlock = 4;  // cells a side
  void fillPixels(const Environment& environment);
  void fillProjection(const Environment& environment, int order);
  void fillRows();
  void fillBlocks();
  const glm::vec4* texel(int cell_x, int cell_y) const {
    return &texels_[std::size_t(cell_y) * std::size_t(width_ + 1) + std::size_t(cell_x)];
  }
  void prefetch(int cell_x, int cell_y, int rows) const;
  Place placeOf(float longitude, float elevation, float cos_elevation) const;
  Place placeIn(const Block& block) const;

  int width_ = 0, height_ = 0;     // texels
  std::vector<glm::vec4> texels_;  // (width + 1) x (height + 2), a border around; w: importance
  float cos_rotation_ = 1.0f, sin_rotation_ = 0.0f, turned_ = 0.0f;
  sh::ShRgb projection_;  // order 0: pixels are the light
  int block_columns_ = 0;
  Distribution block_rows_;
  std::vector<Distribution> blocks_;  // of each row of blocks
  std::vector<std::uint8_t> lit_;     // blocks with any light
  struct Row {
    float solid_angle;  // of one cell, sr
    float density;      // times importance (/ cos elevation, but at the poles): the density
  };
  std::vector<Row> rows_;      // of cells
  float polar_height_ = 0.0f;  // of the caps above and below the outermost texel centres
};

}  // namespace gloam::reference
