// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Scenes with one right answer, known in closed form. The mean over 16 independent runs lies within four standard errors,
// and those are below 0.2 %.
#include "reference/integrator.h"

#include <tbb/parallel_for.h>

#include <numbers>

#include "math/brdf.h"
#include "reference/test_points.h"
#include "scene/builtin_shapes.h"
#include "scene/environment.h"
#include "scene/scene_builder.h"

namespace gloam::reference {
namespace {

constexpr double kPi = std::numbers::pi;

Mesh floorMesh(float size = 20.0f) {
  return shapes::ground(size, size, 1, 1);
}

Scene plane(float albedo) {
  SceneBuilder builder("plane");
  builder.place("floor", floorMesh(), builder.diffuse("grey", glm::vec3(albedo)));
  return builder.finish();
}

int emissive(SceneBuilder& builder, float radiance) {
  const int material = builder.diffuse("light", glm::vec3(0.0f));
  builder.material(material).emission = glm::vec3(radiance);
  return material;
}

Mesh discMesh(float radius, float height, int segments) {
  Mesh mesh;
  mesh.positions.push_back({0.0f, height, 0.0f});
  for (int i = 0; i < segments; ++i) {
    const double phi = 2.0 * kPi * i / segments;
    mesh.positions.push_back({radius * std::cos(phi), height, radius * std::sin(phi)});
    mesh.indices.insert(mesh.indices.end(),
                        {0u, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % segments)});
  }
  mesh.normals.assign(mesh.positions.size(), {0.0f, -1.0f, 0.0f});
  return mesh;
}

const PosedCamera kOntoFloor = lookingAt({2.0f, 1.0f, 0.5f}, {0.0f, 0.0f, 0.0f});

TEST(Furnace, ConvexWhiteBodiesAreOne) {
  const Scene scene = loadScene("builtin:furnace");
  for (const float x : {0.0f, 0.6f, 0.95f}) {
    const PosedCamera camera = lookingAt({x, 0.2f, 5.0f}, {x, 0.2f, 0.0f});
    expectTruth(estimate(scene, camera, uniformSky(), onePixel(3), 256), 1.0, 1e-5);
  }
}

TEST(Furnace, ConcaveWhiteBodiesTendToOne) {
  const Scene scene = loadScene("builtin:furnace-concave");
  const PosedCamera camera = lookingAt({0.0f, 3.2f, 3.2f}, {0.0f, -0.6f, 0.0f});
  expectTruth(estimate(scene, camera, uniformSky(), onePixel(256), 4096), 1.0, 1e-4);
  const Estimate few = estimate(scene, camera, uniformSky(), onePixel(1), 256);
  EXPECT_LT(few.mean + 10 * few.error, 1.0);
}

// E = pi L sin^2 of the half-angle, straight above; each of the two ways of writing down the same disc.
TEST(Lights, DiscOfTheSkyOverAPlane) {
  Environment sky = uniformSky(glm::vec3(0.0f));
  sky.width = 512;
  sky.height = 512;
  constexpr int kRows = 64;
  sky.radiance.assign(512 * 512, glm::vec3(0.0f));
  std::fill_n(sky.radiance.begin(), 512 * kRows, glm::vec3(2.0f));
  sky.rotation_rad = 1.0f;
  sky.intensity = 0.5f;
  const double sine = std::sin(kPi * kRows / 512);
  for (const Sampling how : {Sampling::kBoth, Sampling::kLights, Sampling::kLobes}) {
    const Estimate e = estimate(plane(0.6f), kOntoFloor, sky, onePixel(0), 2048, allLight(), how);
    expectTruth(e, 0.6 * sine * sine, 1e-4);
  }
}

TEST(Lights, DiscMeshOverAPlane) {
  SceneBuilder builder("disc");
  builder.place("floor", floorMesh(), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.place("disc", discMesh(0.7f, 1.5f, 400), emissive(builder, 3.0f));
  const double squared_sine = 0.49 / (0.49 + 2.25);
  const Scene scene = builder.finish();
  for (const Sampling how : {Sampling::kBoth, Sampling::kLights, Sampling::kLobes}) {
    const Estimate e = estimate(scene, kOntoFloor, {}, onePixel(1), 4096, allLight(), how);
    expectTruth(e, 0.5 * 3.0 * squared_sine, 2e-4);
  }
}

// A sphere of radius r at distance d, at an angle: E = pi L (r / d)^2 cos, as long as all of it is above the horizon.
TEST(Lights, SphereOverAPlane) {
  SceneBuilder builder("sphere");
  builder.place("floor", floorMesh(), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.place("ball", shapes::icosphere(0.4f, 64), emissive(builder, 4.0f), {0.8f, 1.2f, 0.0f});
  const double squared = 0.8 * 0.8 + 1.2 * 1.2;
  const double truth = 0.5 * 4.0 * (0.16 / squared) * (1.2 / std::sqrt(squared));
  const Estimate e =
      estimate(builder.finish(), lookingAt({-2.0f, 1.0f, 0.5f}, {0.0f, 0.0f, 0.0f}), {}, onePixel(0), 4096);
  expectTruth(e, truth, 3e-4);
}

TEST(Lights, PointLampOverAPlaneIsExact) {
  SceneBuilder builder("lamp");
  builder.place("floor", floorMesh(), builder.diffuse("grey", glm::vec3(0.5f)));
  Light lamp;
  lamp.intensity = glm::vec3(7.0f);
  lamp.range = 5.0f;
  builder.light(lamp, {1.0f, 2.0f, 0.0f});
  const Estimate e = estimate(builder.finish(), kOntoFloor, {}, onePixel(0), 4);
  const double squared = 5.0, range = 1.0 - squared * squared / 625.0;
  EXPECT_NEAR(e.mean, 0.5 / kPi * 7.0 * range / squared * (2.0 / std::sqrt(5.0)), 2e-6);
  EXPECT_LT(e.error, 1e-9);
}

// Forty lamps, one of them taken at a time, half of them behind a wall.
TEST(Lights, ManyLampsAreTheSumOfEach) {
  const auto scene = [](int first, int count) {
    SceneBuilder builder("lamps");
    builder.place("floor", floorMesh(), builder.glossy("grey", glm::vec3(0.5f), 0.6f));
    builder.place("wall", shapes::box({-0.6f, 0.0f, -5.0f}, {-0.5f, 5.0f, 5.0f}, 5.0f),
                  builder.diffuse("black", glm::vec3(0.0f)));
    for (int i = first; i < first + count; ++i) {
      Light lamp;
      lamp.type = i % 3 == 0 ? Light::Type::kSpot : Light::Type::kPoint;
      lamp.intensity = glm::vec3(1.0f + float(i % 7));
      lamp.outer_cone_rad = 1.0f;
      builder.light(lamp, {-2.0f + 0.1f * float(i), 1.0f + 0.03f * float(i), 0.2f}, {0.1f, -1.0f, 0.0f});
    }
    return builder.finish();
  };
  double sum = 0.0;
  for (int i = 0; i < 40; ++i) sum += estimate(scene(i, 1), kOntoFloor, {}, onePixel(0), 1).mean;
  expectTruth(estimate(scene(0, 40), kOntoFloor, {}, onePixel(0), 8192), sum);
}

// Direct rho (1 - a), with all bounces rho (1 - a) / (1 - rho a).
TEST(Bounces, OpenBowl) {
  constexpr double kAlbedo = 0.5, kShare = 0.6;
  SceneBuilder builder("bowl");
  builder.place("bowl", shapes::bowl(1.0f, float(kShare), 160),
                builder.diffuse("inside", glm::vec3(float(kAlbedo))));
  const Scene scene = builder.finish();
  const PosedCamera camera = lookingAt({0.1f, 2.0f, 0.0f}, {0.4f, -0.9f, 0.1f});
  const double direct = kAlbedo * (1.0 - kShare);
  expectTruth(estimate(scene, camera, uniformSky(), onePixel(0), 1024), direct, 3e-4);
  expectTruth(estimate(scene, camera, uniformSky(), onePixel(64), 4096), direct / (1.0 - kAlbedo * kShare),
              3e-4);
  expectTruth(estimate(scene, camera, uniformSky(), onePixel(64), 1024, sumOf({kEnvironmentDirect})), direct,
              3e-4);
}

// From the inside of a closed body that shines with 1 and reflects rho: 1 + rho + rho^2 … wherever one looks.
TEST(Bounces, ClosedEmitter) {
  constexpr double kAlbedo = 0.7;
  SceneBuilder builder("box");
  const int material = builder.diffuse("walls", glm::vec3(float(kAlbedo)));
  builder.material(material).emission = glm::vec3(1.0f);
  builder.place("box", shapes::box({-1.0f, -1.0f, -1.0f}, {1.0f, 1.5f, 1.0f}, 1.0f), material);
  const Scene scene = builder.finish();
  const PosedCamera camera = lookingAt({0.1f, 0.2f, 0.3f}, {0.5f, -1.0f, 0.3f});
  double truth = 0.0;
  for (int bounces = 0; bounces <= 6; ++bounces) {
    truth += std::pow(kAlbedo, bounces + 1);
    expectTruth(estimate(scene, camera, uniformSky(), onePixel(bounces), 2048), truth, 1e-4);
  }
  EXPECT_EQ(estimate(scene, camera, {}, onePixel(0), 1, sumOf({kSeen})).mean, 1.0);
  expectTruth(estimate(scene, camera, {}, onePixel(6), 1024, sumOf({kEmitterDirect})), kAlbedo, 1e-4);
}

// A metal without colour under an even sky. Straight on, the whole lobe shows it, whatever its width; at an angle a lobe of
// exponent 1 loses what lies below the surface: (1 + cos) / 2 remains.
TEST(Lobes, PhongKeepsItsEnergy) {
  const auto metal = [](float roughness) {
    SceneBuilder builder("metal");
    builder.place("floor", floorMesh(), builder.metal("mirror", glm::vec3(1.0f), roughness));
    return builder.finish();
  };
  const PosedCamera straight = lookingAt({0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 0.0f});
  for (const float roughness : {0.02f, 0.3f, 0.6f, 1.0f}) {
    for (const Sampling how : {Sampling::kBoth, Sampling::kLobes}) {
      const Estimate e =
          estimate(metal(roughness), straight, uniformSky(), onePixel(0), 4096, allLight(), how);
      expectTruth(e, 1.0, 1e-4);
    }
  }
  const PosedCamera slanted = lookingAt({std::sqrt(3.0f), 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f});  // 60 degrees
  expectTruth(estimate(metal(1.0f), slanted, uniformSky(), onePixel(0), 8192), 0.75, 1e-4);
}

// Whatever the way of sampling, the same light: an emitter, a sky, two lobes, one bounce.
TEST(Lobes, EveryWayOfSamplingHasTheSameMean) {
  SceneBuilder builder("corner");
  builder.place("floor", floorMesh(4.0f), builder.glossy("glossy", glm::vec3(0.4f), 0.4f));
  builder.place("wall", shapes::box({-1.2f, 0.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, 2.0f),
                builder.diffuse("wall", glm::vec3(0.8f)));
  builder.place("light", discMesh(0.5f, 1.5f, 64), emissive(builder, 5.0f), {0.6f, 0.0f, 0.2f});
  const Scene scene = builder.finish();
  Environment sky = loadEnvironment("sky:overcast");
  std::vector<Estimate> results;
  for (const Sampling how : {Sampling::kBoth, Sampling::kLights, Sampling::kLobes})
    results.push_back(estimate(scene, kOntoFloor, sky, onePixel(1), 8192, allLight(), how));
  EXPECT_LT(results[0].error, 0.002 * results[0].mean);
  for (const std::size_t i : {1u, 2u}) {
    const double both = std::hypot(results[0].error, results[i].error);
    EXPECT_LT(std::abs(results[i].mean - results[0].mean), 4.0 * both) << i;
    EXPECT_LT(both, 0.01 * results[0].mean);
  }
}

// A projection is integrated as it is, negative parts too: rho / pi times the irradiance that SH-5 gives.
TEST(Projection, PlaneUnderAProjectedSun) {
  Environment sky = uniformSky(glm::vec3(0.05f));
  sky.radiance[9] = glm::vec3(30.0f);
  for (const int order : {1, 3, 6}) {
    ReferenceOptions options = onePixel(0);
    options.environment_order = order;
    const double truth =
        0.5 / kPi * double(sh::irradiance(projectEnvironment(sky, order), {0.0f, 1.0f, 0.0f}).g);
    ASSERT_GT(truth, 0.0);
    for (const Sampling how : {Sampling::kBoth, Sampling::kLights, Sampling::kLobes})
      expectTruth(estimate(plane(0.5f), kOntoFloor, sky, options, 8192, allLight(), how), truth, 1e-4);
  }
}

TEST(Integrator, OnlyTheLightThatIsAskedFor) {
  SceneBuilder builder("all");
  builder.place("floor", floorMesh(), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.place("wall", shapes::box({-1.2f, 0.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, 2.0f),
                builder.diffuse("wall", glm::vec3(0.8f)));
  builder.place("disc", discMesh(0.5f, 1.5f, 16), emissive(builder, 3.0f), {0.5f, 0.0f, 0.0f});
  builder.light(Light{}, {-0.5f, 1.8f, 0.8f});
  const Scene scene = builder.finish();
  const PosedScene posed = pose(scene, 0.0f);
  for (int kept = 0; kept < 6; ++kept) {
    Coverage light;
    bool* const members[] = {&light.environment_direct, &light.environment_indirect, &light.local_direct,
                             &light.local_indirect,     &light.emitter_direct,       &light.emitter_indirect};
    *members[kept] = true;
    const Integrator one(scene, posed, kOntoFloor, uniformSky(), onePixel(1, light), {});
    const CameraPoint point = one.look(0, 0);
    PathLight sum{};
    std::size_t rays = 0;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const PathLight sample = one.trace(point, 0, 0, 0, i, rays);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += sample[k];
    }
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(one.has(LightPath(k)), k == kept);
      EXPECT_EQ(sum[std::size_t(k)].g > 0.0f, k == kept);
    }
    const bool direct = kept % 2 == 0, lamp = kept / 2 == 1;
    EXPECT_LE(rays, 64u * (direct ? (lamp ? 1u : 2u) : (lamp ? 2u : 3u)));
  }
  const Integrator direct(scene, posed, kOntoFloor, {}, onePixel(0, {.local_indirect = true}), {});
  EXPECT_FALSE(direct.has(kLocalIndirect));  // no bounces, no indirect light
  EXPECT_TRUE(direct.has(kSeen));
}

TEST(Integrator, SameBitsOnAnyThread) {
  const Scene scene = loadScene("builtin:cornell?detail=0.25");
  const PosedScene posed = pose(scene, 0.0f);
  ReferenceOptions options;
  options.width = options.height = 16;
  const Environment sky = scene.environment;
  const Integrator one(scene, posed, posed.cameras[0], sky, options, {});
  const Integrator other(scene, posed, posed.cameras[0], sky, options, {});
  const auto traced = [](const Integrator& integrator, int i) {
    std::size_t rays = 0;
    const CameraPoint point = integrator.look(i % 16, i / 16);
    PathLight sum{};
    for (std::uint32_t s = 0; s < 16; ++s) {
      const PathLight light = integrator.trace(point, i % 16, i / 16, std::uint32_t(i), s, rays);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += light[k];
    }
    return sum;
  };
  std::vector<PathLight> in_turn, at_once(256);
  for (int i = 0; i < 256; ++i) in_turn.push_back(traced(one, i));
  tbb::parallel_for(0, 256, [&](int i) { at_once[std::size_t(255 - i)] = traced(other, 255 - i); });
  EXPECT_EQ(in_turn, at_once);
}

// However samples are bundled: alone, by sixteen, by seven, more at once than walk side by side.
TEST(Integrator, SameBitsInAnyCompany) {
  const Scene scene = loadScene("builtin:textured?detail=0.25");
  const PosedScene posed = pose(scene, 0.0f);
  ReferenceOptions options;
  options.width = options.height = 24;
  options.bounces = 6;
  const Integrator integrator(scene, posed, posed.cameras[0], scene.environment, options, {});
  for (int i = 0; i < 24 * 24; i += 7) {
    const int x = i % 24, y = i / 24;
    const CameraPoint point = integrator.look(x, y);
    std::vector<PathLight> alone(40), by_seven(40), at_once(40);
    std::size_t rays_alone = 0, rays_at_once = 0;
    for (std::uint32_t s = 0; s < 40; ++s)
      alone[s] = integrator.trace(point, x, y, std::uint32_t(i), s, rays_alone);
    for (std::uint32_t s = 0; s < 40; s += 7) {
      std::size_t rays = 0;
      integrator.trace(point, x, y, std::uint32_t(i), s,
                       std::span(by_seven).subspan(s, std::min<std::size_t>(7, 40 - s)), rays);
    }
    integrator.trace(point, x, y, std::uint32_t(i), 0, at_once, rays_at_once);
    EXPECT_EQ(alone, at_once);
    EXPECT_EQ(alone, by_seven);
    EXPECT_EQ(rays_alone, rays_at_once);
  }
}

}  // namespace
}  // namespace gloam::reference
