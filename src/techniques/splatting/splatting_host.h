// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Twin of the passes from ranges to upsampling (rows MS-3 to MS-6, MS-9, MS-10) for devices that are the host: a software driver
// reads and writes texel by texel, the host's vector units take sixteen at a time, and what a band of the picture needs stays in
// the cache of one core.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "frame/frame_shared.h"
#include "techniques/splatting/splatting_shared.h"

namespace gloam::splatting {

/// What is kept of texels, a plane a number; as Ranges and Means of splatting_ranges.glsl.
enum Plane {
  kLowX,
  kLowY,
  kLowZ,
  kHighX,
  kHighY,
  kHighZ,
  kNear,
  kFar,
  kDepth,
  kNormalX,
  kNormalY,
  kNormalZ,
  kCovered,
  kMiddleX,
  kMiddleY,
  kPlanes
};

/// Texels of 2^k pixels a side.
struct HostLevel {
  int width = 0, height = 0;
  int stride = 0;  ///< texels from row to row of a plane: room for one on the left and for whole vectors
  std::vector<float> planes;  ///< one row more than the height; beyond the picture: no surface
  std::vector<glm::vec4>
      light;  ///< with a border of nothing. A: 0 empty, 1, or -1 where finer texels have the light
  std::vector<std::uint32_t> goes_on;  ///< as planes; splatting_upsample.glsl's four bits

  /// Forgets all light.
  void shape(int texels_across, int texels_down);
  float* plane(int which, int row) { return planes.data() + placeOf(which, row); }
  const float* plane(int which, int row) const { return planes.data() + placeOf(which, row); }
  glm::vec4* lightRow(int row);  ///< from its first texel; row -1 and the texels beside are the border
  const glm::vec4* lightRow(int row) const;

 private:
  std::size_t placeOf(int which, int row) const {
    return (std::size_t(which) * std::size_t(height + 1) + std::size_t(row)) * std::size_t(stride) + 1;
  }
};

/// Places that receive light, and what they got; whole vectors long.
struct HostPoints {
  static constexpr std::size_t kMultiple = 16;
  std::vector<float> x, y, z, normal_x, normal_y, normal_z, side;
  std::vector<float> red, green, blue, change, error;
  std::vector<std::uint32_t> place, level;  ///< place: as subsplats of lists, with kSplit
  std::size_t count = 0;

  void clear() { count = 0; }
  std::size_t add();  ///< index of a new one
};

struct HostLights {
  std::span<const SplatLight> rows;
  std::vector<std::span<const SplatLight>> sets;  ///< all lights first
};

struct HostPlan {
  int width = 0, height = 0, coarsest = 1;
  frame::FrameView view{};
  Thresholds thresholds{};
  float light_threshold = 0.0f, cluster_threshold = 0.0f;
  int bound_kind = 1;
  bool by_shading_normal = true, along_surfaces = true;
};

/// MS-6: row `row` of `coarse` for its children in two rows, of `width` (the second may be absent). `keeps`: what is lit stays.
void interpolateRow(const HostLevel& coarse, int row, bool keeps, int width, glm::vec4* first,
                    glm::vec4* second);

/// Working memory stays from frame to frame.
class HostSplatting {
 public:
  /// `depth`, `normals`: of the G-buffer; `irradiance`: a pixel each, written whole. Light is that of the same passes on the device but
  /// for rounding.
  void splat(const HostPlan& plan, const HostLights& lights, std::span<const float> depth,
             std::span<const glm::uvec2> normals, std::span<glm::vec4> irradiance);
  /// What the last picture took.
  const Counts& counts() const { return counts_; }

 private:
  struct Frame;
  /// A row of coarsest texels and all that is finer in them.
  struct Band {
    std::vector<std::vector<std::uint32_t>> queues, leaves;  // by level
    HostPoints looked, listed, fewer;
    std::vector<std::pair<std::uint32_t, glm::vec4>> pixels;
    Counts counts{};
  };
  void refine(const Frame& frame, Band& band, int row);
  void look(const Frame& frame, Band& band, int level);
  void gatherFiner(const Frame& frame, Band& band);
  void keepLight(const HostPoints& from, std::size_t i, Band& band);

  std::vector<HostLevel> levels_;  // level 0: pixels, none kept
  std::vector<Band> bands_;
  Counts counts_{};
};

}  // namespace gloam::splatting
