// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the rasteriser writes, against rays cast by hand.
#include "frame/gbuffer.h"

#include "frame/test_frame.h"

namespace gloam::frame {
namespace {

constexpr int kSize = 64;
constexpr FrameOptions kOptions{.width = kSize, .height = kSize};

/// glsl: unpackNormal.
glm::vec3 unpackNormal(std::uint32_t word) {
  const auto part = [](std::uint32_t bits) {
    return std::clamp(float(static_cast<std::int16_t>(bits)) / 32767.0f, -1.0f, 1.0f);
  };
  const glm::vec2 p(part(word & 0xffffu), part(word >> 16));
  const float z = 1.0f - std::abs(p.x) - std::abs(p.y);
  const glm::vec2 folded = (1.0f - glm::vec2(std::abs(p.y), std::abs(p.x))) *
                           glm::vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
  return glm::normalize(z >= 0.0f ? glm::vec3(p, z) : glm::vec3(folded, z));
}

struct Normals {
  glm::vec3 shading, geometric;
};
Normals normalsAt(TestFrame& frame, int x, int y) {
  const auto words = frame.graph.find("frame.normals_packed").image().download<glm::uvec2>();
  const glm::uvec2 word = words[std::size_t(y) * kSize + std::size_t(x)];
  return {unpackNormal(word.x), unpackNormal(word.y)};
}

Scene sphereScene() {
  SceneBuilder builder("sphere");
  builder.place("sphere", shapes::icosphere(1.0f, 20),
                builder.diffuse("white", glm::vec3(0.25f, 0.5f, 1.0f)));
  return builder.finish();
}

TEST(GBuffer, SphereHasItsDepthNormalsAndColour) {
  const Scene scene = sphereScene();
  TestFrame frame(scene);
  frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
  const FrameView view = makeView(cameraAt({0, 0, 4}, {0, 0, 0}), kSize, kSize, glm::vec3(-1), glm::vec3(1));
  const std::vector<float> depth = frame.floats("frame.depth"), diffuse = frame.floats("frame.diffuse");
  const auto ids = frame.ids();
  int covered = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const glm::vec3 ray = view.corner + (float(x) + 0.5f) * view.step_x + (float(y) + 0.5f) * view.step_y;
      const float a = glm::dot(ray, ray), b = glm::dot(view.eye, ray),
                  c = glm::dot(view.eye, view.eye) - 1.0f;
      const float discriminant = b * b - a * c;
      const std::size_t i = std::size_t(y) * kSize + std::size_t(x);
      if (std::abs(discriminant) < 0.3f) continue;  // the icosphere's edge is not the sphere's
      EXPECT_EQ(ids[i].x != 0, discriminant > 0.0f) << x << ' ' << y;
      if (discriminant <= 0.0f) continue;
      ++covered;
      const float t = (-b - std::sqrt(discriminant)) / a;
      EXPECT_NEAR(view.z_near / depth[i], t, 6e-3f);
      const Normals normals = normalsAt(frame, x, y);
      const glm::vec3 exact = view.eye + t * ray;
      EXPECT_GT(glm::dot(normals.shading, exact), 0.9998f);
      EXPECT_GT(glm::dot(normals.geometric, exact), 0.997f);
      EXPECT_EQ(pixelOf(diffuse, kSize, x, y), glm::vec3(0.25f, 0.5f, 1.0f));
      if (covered > 60) return;  // reading back once a pixel is slow; these are enough
    }
  }
  FAIL() << "the sphere is too small";
}

// Both orders of vertices, mirrored or not, seen from both sides: normals face the eye.
TEST(GBuffer, NormalsFaceTheEyeWhateverTheWinding) {
  SceneBuilder builder("quads");
  const int white = builder.diffuse("white", glm::vec3(1.0f));
  Mesh quad = shapes::patch({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1}, {0, 1});
  builder.place("quad", quad, white, {-0.8f, 0, 0});
  std::reverse(quad.indices.begin(), quad.indices.end());
  builder.place("turned", quad, white, {0.8f, 0, 0});
  builder.at(1).scale = glm::vec3(-1, 1, 1);
  const Scene scene = builder.finish();
  TestFrame frame(scene);
  for (const float side : {1.0f, -1.0f}) {
    frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 4.0f * side}, {0, 0, 0}), kOptions);
    for (const int x : {kSize / 4, 3 * kSize / 4}) {
      const Normals normals = normalsAt(frame, x, kSize / 2);
      EXPECT_GT(normals.geometric.z * side, 0.9999f);
      EXPECT_GT(normals.shading.z * side, 0.9999f);
    }
  }
}

// A normal map that tilts by 30 degrees along +u, on a plain, a mirrored and a turned-over quad.
TEST(GBuffer, NormalMapTiltsAlongTheTangent) {
  SceneBuilder builder("mapped");
  const int material = builder.diffuse("mapped", glm::vec3(1.0f));
  Texture texture{.name = "tilt", .width = 1, .height = 1, .rgba = {191, 128, 238, 255}};  // (0.5, 0, 0.866)
  builder.material(material).normal_map.texture = builder.texture(texture);
  const Mesh quad = shapes::patch({-0.5f, 0.5f, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1}, {0, 1});
  builder.place("plain", quad, material, {-0.8f, 0, 0});
  builder.place("mirrored", quad, material, {0.8f, 0, 0});
  builder.at(1).scale = glm::vec3(-1, 1, 1);
  const Scene scene = builder.finish();
  TestFrame frame(scene);
  frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
  EXPECT_GT(glm::dot(normalsAt(frame, 16, 32).shading, glm::vec3(0.5f, 0, 0.866f)), 0.9999f);
  EXPECT_GT(glm::dot(normalsAt(frame, 48, 32).shading, glm::vec3(-0.5f, 0, 0.866f)), 0.9999f);
  EXPECT_GT(normalsAt(frame, 48, 32).geometric.z, 0.9999f);
  // From behind, a bump is a dent: the whole mapped normal is turned round.
  frame.draw(pose(scene, 0.0f), cameraAt({0, 0, -4}, {0, 0, 0}), kOptions);
  EXPECT_GT(glm::dot(normalsAt(frame, 48, 32).shading, glm::vec3(-0.5f, 0, -0.866f)), 0.9999f);
}

TEST(GBuffer, IdsNameObjectAndTriangle) {
  SceneBuilder builder("ids");
  const int white = builder.diffuse("white", glm::vec3(1.0f));
  const Mesh quad = shapes::patch({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1}, {0, 1});
  const Mesh other = shapes::patch({-0.4f, -0.4f, 0}, {0.8f, 0, 0}, {0, 0.8f, 0}, {0, 1}, {0, 1});
  builder.place("first", quad, white, {-0.8f, 0, 0});
  builder.place("second", other, white, {0.8f, 0, 0});
  Scene scene = builder.finish();
  scene.nodes[1].meshes = {0, 1};  // mesh 0 stands in two places: drawn together, yet two objects
  TestFrame frame(scene);
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.instances.size(), 3u);
  frame.draw(posed, cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
  const auto ids = frame.ids();
  const auto at = [&](int x, int y) { return ids[std::size_t(y) * kSize + std::size_t(x)]; };
  EXPECT_EQ(at(16, 32).x, 1u);
  EXPECT_GE(at(48, 32).x, 2u);
  EXPECT_EQ(at(2, 2).x, 0u);
  std::array<int, 2> triangles{};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize / 2; ++x) {
      if (at(x, y).x == 1u) ++triangles[std::min(at(x, y).y, 1u)];
      EXPECT_LE(at(x, y).y, 1u);
    }
  }
  EXPECT_NEAR(triangles[0], triangles[1], 0.2 * triangles[0]);
}

TEST(GBuffer, AlphaMaskHasHoles) {
  SceneBuilder builder("mask");
  const int material = builder.diffuse("mask", glm::vec3(1.0f));
  Texture texture{.name = "holes", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}};
  builder.material(material).base_color_map.texture = builder.texture(texture);
  builder.material(material).base_color_map.nearest = true;
  builder.material(material).alpha_mask = true;
  builder.place("quad", shapes::patch({-1, 1, 0}, {2, 0, 0}, {0, -2, 0}, {0, 1}, {0, 1}), material);
  const Scene scene = builder.finish();
  TestFrame frame(scene);
  frame.draw(pose(scene, 0.0f), cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
  const auto ids = frame.ids();
  EXPECT_EQ(ids[32 * kSize + 24].x, 1u);
  EXPECT_EQ(ids[32 * kSize + 40].x, 0u);
}

TEST(GBuffer, MotionFollowsCameraRigidAndDeformedThings) {
  SceneBuilder builder("motion");
  builder.place("quad", shapes::patch({-1, 1, 0}, {2, 0, 0}, {0, -2, 0}, shapes::steps(4), shapes::steps(4)),
                builder.diffuse("white", glm::vec3(1.0f)));
  const Scene scene = builder.finish();
  FrameOptions options = kOptions;
  options.motion = true;
  const auto motionAfter = [&](PosedScene first, PosedScene second, float camera_x) {
    TestFrame frame(scene);
    frame.draw(first, cameraAt({0, 0, 4}, {0, 0, 0}), options);
    const std::vector<float> none = frame.floats("frame.motion");
    EXPECT_EQ(*std::max_element(none.begin(), none.end()), 0.0f);
    frame.draw(second, cameraAt({camera_x, 0, 4}, {camera_x, 0, 0}), options);
    const std::vector<float> motion = frame.floats("frame.motion");
    return glm::vec2(motion[2 * (32 * kSize + 32)], motion[2 * (32 * kSize + 32) + 1]);
  };
  const float pixels_a_metre = kSize / (2.0f * 4.0f * std::tan(glm::radians(20.0f)));
  const PosedScene still = pose(scene, 0.0f);
  PosedScene moved = still, deformed = still, deformed_later = still;
  moved.instances[0].world_from_object[3].y += 0.1f;
  for (PosedScene* d : {&deformed, &deformed_later}) {
    d->instances[0].deformed_positions = scene.meshes[0].positions;
    d->instances[0].deformed_normals = scene.meshes[0].normals;
    d->instances[0].deformed_tangents = scene.meshes[0].tangents;
  }
  for (glm::vec3& p : deformed_later.instances[0].deformed_positions) p.x += 0.1f;
  EXPECT_NEAR(motionAfter(still, moved, 0.0f).y, -0.1f * pixels_a_metre, 0.02f);
  EXPECT_NEAR(motionAfter(still, still, 0.1f).x, -0.1f * pixels_a_metre, 0.02f);
  EXPECT_NEAR(motionAfter(deformed, deformed_later, 0.0f).x, 0.1f * pixels_a_metre, 0.02f);
}

TEST(GBuffer, RefusesPosesOfAnotherScene) {
  const Scene scene = sphereScene();
  TestFrame frame(scene);
  PosedScene posed = pose(scene, 0.0f);
  posed.instances[0].mesh = 7;
  EXPECT_NE(gpu::errorOf([&] {
              frame.draw(posed, cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
            }).find("instances[0]"),
            std::string::npos);
  posed.instances[0].mesh = 0;
  posed.instances[0].deformed_positions = {{0, 0, 0}};
  posed.instances[0].deformed_normals = {{0, 0, 1}};
  EXPECT_NE(gpu::errorOf([&] {
              frame.draw(posed, cameraAt({0, 0, 4}, {0, 0, 0}), kOptions);
            }).find("vertices"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam::frame
