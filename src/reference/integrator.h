// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One path at a time: what a point of the picture sees, and the light that a sample of all paths to it brings. The driver
// (path_tracer.cpp) decides how many and sums them up.
#pragma once

#include <gloam/reference.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "trace/tracer.h"

namespace gloam::reference {

/// Indirect light is told apart by its bounces; that of so many and more is one sum.
inline constexpr int kBouncesApart = 4;
/// Where light of a sample comes from, and by which path: Coverage's members in their order, indirect light of one bounce; what is
/// seen without any surface between (emission, background); then, source by source, light of two bounces, three, four and more.
enum LightPath : int {
  kEnvironmentDirect,
  kEnvironmentIndirect,
  kLocalDirect,
  kLocalIndirect,
  kEmitterDirect,
  kEmitterIndirect,
  kSeen,
  kFurther,
  kLightPathCount = kFurther + 3 * (kBouncesApart - 1),
};
/// Of a source, named by its direct path.
constexpr LightPath pathAfter(LightPath direct, int bounces) {
  if (bounces < 2) return LightPath(direct + bounces);
  const int apart = bounces < kBouncesApart ? bounces : kBouncesApart;
  return LightPath(kFurther + (kBouncesApart - 1) * (direct / 2) + apart - 2);
}
/// Bounces of its light; kBouncesApart: and more.
constexpr int bouncesOf(LightPath path) {
  if (path < kFurther) return path == kSeen ? 0 : path % 2;
  return (path - kFurther) % (kBouncesApart - 1) + 2;
}
/// The path of Coverage's member that it belongs to; kSeen itself.
constexpr LightPath memberOf(LightPath path) {
  return path < kFurther ? path : LightPath(2 * ((path - kFurther) / (kBouncesApart - 1)) + 1);
}
using PathLight = std::array<glm::vec3, kLightPathCount>;

/// What the ray of one position in the picture meets: found once, all samples of that position start here.
struct CameraPoint {
  int instance = kNone;  ///< index into PosedScene::instances; kNone: background
  int triangle = 0;
  float u = 0.0f, v = 0.0f;
  float eye_depth = 0.0f;                  ///< 0: background
  glm::vec3 position{0.0f}, to_eye{0.0f};  ///< to_eye unit
  glm::vec3 geometric_normal{0.0f};        ///< unit, toward the eye
  glm::vec3 normal{0.0f};  ///< shading normal, by the rule of sides (frame/README.md); as albedo
  glm::vec3 albedo{0.0f};  ///< k_d, the texture averaged over the pixel
  /// Change of a texture coordinate's place on the triangle (u, v) from one pixel to the next: textures are averaged over
  /// the pixel, as a rasteriser's mip levels do; edges stay where the one ray finds them.
  glm::vec2 uv_per_x{0.0f}, uv_per_y{0.0f};
};

/// How a direction to a source is found. Each is right; together they are quiet (Veach 1997). Alone they are for tests.
enum class Sampling { kBoth, kLights, kLobes };

/// Thread-safe once built. Keeps references to `scene` alone.
class Integrator {
 public:
  Integrator(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
             const Environment& environment, const ReferenceOptions& options, const Progress& progress,
             Sampling sampling = Sampling::kBoth);
  ~Integrator();
  Integrator(const Integrator&) = delete;

  /// Position (x, y) of the supersampled picture, pixel centres: 0 <= x < width * supersample.
  CameraPoint look(int x, int y) const;
  /// Sample `sample` of all paths that start at a point. `pixel` decorrelates neighbours. Where nothing was met
  /// it is the background's radiance somewhere in the pixel. `rays` is raised by the rays traced, and `log` gets them.
  PathLight trace(const CameraPoint& point, int x, int y, std::uint32_t pixel, std::uint32_t sample,
                  std::size_t& rays, std::vector<trace::LoggedRay>* log = nullptr) const;
  /// The same for samples first, first + 1 … of a point, one an entry of `light`: faster, the more (16 do).
  void trace(const CameraPoint& point, int x, int y, std::uint32_t pixel, std::uint32_t first,
             std::span<PathLight> light, std::size_t& rays,
             std::vector<trace::LoggedRay>* log = nullptr) const;

  /// Which sources the scene has at all: parts of others stay 0 and need no memory.
  bool has(LightPath path) const;
  const trace::Tracer& tracer() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam::reference
