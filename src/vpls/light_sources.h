// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Everything that sends light by itself, to begin walks at.
#pragma once

#include "frame/lights.h"
#include "visibility/host_world.h"
#include "vpls/environment_table.h"
#include "vpls/walk_focus.h"

namespace gloam::vpls {

/// Triangles that glow, to both sides (as the reference has it), chosen by area times mean emission.
class Emitters {
 public:
  Emitters() = default;
  explicit Emitters(const visibility::HostWorld& world);

  struct Sample {
    glm::vec3 position{0.0f}, normal{0.0f, 1.0f, 0.0f};
    float offset = 0.0f;
    glm::vec3 light{0.0f};  ///< radiance over density: square metres times radiance
    float area = 0.0f;      ///< one over density
  };
  Sample sample(const glm::vec2& u) const;
  /// What leaves them all, both sides: watts, the mean of the colours.
  double power() const { return power_; }
  bool empty() const { return choice_.empty(); }

 private:
  struct Triangle {
    glm::vec3 corner, edge_u, edge_v, normal;
    float offset, area;
    int mesh, triangle;
  };
  const visibility::HostWorld* world_ = nullptr;
  std::vector<Triangle> triangles_;
  Choice choice_;
  double power_ = 0.0;
};

/// The mean emission of each triangle of a mesh, over its texture; empty where it does not glow.
std::vector<float> meanEmission(const Scene& scene, const Mesh& mesh);

/// The faces of a box through which light of one direction enters it.
class EntryFaces {
 public:
  EntryFaces(const glm::vec3& low, const glm::vec3& high, const glm::vec3& direction);
  /// Square metres across the direction.
  float area() const { return area_; }
  /// A point a little before one of them, evenly spread as seen along the direction.
  glm::vec3 point(const glm::vec2& u) const;

 private:
  glm::vec3 low_, high_, direction_;
  glm::vec3 across_;  // area of the face of each axis, across the direction
  float area_;
};

/// A ray of light, and what it carries: the mean over all u of what arrives where rays end is the light of all sources.
struct Emitted {
  glm::vec3 origin{0.0f}, direction{0.0f, 1.0f, 0.0f};
  glm::vec3 flux{0.0f};  ///< watts over density; zero: no ray
  float spread = 0.0f;   ///< steradians over which the ray stands for light, over density
  float area = 0.0f;     ///< square metres across it where it begins, over density
  float range = 0.0f;    ///< of a lamp
};

class LightSources {
 public:
  LightSources() = default;
  /// Keeps references to all but the lamps and the focus. Of what comes from far away, a share enters by the focus.
  LightSources(std::vector<frame::LightRow> lamps, const Emitters& emitters,
               const EnvironmentTable& environment, const glm::vec3& low, const glm::vec3& high,
               Focus focus = {});
  bool dark() const { return choice_.empty(); }
  /// Watts in the end, roughly: what choices go by.
  double emittersPower() const { return emitters_->power(); }
  double environmentPower() const { return environment_power_; }
  /// u[0] chooses the source and its direction or place, u[1] its place or direction, u[2] its side.
  Emitted emit(const glm::vec2 u[3]) const;

 private:
  Emitted fromLamp(const frame::LightRow& lamp, const glm::vec2& direction, const glm::vec2& place) const;
  /// Of irradiance on a plane across the direction.
  Emitted fromAfar(const glm::vec3& direction, const glm::vec3& irradiance, const glm::vec2& place) const;

  std::vector<frame::LightRow> lamps_;
  const Emitters* emitters_ = nullptr;
  const EnvironmentTable* environment_ = nullptr;
  glm::vec3 low_{0.0f}, high_{0.0f};
  Focus focus_;
  double environment_power_ = 0.0;
  Choice choice_;  // lamps, emitters, environment
};

/// Watts that a lamp sends, the mean of the colours; a directional one into the box.
double lampPower(const frame::LightRow& lamp, const glm::vec3& low, const glm::vec3& high);

}  // namespace gloam::vpls
