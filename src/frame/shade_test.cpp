// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From a technique's terms to colour: receivers, upsampling, sums, gloss, background, averages.
#include "frame/shade.h"

#include "frame/test_frame.h"
#include "math/brdf.h"
#include "scene/environment.h"

namespace gloam::frame {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

/// Two spheres before a wall.
Scene spheresScene(const char* sky = nullptr) {
  SceneBuilder builder("spheres");
  const int white = builder.diffuse("white", glm::vec3(1.0f));
  builder.place("wall", shapes::patch({-4, 4, -2}, {8, 0, 0}, {0, -8, 0}, {0, 1}, {0, 1}), white);
  builder.place("left", shapes::icosphere(0.8f, 8), white, {-0.9f, 0, 0});
  builder.place("right", shapes::icosphere(0.8f, 8), white, {0.9f, 0.3f, -0.5f});
  if (sky) builder.sky(sky);
  return builder.finish();
}

/// A technique that hands on what `value` says of each receiver (position, normal, depth).
using Valued = std::function<glm::vec3(const glm::vec3& position, const glm::vec3& normal)>;
LightingStep handingOn(int divisor, const Valued& value, Path path = Path::kDirect, int terms = 1) {
  return [=](gpu::FrameGraph& graph, const FrameInputs& inputs) {
    const ReceiverLevel level = inputs.receivers.at(divisor);
    Lighting lighting;
    for (int t = 0; t < terms; ++t) {
      const auto image = graph.create(
          "test.irradiance" + std::to_string(t),
          gpu::ImageDesc{
              .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = level.width, .height = level.height});
      graph.host("test.irradiance")
          .read(level.position)
          .read(level.normal_depth)
          .write(image)
          .run([=](gpu::HostAccess& host) {
            const std::vector<float> positions = host.downloadFloats(level.position);
            const std::vector<float> normals = host.downloadFloats(level.normal_depth);
            std::vector<float> out(positions.size(), 0.0f);
            for (std::size_t i = 0; i < positions.size(); i += 4) {
              if (positions[i + 3] == 0.0f) continue;
              const glm::vec3 v = value({positions[i], positions[i + 1], positions[i + 2]},
                                        {normals[i], normals[i + 1], normals[i + 2]});
              std::copy(&v.x, &v.x + 3, &out[i]);
            }
            host.uploadFloats(image, std::span<const float>(out));
          });
      lighting.irradiance.push_back({.image = image, .path = path, .divisor = divisor});
    }
    return lighting;
  };
}

const PosedCamera kCamera = cameraAt({0, 0, 6}, {0, 0, 0}, 30);

TEST(Receivers, StandOnTheSurfaceAtEverySize) {
  const Scene scene = spheresScene();
  for (const int divisor : {1, 2, 4, 8}) {
    TestFrame frame(scene);
    int checked = 0;
    frame.draw(pose(scene, 0.0f), kCamera, {.width = 60, .height = 44},
               handingOn(divisor, [&](const glm::vec3& p, const glm::vec3& n) {
                 const float wall = std::abs(p.z + 2);
                 const float left = std::abs(glm::length(p - glm::vec3(-0.9f, 0, 0)) - 0.8f);
                 const float right = std::abs(glm::length(p - glm::vec3(0.9f, 0.3f, -0.5f)) - 0.8f);
                 EXPECT_LT(std::min({wall, left, right}), 1e-2f);
                 EXPECT_NEAR(glm::length(n), 1.0f, 1e-4f);
                 ++checked;
                 return glm::vec3(0.0f);
               }));
    EXPECT_EQ(checked, ((60 + divisor - 1) / divisor) * ((44 + divisor - 1) / divisor))
        << "the wall fills the view";
  }
}

TEST(Receivers, KnowTheirSizes) {
  const Scene scene = spheresScene();
  TestFrame frame(scene);
  EXPECT_NE(gpu::errorOf([&] {
              frame.draw(pose(scene, 0.0f), kCamera, {.width = 16, .height = 16},
                         handingOn(3, [](auto, auto) { return glm::vec3(0.0f); }));
            }).find("1/3"),
            std::string::npos);
}

// A constant stays one; what is linear over a plane stays linear; no light crosses from one object to
// another.
TEST(Upsample, FollowsSurfaces) {
  const Scene scene = spheresScene();
  for (const int divisor : {2, 4, 8}) {
    TestFrame frame(scene);
    FrameImages images =
        frame.draw(pose(scene, 0.0f), kCamera, {.width = kSize, .height = kSize},
                   handingOn(divisor, [](auto, auto) { return glm::vec3(kPi, 2 * kPi, 0.5f * kPi); }));
    const std::vector<float> constant = images.direct.image().downloadFloats();
    for (int i = 0; i < kSize * kSize; ++i) {
      ASSERT_NEAR(constant[std::size_t(i) * 4], 1.0f, 2e-3f);
      ASSERT_NEAR(constant[std::size_t(i) * 4 + 1], 2.0f, 4e-3f);
    }
    images = frame.draw(pose(scene, 0.0f), kCamera, {.width = kSize, .height = kSize},
                        handingOn(divisor, [](const glm::vec3& p, auto) {
                          return p.z < -1.9f ? glm::vec3(kPi * (2 + 0.2f * p.x), 0, 0) : glm::vec3(0, kPi, 0);
                        }));
    const std::vector<float> colored = images.direct.image().downloadFloats();
    const std::vector<glm::uvec2> ids = frame.ids();
    const FrameView view = makeView(kCamera, kSize, kSize, glm::vec3(-4), glm::vec3(4));
    int bled = 0;
    for (int y = 4; y < kSize - 8; ++y) {
      for (int x = 4; x < kSize - 8; ++x) {
        const glm::vec3 color = pixelOf(colored, kSize, x, y);
        const bool wall = ids[std::size_t(y) * kSize + std::size_t(x)].x == 1u;
        const glm::vec3 ray = view.corner + (float(x) + 0.5f) * view.step_x + (float(y) + 0.5f) * view.step_y;
        const float exact = 2 + 0.2f * (view.eye + 8.0f * ray).x;
        // Beside a sphere only some of the four samples are the wall's: off by what changes within a block.
        const float tolerance = 0.01f + 0.2f * float(divisor) * glm::length(8.0f * view.step_x);
        bled += wall ? std::abs(color.x - exact) > tolerance || color.y > 0.02f : color.x > 0.05f;
      }
    }
    EXPECT_LT(bled, 20) << "1/" << divisor;
  }
}

TEST(Shade, TermsAddAndPathsStayApart) {
  const Scene scene = spheresScene();
  TestFrame frame(scene);
  const Valued one = [](auto, auto) { return glm::vec3(kPi); };
  for (const auto path : {Path::kDirect, Path::kIndirect}) {
    const FrameImages images =
        frame.draw(pose(scene, 0.0f), kCamera, {.width = kSize, .height = kSize}, handingOn(1, one, path, 3));
    const float direct = images.direct.image().downloadFloats()[4 * 700],
                color = images.color.image().downloadFloats()[4 * 700];
    const float indirect = images.indirect.image().downloadFloats()[4 * 700];
    EXPECT_NEAR(direct, path == Path::kDirect ? 3.0f : 0.0f, 3e-3f);
    EXPECT_NEAR(indirect, path == Path::kIndirect ? 3.0f : 0.0f, 3e-3f);
    EXPECT_NEAR(color, 3.0f, 3e-3f);
  }
}

// Metals show the environment: the Phong lobe over order-6 SH, as math/brdf.h computes it.
TEST(Shade, MetalsAreNotBlack) {
  SceneBuilder builder("metal");
  builder.place("sphere", shapes::icosphere(1.0f, 16), builder.metal("gold", {1.0f, 0.8f, 0.3f}, 0.75f));
  builder.sky("gradient");
  const Scene scene = builder.finish();
  TestFrame frame(scene);
  const FrameImages images =
      frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 5}, {0, 0, 0}, 30), {.width = kSize, .height = kSize});
  const std::vector<float> color = images.color.image().downloadFloats(),
                           normals = images.normal.image().downloadFloats();
  const sh::ShRgb light = projectEnvironment(scene.environment, 6);
  const FrameView view =
      makeView(cameraAt({0, 0, 5}, {0, 0, 0}, 30), kSize, kSize, glm::vec3(-1), glm::vec3(1));
  const brdf::Lobes lobes = brdf::makeLobes({1.0f, 0.8f, 0.3f}, 1.0f, 0.75f);
  for (const int x : {24, 32, 40}) {
    for (const int y : {22, 32, 43}) {
      const glm::vec3 to_eye =
          -glm::normalize(view.corner + (float(x) + 0.5f) * view.step_x + (float(y) + 0.5f) * view.step_y);
      const glm::vec3 want = brdf::shade(lobes, light, glm::normalize(pixelOf(normals, kSize, x, y)), to_eye);
      const glm::vec3 got = pixelOf(color, kSize, x, y);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.01f * want[c] + 1e-3f);
      EXPECT_GT(got.x, 0.05f);
    }
  }
}

TEST(Shade, BackgroundIsTheEnvironment) {
  Scene scene = spheresScene();
  scene.nodes.clear();
  scene.roots.clear();
  scene.environment = loadEnvironment("sky:preetham?elevation=30");
  scene.environment.rotation_rad = 0.7f;
  scene.environment.intensity = 1.5f;
  TestFrame frame(scene);
  const PosedCamera camera = cameraAt({0, 0, 0}, {1, 0.3f, 0.4f}, 60);
  const FrameView view = makeView(camera, kSize, kSize, glm::vec3(0), glm::vec3(0));
  const std::vector<float> color =
      frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize}).color.image().downloadFloats();
  for (int y = 1; y < kSize; y += 9) {
    for (int x = 1; x < kSize; x += 9) {
      const glm::vec3 ray = view.corner + (float(x) + 0.5f) * view.step_x + (float(y) + 0.5f) * view.step_y;
      const glm::vec3 want = radianceFrom(scene.environment, ray), got = pixelOf(color, kSize, x, y);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.04f * want[c] + 2e-3f) << x << ' ' << y;
    }
  }
  const std::vector<float> clear =
      frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize, .background = false})
          .color.image()
          .downloadFloats();
  EXPECT_EQ(*std::max_element(clear.begin(), clear.end()), 0.0f);
}

// Discs are drawn, maps looked up, the rest painted: all of it turned and scaled as painted texels would be.
TEST(Shade, DescribedLightsLookAsPaintedOnes) {
  Scene scene = spheresScene();
  scene.nodes.clear();
  scene.roots.clear();
  TestFrame frame(scene);
  const PosedCamera camera = cameraAt({0, 0, 0}, {1, 0.3f, 0.4f}, 80);
  Environment base = loadEnvironment("sky:mild");
  base.rotation_rad = 0.4f;
  const auto drawn = [&](const Environment& environment) {
    frame.environment.set(environment);
    return frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize})
        .color.image()
        .downloadFloats();
  };
  std::vector<DistantLight> lights(1);
  lights[0].direction = glm::normalize(glm::vec3(0.8f, 0.5f, 0.1f));
  lights[0].radius_rad = 0.2f;
  lights[0].radiance = {8.0f, 6.0f, 4.0f};
  for (int step = 0; step < 3; ++step) {  // a map and a disc; the same map turned; more than a map
    std::vector<DistantLight> described = lights;
    described.push_back(mapLight(base));
    if (step == 1) described.back().rotation_rad = 0.9f;
    if (step == 2) described.push_back({.kind = DistantLight::Kind::kConstant, .radiance = glm::vec3(0.3f)});
    Environment painted = paintLights({}, described), unpainted = describeLights(described);
    painted.rotation_rad = unpainted.rotation_rad = 0.3f * float(step);
    painted.intensity = unpainted.intensity = 0.7f;
    const std::vector<float> want = drawn(painted), got = drawn(unpainted);
    int apart = 0;
    float brightest = 0.0f;
    for (std::size_t i = 0; i < want.size(); ++i) {
      brightest = std::max(brightest, got[i]);
      if (std::abs(got[i] - want[i]) > 0.03f * want[i] + 1e-3f) ++apart;
    }
    EXPECT_LT(apart, 4 * kSize * kSize / 30) << step;  // the disc's rim alone, a texel wide
    EXPECT_GT(brightest, 5.0f);
  }
}

TEST(Shade, EmissionIsSeenAsItIs) {
  SceneBuilder builder("lamp");
  const int glowing = builder.diffuse("glowing", glm::vec3(0.0f));
  builder.material(glowing).emission = {2, 3, 400};
  builder.place("sphere", shapes::icosphere(1.0f, 6), glowing);
  const Scene scene = builder.finish();
  TestFrame frame(scene);
  const FrameImages images =
      frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 5}, {0, 0, 0}, 30), {.width = kSize, .height = kSize});
  EXPECT_EQ(pixelOf(images.direct.image().downloadFloats(), kSize, 32, 32), glm::vec3(2, 3, 400));
}

// Averages of 2 x 2 or 3 x 3 samples are those of the picture drawn at that size.
TEST(Resolve, AveragesSamplesInLinearRadiance) {
  const Scene scene = spheresScene("gradient");
  const Valued shaded = [](auto, const glm::vec3& n) { return glm::vec3(kPi * (n.y + 1)); };
  for (const int side : {2, 3}) {
    TestFrame frame(scene), large(scene);
    const std::vector<float> small =
        frame
            .draw(pose(scene, 0.0f), kCamera, {.width = 32, .height = 32, .supersample = side},
                  handingOn(1, shaded))
            .color.image()
            .downloadFloats();
    const std::vector<float> samples =
        large
            .draw(pose(scene, 0.0f), kCamera, {.width = 32 * side, .height = 32 * side}, handingOn(1, shaded))
            .color.image()
            .downloadFloats();
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        glm::vec3 mean(0.0f);
        for (int i = 0; i < side * side; ++i)
          mean += pixelOf(samples, 32 * side, x * side + i % side, y * side + i / side) / float(side * side);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pixelOf(small, 32, x, y)[c], mean[c], 2e-3f * mean[c] + 1e-4f);
      }
    }
  }
}

}  // namespace
}  // namespace gloam::frame
