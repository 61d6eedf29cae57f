// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// For tests: light at the middle of a one-pixel picture, its mean and how sure it is.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/integrator.h"
#include "scene/scene_builder.h"

namespace gloam::reference {

inline constexpr int kReplicates = 16;

/// Looks from `eye` at `target`.
inline PosedCamera lookingAt(const glm::vec3& eye, const glm::vec3& target) {
  PosedCamera camera;
  camera.camera.vertical_fov_rad = 0.01f;
  camera.camera.z_near = 1e-3f;
  camera.world_from_view = glm::mat4(glm::mat3_cast(lookingAlong(glm::normalize(target - eye))));
  camera.world_from_view[3] = glm::vec4(eye, 1.0f);
  return camera;
}

inline ReferenceOptions onePixel(int bounces, const Coverage& light = kAllLight) {
  ReferenceOptions options;
  options.width = options.height = 1;
  options.bounces = bounces;
  options.light = light;
  return options;
}

inline Environment uniformSky(const glm::vec3& radiance = glm::vec3(1.0f)) {
  Environment sky;
  sky.width = 8;
  sky.height = 4;
  sky.radiance.assign(32, radiance);
  return sky;
}

/// What one pixel shows: of some paths the sum, its mean over independent seeds, its standard error.
struct Estimate {
  double mean = 0.0, error = 0.0;
};

/// Indirect light after any number of bounces.
using Part = std::function<double(const PathLight&)>;
inline Part sumOf(std::vector<LightPath> paths) {
  return [paths](const PathLight& light) {
    double sum = 0.0;
    for (int path = 0; path < kLightPathCount; ++path) {
      if (std::ranges::find(paths, memberOf(LightPath(path))) != paths.end())
        sum += double(light[std::size_t(path)].g);
    }
    return sum;
  };
}
inline Part allLight() {
  return sumOf({kEnvironmentDirect, kEnvironmentIndirect, kLocalDirect, kLocalIndirect, kEmitterDirect,
                kEmitterIndirect});
}

inline Estimate estimate(const Scene& scene, const PosedCamera& camera, const Environment& environment,
                         ReferenceOptions options, int samples, const Part& part = allLight(),
                         Sampling sampling = Sampling::kBoth) {
  const PosedScene posed = pose(scene, 0.0f);
  const Integrator integrator(scene, posed, camera, environment, options, {}, sampling);
  const CameraPoint point = integrator.look(0, 0);
  EXPECT_NE(point.instance, kNone);
  double sum = 0.0, squares = 0.0;
  std::size_t rays = 0;
  for (std::uint32_t replicate = 0; replicate < std::uint32_t(kReplicates); ++replicate) {
    double of_replicate = 0.0;  // pixels are independent of each other, as seeds are
    for (std::uint32_t i = 0; i < std::uint32_t(samples); ++i)
      of_replicate += part(integrator.trace(point, 0, 0, replicate * 7919u, i, rays));
    of_replicate /= samples;
    sum += of_replicate;
    squares += of_replicate * of_replicate;
  }
  Estimate result;
  result.mean = sum / kReplicates;
  result.error =
      std::sqrt(std::max(0.0, squares / kReplicates - result.mean * result.mean) / (kReplicates - 1));
  return result;
}

/// Within four standard errors, and those below 0.2 %. `known` is how exactly the truth itself is known, as a share: of a
/// mesh that stands for a curved body, or of floats.
inline void expectTruth(const Estimate& estimate, double truth, double known = 2e-5) {
  EXPECT_LE(std::abs(estimate.mean - truth), 4.0 * estimate.error + known * truth)
      << "mean " << estimate.mean << ", truth " << truth << ", standard error " << estimate.error;
  EXPECT_LT(estimate.error, 0.002 * truth);
}

}  // namespace gloam::reference
