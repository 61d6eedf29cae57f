// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The lobes of math/brdf.h made ready for one point and one view direction: what a path asks of them several times is
// worked out once. Same functions, same samples (reference_test holds them against each other).
#pragma once

#include <algorithm>
#include <cmath>

#include "math/brdf.h"
#include "math/sampling.h"
#include "reference/angles.h"

namespace gloam::reference {

/// Lobes of one kind of surface.
struct LobesReady {
  brdf::Lobes lobes;
  float specular_share = 0.0f;   ///< brdf::specularProbability
  float phong_scale = 0.0f;      ///< (n + 1) / 2 pi
  float lambert_stretch = 1.0f;  ///< 1 / (1 - specular_share)
  bool black = true;

  LobesReady() = default;
  explicit LobesReady(const brdf::Lobes& given)
      : lobes(given),
        specular_share(brdf::specularProbability(given)),
        phong_scale((given.exponent + 1.0f) / (2.0f * sampling::kPi)),
        lambert_stretch(specular_share < 1.0f ? 1.0f / (1.0f - specular_share) : 0.0f),
        black(given.diffuse == glm::vec3(0.0f) && given.specular == glm::vec3(0.0f)) {}
};

/// Those lobes at a point.
class PointLobes {
 public:
  PointLobes() = default;
  /// Keeps a reference to `ready`.
  PointLobes(const LobesReady& ready, const glm::vec3& normal, const glm::vec3& to_view)
      : ready_(&ready), normal_(normal), mirror_(2.0f * glm::dot(normal, to_view) * normal - to_view) {}

  struct Value {
    glm::vec3 value{0.0f};  ///< brdf::evaluateLobes
    float pdf = 0.0f;       ///< brdf::lobesPdf
  };
  Value at(const glm::vec3& direction) const {
    const float lambert = std::max(0.0f, glm::dot(normal_, direction)) * (1.0f / sampling::kPi);
    if (ready_->specular_share == 0.0f) return {ready_->lobes.diffuse * lambert, lambert};
    const float phong = phongAt(glm::dot(mirror_, direction));
    return {ready_->lobes.diffuse * lambert + ready_->lobes.specular * phong,
            (1.0f - ready_->specular_share) * lambert + ready_->specular_share * phong};
  }

  /// brdf::sampleLobes with the choice of the lobe taken out of u.x, which is stretched for what comes next. Not for black
  /// lobes.
  glm::vec3 sample(glm::vec2 u) const {
    return choosesPhong(u.x) ? samplePhong(u) : angles::cosineAbout(normal_, stretched(u.x), u.y);
  }
  bool choosesPhong(float u) const { return u < ready_->specular_share; }
  glm::vec3 samplePhong(const glm::vec2& u) const {
    return sampling::frame(mirror_) *
           sampling::phongLobe({u.x / ready_->specular_share, u.y}, ready_->lobes.exponent);
  }
  float stretched(float u) const {
    return std::clamp((u - ready_->specular_share) * ready_->lambert_stretch, 0.0f, 0x1.fffffep-1f);
  }
  const glm::vec3& normal() const { return normal_; }

 private:
  float phongAt(float cosine) const {
    if (cosine <= 0.0f) return 0.0f;
    const float n = ready_->lobes.exponent;
    return ready_->phong_scale * (n == 1.0f ? cosine : std::pow(cosine, n));
  }

  const LobesReady* ready_ = nullptr;
  glm::vec3 normal_, mirror_;
};

}  // namespace gloam::reference
