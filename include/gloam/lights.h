// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light as shapes instead of pixels: discs, constant and gradient light, skies and probes, any number at once, each
// of them animated (SH-2, PRT-4; docs/lights.md). They reach spherical harmonics exactly and in microseconds; an Environment
// that shows them is painted where a picture of them is wanted.
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include <functional>
#include <span>

namespace gloam {

/// A distant light at one instant. Radiance in linear Rec. 709.
struct DistantLight {
  enum class Kind : std::uint8_t {
    kDisc,      ///< even radiance within a cone
    kConstant,  ///< the same from everywhere
    kGradient,  ///< linear in the sine of the elevation, apart above and below the horizon
    kFunction,  ///< a sky: any function of direction that may jump at the horizon
    kMap,       ///< a probe
  };
  Kind kind = Kind::kDisc;
  glm::vec3 direction{0.0f, 1.0f, 0.0f};                ///< disc: towards its middle, unit
  float radius_rad = 0.0f;                              ///< disc: half-angle, above 0 to pi
  glm::vec3 radiance{0.0f};                             ///< disc, constant
  glm::vec3 zenith{0.0f}, horizon{0.0f}, nadir{0.0f};   ///< gradient
  std::function<glm::vec3(const glm::vec3&)> function;  ///< function: radiance from a unit direction
  std::shared_ptr<const Environment> map;               ///< map, with a rotation and intensity of its own
  std::shared_ptr<const sh::ShRgb> known_sh;    ///< of order 6, of function and map; null: to be found
  float rotation_rad = 0.0f, intensity = 1.0f;  ///< of function and map: about +Y, as Environment has it
};

/// Radiance of a disc that gives `irradiance` on a small plane facing its middle.
glm::vec3 discRadiance(const glm::vec3& irradiance, float radius_rad);
/// Radiance that arrives from a direction.
glm::vec3 radianceFrom(const DistantLight& light, const glm::vec3& direction);
/// One light's spherical harmonics: discs, constant and gradient light in closed form; skies by quadrature of their function in
/// each half; probes by rotating the projection of their pixels. No image in between.
sh::ShRgb projectLight(const DistantLight& light, int order);
/// The sum over all.
sh::ShRgb projectLights(std::span<const DistantLight> lights, int order);

/// Lights as they were asked for: each value fixed or given by keys.
class AnimatedLights {
 public:
  /// Each text is "disc?azimuth=0:0,4:360&elevation=30&radius=3&irradiance=2" or the like (docs/lights.md), or names a .json
  /// file that holds a list of such texts. Throws Error that names the text and the key.
  static AnimatedLights parse(std::span<const std::string> texts);
  /// Throws Error where a sky is asked for what it cannot be at that time.
  std::vector<DistantLight> at(float time_s) const;
  bool empty() const { return lights_.empty(); }
  bool moves() const;
  std::string text() const;  ///< all texts, joined by " + "

  struct Light;

 private:
  std::vector<std::shared_ptr<const Light>> lights_;
};

/// What an environment was painted from, before its rotation and intensity.
struct EnvironmentLights {
  sh::ShRgb sh;                      ///< of order 6
  std::vector<DistantLight> lights;  ///< all of them, where describeLights() left `radiance` empty; else none
};

/// The lights as an Environment without texels, for Renderer::setEnvironment: a change of light costs microseconds, whatever
/// is drawn. Where they are seen, discs are drawn as they are; a single map is uploaded once, however it turns and fades; what
/// else there is gets painted in the first frame that shows it. The path tracer wants paintLights().
Environment describeLights(std::vector<DistantLight> lights);
/// An environment as one light of several, projected once. An empty one is a map of black.
DistantLight mapLight(Environment environment);

/// `base` (may be empty) with the lights added, to look at and to trace: an equirectangular map in which each disc covers
/// its exact share of every texel, as fine as the smallest disc needs (3 texels across, at most 4096 x 2048). `base` keeps its
/// texels where it is that large, and its rotation. The spherical harmonics are those of base and lights, not of the map.
Environment paintLights(const Environment& base, std::span<const DistantLight> lights);

}  // namespace gloam
