// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Skies made by code, as functions, discs and ground, and painted into an equirectangular map: gradients, the CIE overcast sky (L = L_z (1 + 2 sin e) / 3),
// clear daylight (preetham.cpp), and lamps as discs that keep their energy whatever the size of a texel.
#include <fmt/core.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/environment.h"
#include "scene/named_values.h"
#include "scene/preetham.h"
#include "scene/sky.h"

namespace gloam {
namespace {
constexpr float kPi = 3.14159265f;
constexpr float kDegree = kPi / 180.0f;
}  // namespace

glm::vec3 skyDirection(float elevation_deg, float azimuth_deg) {
  const float e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

namespace {

constexpr int kWidth = 512, kHeight = 256;

float texelSolidAngle(int row) {
  const float top = std::sin(kPi * (0.5f - float(row) / kHeight));
  const float bottom = std::sin(kPi * (0.5f - float(row + 1) / kHeight));
  return 2.0f * kPi / kWidth * (top - bottom);
}

Environment painted(const std::function<glm::vec3(const glm::vec3& direction)>& radiance) {
  Environment sky;
  sky.width = kWidth;
  sky.height = kHeight;
  sky.radiance.resize(std::size_t(kWidth) * kHeight);
  tbb::parallel_for(0, kHeight, [&](int row) {
    for (int column = 0; column < kWidth; ++column) {
      sky.radiance[std::size_t(row) * kWidth + std::size_t(column)] =
          radiance(texelDirection(sky, column, row));
    }
  });
  return sky;
}

// Share of a texel that lies within a cone, by 16 x 16 points of equal solid angle.
float coveredShare(int column, int row, const glm::vec3& axis, float cos_half_angle) {
  constexpr int kPoints = 16;
  const float sin_top = std::sin(kPi * (0.5f - float(row) / kHeight));
  const float sin_bottom = std::sin(kPi * (0.5f - float(row + 1) / kHeight));
  int inside = 0;
  for (int j = 0; j < kPoints; ++j) {
    const float y = sin_top + (sin_bottom - sin_top) * (float(j) + 0.5f) / kPoints;
    const float r = std::sqrt(std::max(0.0f, 1.0f - y * y));
    for (int i = 0; i < kPoints; ++i) {
      const float phi = 2 * kPi * ((float(column) + (float(i) + 0.5f) / kPoints) / kWidth - 0.5f);
      if (glm::dot(axis, glm::vec3(r * std::cos(phi), y, r * std::sin(phi))) >= cos_half_angle) ++inside;
    }
  }
  return float(inside) / float(kPoints * kPoints);
}

/// Adds a disc of even radiance that gives `irradiance` on a small plane facing it: its energy is exact however coarsely
/// texels sample it.
void addDisc(Environment& sky, const SkyDisc& disc) {
  const auto& [axis, half_angle_rad, irradiance] = disc;
  const float cos_half = std::cos(half_angle_rad);
  const float cos_reach = std::cos(std::min(kPi, half_angle_rad + 2.0f * kPi / kHeight));
  std::vector<float> weights(sky.radiance.size(), 0.0f);
  double sum = 0.0;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      if (glm::dot(texelDirection(sky, column, row), axis) < cos_reach) continue;
      const float share = coveredShare(column, row, axis, cos_half);
      weights[std::size_t(row) * kWidth + std::size_t(column)] = share;
      sum += double(share) * texelSolidAngle(row);
    }
  }
  if (sum <= 0.0) return;
  // Facing the disc, sin^2 of its half-angle times pi is its projected solid angle.
  const double exact = 2.0 * kPi * (1.0 - std::cos(double(half_angle_rad)));
  const double projected = kPi * std::pow(std::sin(double(half_angle_rad)), 2.0);
  const glm::vec3 radiance = irradiance * float(exact / projected / sum);
  for (std::size_t i = 0; i < weights.size(); ++i) sky.radiance[i] += weights[i] * radiance;
}

/// What falls on level ground.
glm::vec3 groundIrradiance(const Environment& sky) {
  glm::dvec3 sum(0.0);
  for (int row = 0; row < kHeight / 2; ++row) {
    const float up = std::sin(kPi * (0.5f - (float(row) + 0.5f) / kHeight)) * texelSolidAngle(row);
    for (int column = 0; column < kWidth; ++column) {
      sum += glm::dvec3(sky.radiance[std::size_t(row) * kWidth + std::size_t(column)] * up);
    }
  }
  return glm::vec3(sum);
}

/// Fills the half below the horizon with what a level ground of that albedo sends back.
void addGround(Environment& sky, const glm::vec3& albedo) {
  const glm::vec3 radiance = albedo * groundIrradiance(sky) / kPi;
  std::fill(sky.radiance.begin() + std::ptrdiff_t(kWidth) * kHeight / 2, sky.radiance.end(), radiance);
}

// ---- The skies ----------------------------------------------------------------------------------------------------

SkyParts parts(std::function<glm::vec3(const glm::vec3& direction)> radiance) {
  return {.radiance = std::move(radiance)};
}

SkyParts uniform(NamedValues&) {
  return parts([](const glm::vec3&) { return glm::vec3(1.0f); });
}

glm::vec3 gradientAt(float y, const glm::vec3& zenith, const glm::vec3& horizon, const glm::vec3& nadir) {
  return y >= 0.0f ? glm::mix(horizon, zenith, y) : glm::mix(horizon, nadir, -y);
}

SkyParts gradient(NamedValues&) {
  return parts([](const glm::vec3& d) {
    return gradientAt(d.y, {0.25f, 0.45f, 0.95f}, {0.95f, 0.95f, 0.9f}, {0.28f, 0.24f, 0.2f});
  });
}

// A bright, slightly cool room of light with a broad warm key from the upper left: shows form, hurts nobody.
SkyParts mild(NamedValues& values) {
  const glm::vec3 key = skyDirection(float(values.take("elevation", 48, -90, 90)),
                                     float(values.take("azimuth", -40, -360, 360)));
  return parts([key](const glm::vec3& d) {
    const glm::vec3 base = gradientAt(d.y, {0.30f, 0.39f, 0.56f}, {0.46f, 0.48f, 0.5f}, {0.2f, 0.17f, 0.14f});
    return base + glm::vec3(3.2f, 2.85f, 2.35f) * std::exp(9.0f * (glm::dot(d, key) - 1.0f));
  });
}

SkyParts overcast(NamedValues& values) {
  const float albedo = float(values.take("ground", 0.25, 0, 1));
  SkyParts sky = parts([](const glm::vec3& d) {
    return glm::vec3(0.97f, 1.0f, 1.06f) * (1.15f * (1.0f + 2.0f * std::max(0.0f, d.y)) / 3.0f);
  });
  sky.ground_albedo = glm::vec3(albedo);
  return sky;
}

SkyParts daylight(NamedValues& values, float elevation_deg, float azimuth_deg, float turbidity) {
  const glm::vec3 sun = skyDirection(float(values.take("elevation", elevation_deg, 0.5, 90)),
                                     float(values.take("azimuth", azimuth_deg, -360, 360)));
  const PreethamSky model(sun, float(values.take("turbidity", turbidity, 1.7, 10)));
  const float sun_strength = float(values.take("sun", 1, 0, 1000));
  const float sun_half_angle = 0.5f * kDegree * float(values.take("sun_size", 0.533, 0.1, 90));
  const float albedo = float(values.take("ground", 0.2, 0, 1));
  SkyParts sky = parts([=](const glm::vec3& d) { return model.radiance(d); });
  if (sun_strength > 0.0f) sky.discs.push_back({sun, sun_half_angle, sun_strength * model.sunIrradiance()});
  sky.ground_albedo = albedo * glm::vec3(1.06f, 1.0f, 0.9f);
  return sky;
}

SkyParts preetham(NamedValues& values) {
  return daylight(values, 40, -45, 3);
}
SkyParts noon(NamedValues& values) {
  return daylight(values, 65, -35, 2.5f);
}

// A low sun in haze: deep blue overhead, a band of orange round the horizon that glows towards the sun.
SkyParts sunset(NamedValues& values) {
  const float elevation = float(values.take("elevation", 7, 0.5, 30));
  const float azimuth = float(values.take("azimuth", -60, -360, 360));
  const glm::vec3 sun = skyDirection(elevation, azimuth);
  SkyParts sky = parts([=](const glm::vec3& d) {
    const float up = std::max(0.0f, d.y), toward = glm::dot(d, sun);
    const float haze = std::exp(-5.0f * up), side = 0.5f + 0.5f * toward;
    const glm::vec3 vault = glm::mix(glm::vec3(0.20f, 0.27f, 0.50f), glm::vec3(0.09f, 0.15f, 0.36f), up);
    const glm::vec3 band =
        glm::mix(glm::vec3(0.36f, 0.30f, 0.40f), glm::vec3(1.5f, 0.72f, 0.30f), side * side);
    return glm::mix(vault, band, haze) + glm::vec3(2.6f, 1.15f, 0.38f) * std::exp(14.0f * (toward - 1.0f));
  });
  sky.discs.push_back({sun, 0.27f * kDegree, {2.6f, 1.25f, 0.45f}});
  sky.ground_albedo = {0.24f, 0.2f, 0.17f};
  return sky;
}

// A dark studio: a large key, a cool fill and a rim light behind.
SkyParts studio(NamedValues&) {
  SkyParts sky = parts([](const glm::vec3& d) { return glm::vec3(0.035f + 0.04f * std::max(0.0f, d.y)); });
  sky.discs.push_back({skyDirection(48, -45), 24 * kDegree, {2.1f, 2.0f, 1.83f}});
  sky.discs.push_back({skyDirection(20, 75), 30 * kDegree, {0.22f, 0.27f, 0.36f}});
  sky.discs.push_back({skyDirection(35, 165), 12 * kDegree, {0.7f, 0.72f, 0.8f}});
  return sky;
}

struct Sky {
  BuiltinScene about;
  SkyParts (*make)(NamedValues&);
};

const std::vector<Sky>& skies() {
  static const std::vector<Sky> all = {
      {{"uniform", "white light from everywhere: the furnace"}, uniform},
      {{"mild",
        "bright room of light with a broad warm key (elevation, azimuth): where a scene has no light"},
       mild},
      {{"gradient", "linear from zenith to horizon to ground"}, gradient},
      {{"overcast", "CIE overcast sky over grey ground (ground)"}, overcast},
      {{"noon", "clear noon, Preetham's daylight with its sun (all of preetham's values)"}, noon},
      {{"sunset", "low sun in an orange haze under a blue vault (elevation, azimuth)"}, sunset},
      {{"studio", "dark room with key, fill and rim light"}, studio},
      {{"preetham", "clear daylight (elevation, azimuth, turbidity, sun, sun_size, ground)"}, preetham},
  };
  return all;
}

}  // namespace

const std::vector<BuiltinScene>& builtinSkies() {
  static const std::vector<BuiltinScene> list = [] {
    std::vector<BuiltinScene> names;
    for (const Sky& sky : skies()) names.push_back(sky.about);
    return names;
  }();
  return list;
}

SkyParts skyParts(NamedValues& values) {
  std::vector<std::string> names;
  for (const Sky& sky : skies()) {
    names.emplace_back(sky.about.name);
    if (values.name() != sky.about.name) continue;
    const auto intensity = float(values.take("intensity", 1, 0, 1e6));
    const auto rotation_deg = float(values.take("rotation", 0, -36000, 36000));
    // Values are known only once the sky has asked for them; making it is cheap enough to do before the last check.
    SkyParts made = sky.make(values);
    values.finish();
    made.intensity = intensity;
    made.rotation_rad = rotation_deg * kDegree;
    return made;
  }
  throw Error(values.place(), fmt::format("no such sky; there are {}", fmt::join(names, ", ")));
}

Environment makeSky(const std::string& description) {
  NamedValues values("sky:", description);
  const SkyParts parts = skyParts(values);
  Environment sky = painted(parts.radiance);
  for (const SkyDisc& disc : parts.discs) addDisc(sky, disc);
  if (parts.ground_albedo) addGround(sky, *parts.ground_albedo);
  sky.name = "sky:" + description;
  sky.intensity = parts.intensity;
  sky.rotation_rad = parts.rotation_rad;
  return sky;
}

}  // namespace gloam
