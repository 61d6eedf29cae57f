// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lamps and their shadows against formulas that a person can check.
#include <numeric>

#include "frame/test_frame.h"
#include "math/brdf.h"
#include "math/punctual.h"

namespace gloam::frame {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

/// Looks down on the ground; pixel (x, y) shows the point ((x + 1/2) / 64 - 1/2) * width, and z alike.
PosedCamera fromAbove(float width) {
  PosedCamera camera;
  camera.camera.perspective = false;
  camera.camera.half_height = 0.5f * width;
  camera.world_from_view = glm::inverse(glm::lookAt(glm::vec3(0, 10, 0), glm::vec3(0), glm::vec3(0, 0, -1)));
  return camera;
}
glm::vec3 groundPoint(int x, int y, float width) {
  return {((float(x) + 0.5f) / kSize - 0.5f) * width, 0.0f, ((float(y) + 0.5f) / kSize - 0.5f) * width};
}

Light lampOf(Light::Type type, const glm::vec3& intensity) {
  Light light;
  light.type = type;
  light.intensity = intensity;
  return light;
}

std::vector<float> lampImage(const Scene& scene, const PosedCamera& camera, int shadow_map_size = 512) {
  TestFrame frame(scene);
  frame.draw(pose(scene, 0.0f), camera,
             {.width = kSize, .height = kSize, .shadow_map_size = shadow_map_size});
  return frame.floats("frame.local_light");
}

TEST(LocalLight, PlaneUnderAPointLight) {
  SceneBuilder builder("plane");
  builder.place("ground", shapes::ground(8, 8, 4, 4), builder.diffuse("grey", glm::vec3(0.5f)));
  Light light = lampOf(Light::Type::kPoint, {10, 20, 30});
  light.range = 3.0f;
  builder.light(light, {0.3f, 1.5f, -0.2f});
  const std::vector<float> image = lampImage(builder.finish(), fromAbove(4));
  for (int y = 0; y < kSize; y += 5) {
    for (int x = 0; x < kSize; x += 5) {
      const glm::vec3 to_lamp = glm::vec3(0.3f, 1.5f, -0.2f) - groundPoint(x, y, 4);
      const float d = glm::length(to_lamp);
      const glm::vec3 want =
          0.5f / kPi * glm::vec3(10, 20, 30) * punctual::rangeFactor(d, 3.0f) / (d * d) * (1.5f / d);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixelOf(image, kSize, x, y)[c], want[c], 2e-3f * want[c] + 1e-5f);
    }
  }
}

TEST(LocalLight, SpotHasItsConeAndTheLobesTheirGloss) {
  SceneBuilder builder("spot");
  builder.place("ground", shapes::ground(8, 8, 4, 4),
                builder.glossy("glossy", glm::vec3(0.5f, 0.2f, 0.1f), 0.5f));
  Light light = lampOf(Light::Type::kSpot, glm::vec3(40.0f));
  light.inner_cone_rad = 0.3f;
  light.outer_cone_rad = 0.6f;
  const glm::vec3 position(-1, 2, 0), axis = glm::normalize(glm::vec3(0.5f, -1, 0.1f));
  builder.light(light, position, axis);
  const std::vector<float> image = lampImage(builder.finish(), fromAbove(4));
  const brdf::Lobes lobes = brdf::makeLobes({0.5f, 0.2f, 0.1f}, 0.0f, 0.5f);
  float brightest = 0.0f;
  for (int y = 0; y < kSize; y += 3) {
    for (int x = 0; x < kSize; x += 3) {
      const glm::vec3 to_lamp = position - groundPoint(x, y, 4);
      const float d = glm::length(to_lamp);
      const float cone = punctual::coneFactor(-glm::dot(to_lamp / d, axis), std::cos(0.3f), std::cos(0.6f));
      const glm::vec3 want =
          40.0f * cone / (d * d) * brdf::evaluateLobes(lobes, {0, 1, 0}, {0, 1, 0}, to_lamp / d);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixelOf(image, kSize, x, y)[c], want[c], 4e-3f * want[c] + 2e-3f);
      brightest = std::max(brightest, want.x);
    }
  }
  EXPECT_GT(brightest, 0.5f);
}

/// A box of 1 m on the ground, lit so that its shadow reaches from x = 0.5 to x = 1.5.
Scene boxScene(Light::Type type) {
  SceneBuilder builder("box");
  const int white = builder.diffuse("white", glm::vec3(1.0f));
  builder.place("ground", shapes::ground(8, 8, 4, 4), white);
  builder.place("box", shapes::box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, 0.5f), white);
  Light light = lampOf(type, glm::vec3(type == Light::Type::kDirectional ? 3.0f : 100.0f));
  light.outer_cone_rad = 1.0f;
  light.inner_cone_rad = 0.9f;
  if (type == Light::Type::kDirectional) builder.light(light, {}, {1, -1, 0});
  // Through the upper edge at (0.5, 1) to (1.5, 0) as well.
  if (type != Light::Type::kDirectional) builder.light(light, {-2.5f, 4, 0}, {1, -1.2f, 0});
  return builder.finish();
}

TEST(LocalLight, ShadowOfABoxEndsAtTheRightPixel) {
  for (const Light::Type type : {Light::Type::kDirectional, Light::Type::kPoint, Light::Type::kSpot}) {
    const std::vector<float> image = lampImage(boxScene(type), fromAbove(4), 1024);
    const auto shadowAt = [&](float x) {  // along the middle row
      return pixelOf(image, kSize, int((x / 4 + 0.5f) * kSize), kSize / 2).x;
    };
    const float lit = shadowAt(1.75f);
    EXPECT_GT(lit, 0.1f) << int(type);
    for (const float x : {0.56f, 0.7f, 0.9f, 1.1f, 1.3f, 1.4f})
      EXPECT_LT(shadowAt(x), 0.02f * lit) << int(type) << ' ' << x;
    for (const float x : {1.57f, 1.65f}) EXPECT_GT(shadowAt(x), 0.85f * lit) << int(type) << ' ' << x;
    EXPECT_LT(shadowAt(0.0f), 100.0f);  // the lid is lit
    EXPECT_GT(shadowAt(0.0f), 0.1f);
  }
}

// A convex body never shadows itself: where its normals face the lamp, all light arrives, however coarse the
// map.
TEST(LocalLight, NoAcneOnASphere) {
  for (const Light::Type type : {Light::Type::kDirectional, Light::Type::kPoint}) {
    SceneBuilder builder("sphere");
    builder.place("sphere", shapes::icosphere(1.0f, 16), builder.diffuse("white", glm::vec3(1.0f)));
    const glm::vec3 position(3, 4, 5);
    builder.light(lampOf(type, glm::vec3(5.0f)), position, -position);
    const Scene scene = builder.finish();
    for (const int size : {128, 1024}) {
      const PosedCamera camera = cameraAt({0, 0, 5}, {0, 0, 0}, 30);
      TestFrame frame(scene);
      frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize, .shadow_map_size = size});
      const std::vector<float> lit = frame.floats("frame.local_light");
      const std::vector<float> normals = frame.floats("frame.normal");
      int tested = 0;
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          const glm::vec3 n = pixelOf(normals, kSize, x, y);
          const glm::vec3 to_lamp = type == Light::Type::kDirectional ? position : position - n;
          const float cosine = glm::dot(n, glm::normalize(to_lamp));
          if (cosine < 0.15f) continue;  // closer to the terminator, flat triangles rightly turn away
          const float falloff = type == Light::Type::kDirectional ? 1.0f : 1.0f / glm::dot(to_lamp, to_lamp);
          EXPECT_NEAR(pixelOf(lit, kSize, x, y).x, 5.0f / kPi * cosine * falloff,
                      0.02f * 5.0f / kPi * falloff);
          ++tested;
        }
      }
      EXPECT_GT(tested, 500);
    }
  }
}

TEST(LocalLight, NothingLeaksOutOfAClosedBox) {
  SceneBuilder builder("closed");
  const int white = builder.diffuse("white", glm::vec3(1.0f));
  builder.place("ground", shapes::ground(8, 8, 4, 4), white, {0, -0.01f, 0});
  builder.place("box", shapes::box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, 0.5f), white);
  builder.light(lampOf(Light::Type::kPoint, glm::vec3(100.0f)), {0.1f, 0.5f, 0.2f});
  const std::vector<float> image = lampImage(builder.finish(), fromAbove(4));
  EXPECT_EQ(*std::max_element(image.begin(), image.end()), 0.0f);
}

// What is near to a lamp throws its shadow however far the scene reaches.
TEST(LocalLight, ThingsBesideALampShadeInScenesOfAnySize) {
  for (const float reach : {10.0f, 1e4f, 1e6f}) {
    SceneBuilder builder("wide");
    const int white = builder.diffuse("white", glm::vec3(1.0f));
    builder.place("ground", shapes::ground(8, 8, 4, 4), white);
    builder.place("plate", shapes::box({-0.05f, 0.93f, -0.05f}, {0.05f, 0.95f, 0.05f}, 0.05f), white);
    builder.place("afar", shapes::box({reach, 0, reach}, {reach + 2, 2, reach + 2}, 1.0f), white);
    builder.light(lampOf(Light::Type::kPoint, glm::vec3(10.0f)), {0, 1, 0});
    const std::vector<float> image = lampImage(builder.finish(), fromAbove(4));
    EXPECT_EQ(pixelOf(image, kSize, kSize / 2 + 6, kSize / 2).x, 0.0f) << reach;
    EXPECT_GT(pixelOf(image, kSize, kSize / 2 + 24, kSize / 2).x, 0.0f) << reach;
  }
}

TEST(LocalLight, HolesOfAMaskLetLightThrough) {
  SceneBuilder builder("mask");
  const int mask = builder.diffuse("mask", glm::vec3(1.0f));
  Texture texture{.name = "holes", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}};
  builder.material(mask).base_color_map.texture = builder.texture(texture);
  builder.material(mask).base_color_map.nearest = true;
  builder.material(mask).alpha_mask = true;
  builder.place("ground", shapes::ground(8, 8, 4, 4), builder.diffuse("white", glm::vec3(1.0f)));
  builder.place("screen", shapes::patch({-1, 20, -1}, {2, 0, 0}, {0, 0, 2}, {0, 1}, {0, 1}), mask);
  builder.light(lampOf(Light::Type::kDirectional, glm::vec3(kPi)), {}, {0, -1, 0});
  const std::vector<float> image = lampImage(builder.finish(), fromAbove(4));
  EXPECT_NEAR(pixelOf(image, kSize, 24, 32).x, 0.0f, 1e-4f);  // behind the opaque half
  EXPECT_NEAR(pixelOf(image, kSize, 40, 32).x, 1.0f, 2e-3f);
  EXPECT_NEAR(pixelOf(image, kSize, 5, 32).x, 1.0f, 2e-3f);
}

}  // namespace
}  // namespace gloam::frame
