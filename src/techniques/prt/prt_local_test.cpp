// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Local light: against distant light where there is nothing near, against what is known of spheres, discs and lamps, and of
// objects that see one another.
#include "techniques/prt/prt_local.h"

#include <gloam/bake.h>

#include "scene/environment.h"
#include "techniques/prt/prt_test_frame.h"

namespace gloam::prt {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

Settings localSettings(Values values = {}) {
  Settings result = settings({{"local_light", "emitters"}});
  for (const auto& [name, value] : values) result.set(name, value);
  return result;
}

/// Unshadowed transfer in closed form; every node an object of its own.
void addTransfer(Scene& scene, int order) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = order;
    transfer->object = int(m);
    for (const glm::vec3& n : scene.meshes[m].normals) {
      const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(order), n);
      transfer->direct.insert(transfer->direct.end(), cosine.c.begin(), cosine.c.begin() + cosine.size());
    }
    scene.meshes[m].transfer = transfer;
  }
}

struct Lit {
  std::vector<VertexLight> light;  ///< all instances' vertices, end to end
  std::vector<float> trust;
  Warnings warnings;
};
/// What the vertices get: the same for all cameras.
Lit lightOf(const Scene& scene, const Settings& settings, float time_s = 0.0f) {
  const PosedScene posed = pose(scene, time_s);
  frame::TestFrame frame(scene);
  Prt technique(gpu::testDevice());
  const PosedCamera camera = posed.cameras.empty() ? frame::cameraAt({0, 0, 9}, {0, 0, 0}) : posed.cameras[0];
  frame.draw(posed, camera, {.width = kSize, .height = kSize},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  Lit lit{frame.graph.findBuffer("prt.vertex_light").buffer().download<VertexLight>(), {}, frame.warnings};
  const gpu::BufferRef trust = frame.graph.findBuffer("prt.local_cube_trust");
  if (trust) lit.trust = trust.buffer().download<float>();
  return lit;
}

/// A ball about the origin, and whatever is added.
struct Stage {
  Stage() : builder("stage") {
    builder.place("ball", shapes::icosphere(0.5f, 6), builder.diffuse("white", glm::vec3(0.8f)));
  }
  int glow(const glm::vec3& radiance) {
    const int material = builder.diffuse("glow", glm::vec3(0.0f));
    builder.material(material).emission = radiance;
    return material;
  }
  Scene finish(int order = 5) {
    Scene scene = builder.finish();
    addTransfer(scene, order);
    return scene;
  }
  SceneBuilder builder;
};

float greatestDifference(const std::vector<VertexLight>& a, const std::vector<VertexLight>& b,
                         std::size_t count) {
  float worst = 0.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 d = glm::abs(a[i].direct - b[i].direct);
    worst = std::max({worst, d.r, d.g, d.b});
  }
  return worst;
}

// With nothing around, what is sampled is the distant light: furnace or daylight, one point or several.
TEST(PrtLocal, AloneUnderTheSkyItIsDistantLight) {
  for (const char* sky : {"sky:uniform", "sky:preetham?elevation=25"}) {
    Stage stage;
    stage.builder.at(0).rotation = glm::angleAxis(1.1f, glm::normalize(glm::vec3(1, 2, -0.5f)));
    Scene scene = stage.finish();
    scene.environment = loadEnvironment(sky);
    const Lit distant = lightOf(scene, localSettings({{"local_light", "off"}}));
    float greatest = 0.0f;
    for (const VertexLight& light : distant.light) greatest = std::max(greatest, light.direct.g);
    for (const char* points : {"1", "4"}) {
      const Lit local = lightOf(scene, localSettings({{"local_points", points}}));
      ASSERT_EQ(local.light.size(), distant.light.size());
      EXPECT_LT(greatestDifference(local.light, distant.light, local.light.size()), 1e-3f * greatest)
          << sky << " " << points;
    }
  }
}

// A ball that glows is a disc in the sky of another: E = E_disc, whatever the distance.
TEST(PrtLocal, FarGlowingBallIsADisc) {
  Stage stage;
  const glm::vec3 to = glm::normalize(glm::vec3(0.5f, 0.4f, 0.8f));
  const float distance = 6.0f, radius = 1.2f;
  stage.builder.place("sun", shapes::icosphere(radius, 16), stage.glow({3.0f, 2.0f, 1.0f}), distance * to);
  const Scene scene = stage.finish();
  const Lit lit = lightOf(scene, localSettings({{"local_points", "1"}, {"local_size", "64"}}));
  const sh::ShRgb disc =
      sh::colored(sh::disc(5, to, std::asin(radius / distance)), glm::vec3(3.0f, 2.0f, 1.0f));
  const float greatest = sh::irradiance(disc, to).r;
  const std::vector<glm::vec3>& normals = scene.meshes[0].normals;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const glm::vec3 want = sh::irradiance(disc, normals[v]);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(lit.light[v].direct[c], want[c], 0.02f * greatest);
  }
}

// A lamp shines on an open surface by inverse square and cosine, as exactly near as far; what stands before it takes it away.
TEST(PrtLocal, LampsAreSeenFromEachVertex) {
  const glm::vec3 to = glm::normalize(glm::vec3(-0.4f, 0.8f, 0.3f));
  Light lamp;
  lamp.intensity = {400.0f, 300.0f, 200.0f};
  for (const float distance : {10.0f, 0.8f}) {
    Stage stage;
    stage.builder.light(lamp, distance * to);
    const Scene near = stage.finish();
    const Lit lit = lightOf(near, localSettings({{"local_light", "all"}, {"local_points", "1"}}));
    for (std::size_t v = 0; v < near.meshes[0].normals.size(); ++v) {
      const glm::vec3 between = distance * to - near.meshes[0].positions[v];
      const float squared = glm::dot(between, between);
      const float cosine = glm::dot(near.meshes[0].normals[v], between) / std::sqrt(squared);
      const glm::vec3 want = lamp.intensity * std::max(cosine, 0.0f) / squared;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(lit.light[v].direct[c], want[c], 1e-3f * lamp.intensity.r / squared);
    }
  }
  Stage stage;
  stage.builder.light(lamp, 10.0f * to);
  const Scene scene = stage.finish();
  const Lit by_shadow_maps = lightOf(scene, localSettings({{"local_points", "1"}}));
  for (const VertexLight& vertex : by_shadow_maps.light) ASSERT_EQ(vertex.direct, glm::vec3(0.0f));

  Stage covered;
  covered.builder.light(lamp, 10.0f * to);
  covered.builder.place("cover", shapes::icosphere(1.0f, 8), covered.builder.diffuse("dark", glm::vec3(0.0f)),
                        4.0f * to);
  const Lit dark = lightOf(covered.finish(), localSettings({{"local_light", "all"}, {"local_points", "1"}}));
  for (std::size_t v = 0; v < scene.meshes[0].normals.size(); ++v)
    ASSERT_LT(glm::length(dark.light[v].direct), 1e-3f);
}

// Points are blended over the surface without a step; more of them are nearer to what arrives at each place.
TEST(PrtLocal, PointsAreBlendedContinuously) {
  Stage stage;
  stage.builder.place("glow", shapes::icosphere(0.4f, 10), stage.glow(glm::vec3(5.0f)), {1.1f, 0.0f, 0.0f});
  const Scene scene = stage.finish();
  const std::vector<glm::vec3>& positions = scene.meshes[0].positions;
  const auto exact = [&](std::size_t v) {  // a ball over a plane's horizon: E = pi L (r / d)^2 cos
    const glm::vec3 between = glm::vec3(1.1f, 0.0f, 0.0f) - positions[v];
    const float d = glm::length(between), cosine = glm::dot(between / d, scene.meshes[0].normals[v]);
    return cosine > 0.4f / d ? kPi * 5.0f * 0.16f / (d * d) * cosine : -1.0f;  // -1: it is cut by the horizon
  };
  std::vector<double> errors;
  for (const char* points : {"1", "2", "8"}) {
    const Lit lit = lightOf(scene, localSettings({{"local_points", points}, {"local_size", "32"}}));
    float greatest = 0.0f, step = 0.0f;
    for (std::size_t v = 0; v < positions.size(); ++v) greatest = std::max(greatest, lit.light[v].direct.r);
    const std::vector<std::uint32_t>& indices = scene.meshes[0].indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      step = std::max(step, std::abs(lit.light[indices[i]].direct.r - lit.light[indices[i + 1]].direct.r));
    EXPECT_LT(step, 0.4f * greatest) << points;  // edges are 12 degrees long
    double error = 0.0, sum = 0.0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const float want = exact(v);
      if (want < 0.0f) continue;
      error += double(lit.light[v].direct.r - want) * double(lit.light[v].direct.r - want);
      sum += double(want) * double(want);
    }
    errors.push_back(std::sqrt(error / sum));
  }
  EXPECT_LT(errors[2], 0.6 * errors[0]);
  EXPECT_LT(errors[2], 0.3);
}

// Two balls under a white sky: each takes on the colour of the other, on the side that faces it.
TEST(PrtLocal, ObjectsLightOneAnother) {
  SceneBuilder builder("pair");
  builder.place("red", shapes::icosphere(0.5f, 5), builder.diffuse("red", {0.9f, 0.0f, 0.0f}), {-0.6f, 0, 0});
  builder.place("green", shapes::icosphere(0.5f, 5), builder.diffuse("green", {0.0f, 0.9f, 0.0f}),
                {0.6f, 0, 0});
  Scene scene = builder.finish();
  addTransfer(scene, 5);
  scene.environment = loadEnvironment("sky:uniform");
  const Lit none = lightOf(scene, localSettings({{"local_bounces", "0"}})),
            once = lightOf(scene, localSettings());
  const std::size_t vertices = scene.meshes[0].vertexCount();
  for (std::size_t v = 0; v < vertices; ++v) {
    const glm::vec3& n = scene.meshes[0].normals[v];
    const glm::vec3 red = once.light[v].indirect, green = once.light[vertices + v].indirect;
    EXPECT_NEAR(red.r, 0.0f, 1e-4f);
    EXPECT_NEAR(green.g, 0.0f, 1e-4f);
    EXPECT_EQ(none.light[v].indirect, glm::vec3(0.0f));
    if (n.x > 0.9f) {
      EXPECT_GT(red.g, 0.2f);
      EXPECT_LT(once.light[v].direct.g, 0.95f * kPi);  // the other stands before the sky
    }
    if (n.x < -0.9f) {
      EXPECT_GT(green.r, 0.2f);
      EXPECT_LT(red.g, 0.1f);
    }
  }
}

// What moves takes its points along; nothing depends on the frame before.
TEST(PrtLocal, PointsMoveWithTheirObject) {
  std::vector<std::vector<VertexLight>> lights;
  for (const float angle : {0.0f, 2.0f}) {
    Stage stage;
    const int glow = stage.glow({3.0f, 2.0f, 1.0f});
    const int panel = stage.builder.node("panel");
    stage.builder.place("glow", shapes::icosphere(0.4f, 10), glow, {1.2f, 0.3f, 0.0f}, panel);
    // All turned as one.
    for (const int node : {0, panel})
      stage.builder.at(node).rotation = glm::angleAxis(angle, glm::vec3(0, 1, 0));
    lights.push_back(lightOf(stage.finish(), localSettings({{"local_size", "48"}})).light);
  }
  const std::size_t ball = lights[0].size() / 2 < 362 ? lights[0].size() / 2 : 362;
  float greatest = 0.0f;
  for (std::size_t v = 0; v < ball; ++v) greatest = std::max(greatest, lights[0][v].direct.r);
  EXPECT_LT(greatestDifference(lights[0], lights[1], ball), 0.04f * greatest);  // texels lie otherwise
}

// A point below the floor sees its back, and counts for nothing.
TEST(PrtLocal, BuriedPointsDoNotCount) {
  Stage stage;
  stage.builder.at(0).translation = {0.0f, 0.45f, 0.0f};
  stage.builder.place("floor", shapes::ground(8, 8, 8, 8), stage.builder.diffuse("floor", glm::vec3(0.5f)));
  Scene scene = stage.finish();
  scene.environment = loadEnvironment("sky:uniform");
  const Lit lit = lightOf(scene, localSettings({{"local_points", "6"}}));
  ASSERT_EQ(lit.trust.size(), 12u);
  EXPECT_EQ(*std::min_element(lit.trust.begin(), lit.trust.begin() + 6), 0.0f);
  EXPECT_EQ(*std::max_element(lit.trust.begin(), lit.trust.begin() + 6), 1.0f);
  for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
    if (scene.meshes[0].normals[v].y > 0.95f) {
      EXPECT_NEAR(lit.light[v].direct.g, kPi, 0.15f);
    }
  }
}

// Gloss, too, is lit by probes: with nothing near, as under distant light; by what glows where something does.
TEST(PrtLocal, GlossSeesLocalLight) {
  const auto drawn = [](const Scene& scene, const char* local_light) {
    const PosedScene posed = pose(scene, 0.0f);
    frame::TestFrame frame(scene);
    Prt technique(gpu::testDevice());
    const Settings values = localSettings({{"local_light", local_light}, {"local_points", "2"}});
    const auto images =
        frame.draw(posed, frame::cameraAt({0, 0, 2.5f}, {0, 0, 0}), {.width = kSize, .height = kSize},
                   [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                     return technique.record(graph, inputs, values);
                   });
    return images.direct.image().downloadFloats();
  };
  const auto baked = [](bool glow) {
    SceneBuilder builder("gloss");
    builder.place("ball", shapes::icosphere(0.5f, 8), builder.metal("metal", glm::vec3(0.9f), 0.7f));
    if (glow) {
      const int material = builder.diffuse("glow", glm::vec3(0.0f));
      builder.material(material).emission = glm::vec3(2.0f);
      builder.place("glow", shapes::icosphere(2.0f, 6), material, {0.0f, 6.0f, 0.0f});
    }
    return bakeTransfer(builder.finish(), {.kind = TransferKind::kShadowed,
                                           .order = 5,
                                           .directions = 512,
                                           .glossy = GlossyMeshes::kShiny,
                                           .apart = true});
  };
  Scene alone = baked(false);
  alone.environment = loadEnvironment("sky:preetham?elevation=30");
  const std::vector<float> distant = drawn(alone, "off"), local = drawn(alone, "emitters");
  float greatest = 0.0f;
  for (std::size_t i = 0; i < distant.size(); ++i)
    greatest = std::max(greatest, i % 4 == 3 ? 0.0f : distant[i]);
  for (std::size_t i = 0; i < distant.size(); ++i) ASSERT_NEAR(local[i], distant[i], 0.01f * greatest) << i;

  const std::vector<float> lit = drawn(baked(true), "emitters"), dark = drawn(baked(true), "off");
  const std::size_t upper = 4 * std::size_t(22 * kSize + kSize / 2),
                    lower = 4 * std::size_t(44 * kSize + kSize / 2);
  EXPECT_GT(lit[upper], 0.05f);
  EXPECT_LT(lit[lower], 0.3f * lit[upper]);
  EXPECT_EQ(dark[upper], 0.0f);
}

TEST(PrtLocal, AnswersForMoreLight) {
  const Settings off = localSettings({{"local_light", "off"}}), on = localSettings();
  EXPECT_EQ(coverageWith(info(), off), info().covers);
  EXPECT_EQ(coverageWith(info(), on), kAllLight);
  EXPECT_NE(info().covers, kAllLight);
}

TEST(PrtLocal, PickedPointsSurroundTheSurface) {
  const Mesh ball = shapes::icosphere(1.0f, 6);
  SurfaceSampler sampler;
  sampler.add(ball.positions, ball.normals, ball.indices, glm::mat4(1.0f));
  const SurfacePoints surface = sampler.points(2000);
  EXPECT_LT(glm::length(pickPoints(surface, 1).at(0)), 0.05f);
  for (const int count : {2, 4, 8, 16}) {
    const std::vector<glm::vec3> points = pickPoints(surface, count);
    ASSERT_EQ(points.size(), std::size_t(count));
    EXPECT_EQ(points, pickPoints(sampler.points(2000), count));
    float nearest = 2.0f;
    for (std::size_t a = 0; a < points.size(); ++a) {
      EXPECT_GT(glm::length(points[a]), 1.05f);
      for (std::size_t b = 0; b < a; ++b) nearest = std::min(nearest, glm::length(points[a] - points[b]));
    }
    EXPECT_GT(nearest, 2.0f / std::sqrt(float(count)));
  }
  EXPECT_EQ(pickPoints({}, 3).size(), 3u);
}

// Baked apart: each object by itself, numbered; the file keeps the numbers; a copy of an object is another object.
TEST(PrtLocal, ObjectsAreBakedApart) {
  Stage stage;
  stage.builder.place("second", shapes::icosphere(0.5f, 4), 0, {0.9f, 0.0f, 0.0f});
  Scene scene = stage.builder.finish();
  BakeOptions options{.kind = TransferKind::kShadowed, .order = 4, .directions = 512};
  const Scene together = bakeTransfer(scene, options);
  options.apart = true;
  const Scene apart = bakeTransfer(scene, options);
  ASSERT_EQ(apart.meshes.size(), 2u);
  for (int m = 0; m < 2; ++m) {
    const Transfer& transfer = *apart.meshes[std::size_t(m)].transfer;
    EXPECT_EQ(transfer.object, m);
    EXPECT_EQ(together.meshes[std::size_t(m)].transfer->object, 0);
    for (std::size_t v = 0; v < apart.meshes[std::size_t(m)].vertexCount();
         ++v)  // a convex body blocks nothing of its own
      ASSERT_NEAR(transfer.direct[v * 16], kPi * 0.28209479f, 1e-4f);
  }
  EXPECT_NE(together.meshes[0].transfer->direct, apart.meshes[0].transfer->direct);
  const auto path = std::filesystem::temp_directory_path() / "gloam_apart_test.glb";
  writeGlb(apart, path);
  const Scene read = loadScene(path.string());
  std::filesystem::remove(path);
  EXPECT_EQ(read.meshes.at(1).transfer->object, 1);
}

}  // namespace
}  // namespace gloam::prt
