// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lamps beside something: rays from lamps find the same light as steps by lobes do alone (Sampling::kLights), and sooner.
#include "reference/lamp_shots.h"

#include <numbers>

#include "reference/test_points.h"
#include "scene/builtin_shapes.h"

namespace gloam::reference {
namespace {

const Part kBounced = sumOf({kLocalIndirect});

Light lampOf(float intensity, Light::Type type = Light::Type::kPoint) {
  Light lamp;
  lamp.type = type;
  lamp.intensity = glm::vec3(intensity);
  lamp.outer_cone_rad = 0.9f;
  return lamp;
}

/// Inside a sphere of radius 1: what one place reflects lights all others alike, wherever the lamp hangs. So the first bounce
/// has the radiance rho / pi * rho I, and each further one rho times that.
TEST(LampShots, LampAtTheWallOfASphere) {
  constexpr double kAlbedo = 0.5, kIntensity = 2.0;
  for (const float x : {0.0f, 0.98f}) {
    SceneBuilder builder("sphere");
    builder.place("sphere", shapes::icosphere(1.0f, 64),
                  builder.diffuse("inside", glm::vec3(float(kAlbedo))));
    builder.light(lampOf(float(kIntensity)), {x, 0.0f, 0.0f});
    const Scene scene = builder.finish();
    const PosedCamera camera = lookingAt({-0.3f, 0.1f, 0.0f}, {-0.6f, -0.8f, 0.1f});
    const double once = kAlbedo * kAlbedo * kIntensity / std::numbers::pi;
    const Estimate one = estimate(scene, camera, {}, onePixel(1), 2048, kBounced);
    expectTruth(one, once, 1e-3);
    expectTruth(estimate(scene, camera, {}, onePixel(3), 8192, kBounced), once * 1.75, 1e-3);
    const Estimate alone = estimate(scene, camera, {}, onePixel(1), 2048, kBounced, Sampling::kLights);
    if (x == 0.0f)
      EXPECT_EQ(one.mean, alone.mean);  // nothing is near: no rays are shot
    else
      EXPECT_LT(one.error, 0.25 * alone.error);
  }
}

/// Of five lamps three hang near to something; glossy floor, normal away from the geometric one, two bounces.
Scene nook() {
  SceneBuilder builder("nook");
  Mesh floor = shapes::ground(4.0f, 4.0f, 1, 1);
  for (glm::vec3& normal : floor.normals) normal = glm::normalize(normal + glm::vec3(0.2f, 0.0f, 0.1f));
  builder.place("floor", std::move(floor), builder.glossy("glossy", glm::vec3(0.4f), 0.4f));
  builder.place("wall", shapes::box({-1.2f, 0.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, 2.0f),
                builder.diffuse("wall", glm::vec3(0.8f)));
  builder.place("thin", shapes::box({0.2f, 0.0f, 0.4f}, {0.9f, 0.8f, 0.42f}, 2.0f),
                builder.glossy("thin", glm::vec3(0.6f), 0.7f));
  builder.light(lampOf(0.5f), {-0.96f, 0.7f, 0.1f});
  builder.light(lampOf(1.5f, Light::Type::kSpot), {-0.9f, 0.9f, -0.3f}, {-1.0f, -0.2f, 0.1f});
  builder.light(lampOf(0.3f), {0.5f, 0.4f, 0.37f});
  builder.light(lampOf(4.0f), {1.5f, 3.0f, 1.0f});
  builder.light(lampOf(0.5f, Light::Type::kDirectional), {0.0f, 3.0f, 0.0f}, {-0.5f, -1.0f, -0.3f});
  return builder.finish();
}

TEST(LampShots, EveryWayHasTheSameMean) {
  const Scene scene = nook();
  for (const int bounces : {1, 2}) {
    for (const glm::vec3& target : {glm::vec3(0.0f), glm::vec3(-1.0f, 0.5f, 0.3f)}) {
      const PosedCamera camera = lookingAt({1.0f, 1.0f, 0.2f}, target);
      const auto by = [&](Sampling how, int samples) {
        return estimate(scene, camera, {}, onePixel(bounces), samples, kBounced, how);
      };
      const Estimate joined = by(Sampling::kBoth, 8192), alone = by(Sampling::kLights, 32768);
      const double both = std::hypot(joined.error, alone.error);
      EXPECT_LT(std::abs(joined.mean - alone.mean), 4.0 * both)
          << joined.mean << " +- " << joined.error << ", " << alone.mean << " +- " << alone.error;
      EXPECT_LT(both, 0.03 * joined.mean);
    }
  }
}

TEST(LampShots, OnlyLampsNearToSomethingShoot) {
  const Scene scene = nook();
  const PosedScene posed = pose(scene, 0.0f);
  const trace::Tracer tracer(scene, posed, {.reproducible = true, .robust = true});
  std::vector<Lamp> lamps = makeLamps(posed);
  EXPECT_TRUE(LampShots(lamps, tracer, {}).empty());
  const std::vector<glm::vec3> seen = {glm::vec3(0.0f), glm::vec3(-1.0f, 0.5f, 0.3f),
                                       glm::vec3(0.5f, 0.0f, -0.5f)};
  const LampShots shots(lamps, tracer, seen);
  ASSERT_EQ(lamps.size(), 5u);
  ASSERT_FALSE(shots.empty());
  for (std::size_t i = 0; i < lamps.size(); ++i) EXPECT_EQ(lamps[i].shot_density > 0.0f, i < 3) << i;
  // Directions come as densely as is said: a lamp's share of them over the angle that it shines to.
  std::vector<double> share(lamps.size(), 0.0);
  constexpr std::uint32_t kShots = 4096;
  for (std::uint32_t i = 0; i < kShots; ++i) {
    const LampShots::Shot shot = shots.shoot(i << 20, {float(i % 64) / 64.0f, float(i % 61) / 61.0f});
    share[std::size_t(shot.lamp)] += 1.0 / kShots;
    EXPECT_NEAR(glm::length(shot.direction), 1.0f, 1e-5f);
    if (shot.lamp == 1) {
      EXPECT_GE(glm::dot(shot.direction, lamps[1].direction), lamps[1].cos_outer - 1e-5f);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i == 1 ? 1.0 - double(lamps[i].cos_outer) : 2.0);
    EXPECT_NEAR(share[i], double(lamps[i].shot_density) * angle, 1e-3) << i;
  }
}

// What a sample brings does not depend on how many are traced together.
TEST(LampShots, SameBitsInAnyCompany) {
  const Scene scene = nook();
  const Integrator integrator(scene, pose(scene, 0.0f), lookingAt({1.0f, 1.0f, 0.2f}, glm::vec3(0.0f)), {},
                              onePixel(2), {});
  const CameraPoint point = integrator.look(0, 0);
  std::vector<PathLight> together(37);
  std::size_t rays = 0, rays_alone = 0;
  integrator.trace(point, 0, 0, 5, 3, together, rays);
  for (std::uint32_t i = 0; i < together.size(); ++i)
    EXPECT_EQ(integrator.trace(point, 0, 0, 5, 3 + i, rays_alone), together[i]) << i;
  EXPECT_EQ(rays, rays_alone);
}

}  // namespace
}  // namespace gloam::reference
