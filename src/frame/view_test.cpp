// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/view.h"

#include "frame/lights.h"
#include "frame/test_frame.h"

namespace gloam::frame {
namespace {

const glm::vec3 kLow(-2.0f), kHigh(2.0f);

PosedCamera orthographic(const glm::vec3& eye, const glm::vec3& target, float half_height) {
  PosedCamera camera = cameraAt(eye, target);
  camera.camera.perspective = false;
  camera.camera.half_height = half_height;
  return camera;
}

/// Pixel and depth at which the matrix puts a point.
glm::vec3 projected(const FrameView& view, const glm::vec3& point) {
  const glm::vec4 clip = view.clip_from_world * glm::vec4(point, 1.0f);
  return {(clip.x / clip.w * 0.5f + 0.5f) * float(view.width),
          (clip.y / clip.w * 0.5f + 0.5f) * float(view.height), clip.z / clip.w};
}

/// The point that frame/view.glsl finds from pixel and depth.
glm::vec3 unprojected(const FrameView& view, const glm::vec3& pixel) {
  const glm::vec3 offset = view.corner + pixel.x * view.step_x + pixel.y * view.step_y;
  if (view.depth_range > 0.0f)
    return view.eye + offset + view.forward * (view.z_near + (1.0f - pixel.z) * view.depth_range);
  return view.eye + offset * (view.z_near / pixel.z);
}

TEST(View, MatrixAndRaysAgree) {
  for (const PosedCamera& camera :
       {cameraAt({3, 2, 5}, {0, 0.5f, 0}), orthographic({3, 2, 5}, {0, 0.5f, 0}, 2.5f)}) {
    const FrameView view = makeView(camera, 160, 90, kLow, kHigh);
    for (const glm::vec3& point : {glm::vec3(0, 0, 0), glm::vec3(1, -0.5f, 0.7f), glm::vec3(-1.5f, 1, -2)}) {
      const glm::vec3 pixel = projected(view, point);
      EXPECT_GT(pixel.z, 0.0f);
      EXPECT_LT(pixel.z, 1.0f);
      EXPECT_LT(glm::length(unprojected(view, pixel) - point), 1e-4f);
    }
  }
}

TEST(View, UpIsUpAndRightIsRight) {
  const FrameView view = makeView(cameraAt({0, 0, 5}, {0, 0, 0}), 100, 100, kLow, kHigh);
  EXPECT_LT(projected(view, {0, 1, 0}).y, 50.0f);
  EXPECT_GT(projected(view, {1, 0, 0}).x, 50.0f);
  EXPECT_GT(projected(view, {0, 0, 1}).z, projected(view, {0, 0, -1}).z) << "depth is reversed";
}

TEST(View, ScaleOfTheCamerasNodeDoesNotCount) {
  PosedCamera camera = cameraAt({3, 2, 5}, {0, 0, 0});
  const FrameView plain = makeView(camera, 64, 64, kLow, kHigh);
  camera.world_from_view = camera.world_from_view * glm::scale(glm::mat4(1.0f), glm::vec3(3.0f, 0.5f, 2.0f));
  const FrameView scaled = makeView(camera, 64, 64, kLow, kHigh);
  EXPECT_LT(glm::length(projected(plain, {1, 1, 0}) - projected(scaled, {1, 1, 0})), 1e-3f);
}

TEST(View, RefusesCamerasThatSeeNothing) {
  const auto message = [](auto change) {
    PosedCamera camera = cameraAt({0, 0, 5}, {0, 0, 0});
    camera.camera.name = "eye";
    change(camera);
    return gpu::errorOf([&] { makeView(camera, 64, 64, kLow, kHigh); });
  };
  EXPECT_NE(message([](PosedCamera& c) { c.camera.vertical_fov_rad = 0.0f; }).find("field of view"),
            std::string::npos);
  EXPECT_NE(message([](PosedCamera& c) { c.camera.vertical_fov_rad = 3.2f; }).find("camera 'eye'"),
            std::string::npos);
  EXPECT_NE(message([](PosedCamera& c) { c.camera.z_near = 0.0f; }).find("z_near"), std::string::npos);
  EXPECT_NE(message([](PosedCamera& c) { c.world_from_view = glm::mat4(0.0f); }).find("orientation"),
            std::string::npos);
  EXPECT_NE(message([](PosedCamera& c) {
              c.camera.perspective = false;
              c.camera.half_height = -1.0f;
            }).find("height"),
            std::string::npos);
}

PosedLight lamp(Light::Type type, const glm::vec3& position, const glm::vec3& direction) {
  PosedLight posed;
  posed.light.type = type;
  posed.position = position;
  posed.direction = glm::normalize(direction);
  return posed;
}

LightPlan planOf(const std::vector<PosedLight>& lights, const FrameView& view, Warnings& warnings,
                 int size = 256, std::size_t budget = std::size_t(1) << 30, int layers = 256) {
  return planLights(lights, view, kLow, kHigh, size, budget, layers, warnings);
}

TEST(Lights, DirectionalMapShowsAllThatIsSeen) {
  const FrameView view = makeView(cameraAt({0, 1, 6}, {0, 0, 0}, 60), 64, 64, kLow, kHigh);
  Warnings warnings;
  const LightPlan plan = planOf({lamp(Light::Type::kDirectional, {}, {-1, -2, 0.5f})}, view, warnings);
  ASSERT_EQ(plan.shadow_views.size(), 1u);
  for (int corner = 0; corner < 8; ++corner) {  // all of the box is in view here
    const glm::vec3 p(corner & 1 ? 2 : -2, corner & 2 ? 2 : -2, corner & 4 ? 2 : -2);
    const glm::vec4 clip = plan.shadow_views[0].clip_from_world * glm::vec4(p, 1.0f);
    EXPECT_LE(std::max(std::abs(clip.x), std::abs(clip.y)), 1.0f);
    EXPECT_GE(clip.z, 0.0f);
    EXPECT_LE(clip.z, 1.0f);
  }
}

TEST(Lights, DirectionalMapMovesByWholeTexels) {
  Warnings warnings;
  const std::vector<PosedLight> sun = {lamp(Light::Type::kDirectional, {}, {-1, -2, 0.5f})};
  const auto planFrom = [&](float x) {
    return planOf(sun, makeView(cameraAt({x, 0.3f, 1.6f}, {x, 0, 0}, 30), 64, 64, kLow, kHigh), warnings)
        .shadow_views[0];
  };
  const ShadowView a = planFrom(0.0f);
  for (int step = 1; step <= 20; ++step) {
    const ShadowView b = planFrom(0.003f * float(step));
    if (b.half_width != a.half_width) continue;  // the size changes rarely, and then by a quarter octave
    const float texels = glm::dot(b.origin - a.origin, a.right) / (2.0f * a.half_width / 256.0f);
    EXPECT_NEAR(texels, std::round(texels), 1e-2f);
  }
}

TEST(Lights, EachLampHasTheMapsThatItNeeds) {
  const FrameView view = makeView(cameraAt({0, 1, 6}, {0, 0, 0}), 64, 64, kLow, kHigh);
  std::vector<PosedLight> lamps = {
      lamp(Light::Type::kSpot, {0, 1, 0}, {0, -1, 0}), lamp(Light::Type::kPoint, {0, 1, 0}, {0, -1, 0}),
      lamp(Light::Type::kSpot, {0, 1, 0}, {0, -1, 0}), lamp(Light::Type::kPoint, {0, 1, 0}, {0, -1, 0})};
  lamps[2].light.outer_cone_rad = 1.5f;
  lamps[3].light.intensity = glm::vec3(0.0f);  // does not shine: not a lamp
  Warnings warnings;
  const LightPlan plan = planOf(lamps, view, warnings);
  ASSERT_EQ(plan.lights.size(), 3u);
  EXPECT_EQ(plan.lights[0].map_count, 1u);
  EXPECT_EQ(plan.lights[1].map_count, 6u);
  EXPECT_EQ(plan.lights[2].map_count, 6u);
  EXPECT_EQ(plan.shadow_views.size(), 13u);
  EXPECT_TRUE(warnings.empty());

  const LightPlan small = planOf(lamps, view, warnings, 256, 13 * 128 * 128 * 4);
  EXPECT_EQ(small.map_size, 128);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("128 instead of 256"), std::string::npos);
  const LightPlan few = planOf(lamps, view, warnings, 256, std::size_t(1) << 30, 7);
  EXPECT_EQ(few.lights[2].map_count, 0u);
  EXPECT_NE(warnings.back().find("cast no shadow"), std::string::npos);
}

TEST(Lights, RefusesNumbersThatAreNone) {
  const FrameView view = makeView(cameraAt({0, 1, 6}, {0, 0, 0}), 64, 64, kLow, kHigh);
  PosedLight posed = lamp(Light::Type::kPoint, {0, NAN, 0}, {0, -1, 0});
  posed.light.name = "bulb";
  Warnings warnings;
  EXPECT_NE(gpu::errorOf([&] { planOf({posed}, view, warnings); }).find("light 'bulb'"), std::string::npos);
}

}  // namespace
}  // namespace gloam::frame
