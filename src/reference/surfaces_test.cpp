// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What paths meet, and what the camera sees of it: sides, holes, textures, normals, lobes.
#include "reference/surfaces.h"

#include <algorithm>

#include "math/sampling.h"
#include "math/simd_test_targets.h"
#include "reference/test_points.h"
#include "scene/builtin_shapes.h"
#include "scene/camera_rays.h"
#include "trace/surface.h"

namespace gloam::reference {
namespace {

// Sixteen paths at one point.
struct AtPoint {
  brdf::Lobes lobes;
  glm::vec3 normal, to_view;
  PathLanes lanes{};

  AtPoint(const brdf::Lobes& given, const glm::vec3& n, const glm::vec3& v)
      : lobes(given), normal(n), to_view(v) {
    for (int i = 0; i < kLanes; ++i) {
      lanes.throughput.set(i, glm::vec3(1.0f));
      lanes.geometric_normal.set(i, n);
      lanes.normal.set(i, n);
      lanes.to_view.set(i, v);
      lanes.diffuse.set(i, lobes.diffuse);
      lanes.specular.set(i, lobes.specular);
      lanes.exponent.at[i] = lobes.exponent;
      lanes.specular_share.at[i] = brdf::specularProbability(lobes);
    }
    lanes.glossy = brdf::specularProbability(lobes) > 0.0f;
    setMirrors(lanes);
  }
  void chooseFrom(std::uint32_t first) {
    for (int i = 0; i < kLanes; ++i) lanes.place.at[i] = bits::reversedBits(first + std::uint32_t(i));
    chooseSteps(lanes, Sampler(1, 2, 0).scramble(3));
  }
};

void compareLobesWithBrdf() {
  for (const brdf::Lobes& lobes :
       {brdf::makeLobes({0.7f, 0.4f, 0.1f}, 0.0f, 0.5f), brdf::makeLobes({0.9f, 0.8f, 0.1f}, 1.0f, 0.2f),
        brdf::makeLobes(glm::vec3(0.5f), 0.3f, 1.0f), brdf::makeLobes(glm::vec3(0.5f), 0.0f, 1.0f, 0.0f)}) {
    AtPoint at(lobes, glm::normalize(glm::vec3(0.1f, 1.0f, -0.2f)),
               glm::normalize(glm::vec3(0.8f, 0.5f, 0.3f)));
    for (std::uint32_t k = 0; k < 2000; k += kLanes) {
      LaneVectors values;
      LaneFloats pdfs;
      at.chooseFrom(k);
      const LaneVectors steps = at.lanes.direction;
      LaneVectors anywhere;
      for (int i = 0; i < kLanes; ++i)
        anywhere.set(i, sampling::uniformSphere(sampling::r2(k + std::uint32_t(i))));
      for (const LaneVectors& directions : {steps, anywhere}) {
        lobesOfLanes(at.lanes, directions, values, pdfs);
        for (int i = 0; i < kLanes; ++i) {
          const glm::vec3 d = directions.get(i);
          const glm::vec3 want = brdf::evaluateLobes(lobes, at.normal, at.to_view, d);
          EXPECT_LT(glm::length(values.get(i) - want), 1e-5f + 2e-4f * glm::length(want));
          const float pdf = brdf::lobesPdf(lobes, at.normal, at.to_view, d);
          EXPECT_NEAR(pdfs.at[i], pdf, 1e-5f + 2e-4f * pdf);
        }
      }
    }
  }
}

TEST(PathLanes, LobesAreThoseOfTheBrdf) {
  onEveryTarget([](const char* target) {
    SCOPED_TRACE(target);
    compareLobesWithBrdf();
  });
}

// Mean of f / density over the lobes' own samples is the integral of f, here of the lobes' value times a smooth function.
void compareStepsWithTheirDensity() {
  const brdf::Lobes lobes = brdf::makeLobes({0.7f, 0.4f, 0.1f}, 0.2f, 0.6f);
  AtPoint at(lobes, {0.0f, 1.0f, 0.0f}, glm::normalize(glm::vec3(0.8f, 0.5f, 0.3f)));
  const auto smooth = [](const glm::vec3& d) { return 1.0 + double(d.x) * double(d.y) - 0.5 * double(d.z); };
  double by_lobes = 0.0, by_sphere = 0.0;
  constexpr std::uint32_t kCount = 1 << 17;
  for (std::uint32_t k = 0; k < kCount; k += kLanes) {
    at.chooseFrom(k);
    for (int i = 0; i < kLanes; ++i) {
      by_lobes += double(at.lanes.step.get(i).g) * smooth(at.lanes.direction.get(i)) / kCount;
      const glm::vec3 b = sampling::uniformSphere(sampling::sobol2(k + std::uint32_t(i)));
      if (b.y > 0.0f)  // below, no step is taken
        by_sphere += double(brdf::evaluateLobes(lobes, at.normal, at.to_view, b).g) * smooth(b) * 4.0 *
                     double(sampling::kPi) / kCount;
    }
  }
  EXPECT_NEAR(by_lobes, by_sphere, 1e-3 * by_sphere);
}

TEST(PathLanes, StepsFollowTheirDensity) {
  onEveryTarget([](const char* target) {
    SCOPED_TRACE(target);
    compareStepsWithTheirDensity();
  });
}

// A narrow lobe keeps its energy: value over density, in floats, for the smoothest surface there is.
TEST(PathLanes, MirrorsKeepTheirEnergy) {
  const brdf::Lobes lobes = brdf::makeLobes(glm::vec3(1.0f), 1.0f, 0.0f);
  AtPoint at(lobes, {0.0f, 1.0f, 0.0f}, glm::normalize(glm::vec3(0.8f, 0.5f, 0.3f)));
  for (std::uint32_t k = 0; k < 256; k += kLanes) {
    at.chooseFrom(k);
    for (int i = 0; i < kLanes; ++i) {
      EXPECT_NEAR(at.lanes.step.get(i).g, 1.0f, 1e-4f);
      EXPECT_GT(glm::dot(at.lanes.direction.get(i), at.lanes.mirror.get(i)), 0.9999f);
    }
  }
}

// What is read of textures is what trace/surface.h reads.
void compareTexturesWithOnePoint() {
  Scene scene;
  Texture texture{"", 3, 5, {}};
  for (int i = 0; i < 3 * 5 * 4; ++i) texture.rgba.push_back(std::uint8_t(i * 37 % 256));
  scene.textures.push_back(texture);
  Mesh mesh;
  mesh.indices = {0, 1, 2};
  mesh.uv_sets = {{{-3.3f, 0.2f}, {2.7f, -1.9f}, {0.4f, 5.1f}}, {{0.1f, 0.1f}, {0.9f, 0.0f}, {1.0f, 1.0f}}};
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge}) {
    for (const bool nearest : {false, true}) {
      for (const int set : {0, 1, 2}) {
        TextureSlot slot{0, set, wrap, wrap, nearest};
        slot.texture_from_uv = {1.5f, 0.25f, 0.0f, -0.5f, 2.0f, 0.0f, 0.3f, -0.7f, 1.0f};
        for (const bool srgb : {false, true}) {
          const TextureReader reader(scene, slot, mesh, srgb);
          for (std::uint32_t i = 0; i < 300; ++i) {
            const glm::vec2 u = 3.0f * sampling::r2(i) - 1.0f;
            const glm::vec4 want = trace::sampleTexture(scene, slot, mesh, {0, u.x, u.y}, srgb);
            EXPECT_LT(glm::length(reader.at({0, 1, 2}, u.x, u.y) - want), 1e-4f);
            const glm::vec2 uv = reader.coordinates({0, 1, 2}, u.x, u.y);
            LaneFloats x{}, y{};
            x.at[i % kLanes] = uv.x;
            y.at[i % kLanes] = uv.y;
            LaneVectors lanes;
            TextureLanes textures{};
            textures[i % kLanes] = &reader.table();
            TexelLanes texels;
            findTexels(textures, 1u << (i % kLanes), x, y, texels);
            readTexels(textures, 1u << (i % kLanes), texels, srgb, lanes);
            EXPECT_EQ(lanes.get(int((i + 1) % kLanes)), glm::vec3(1.0f));
            EXPECT_LT(glm::length(lanes.get(int(i % kLanes)) - glm::vec3(want)), 1e-4f);
          }
        }
      }
    }
  }
  EXPECT_EQ(TextureReader().at({0, 1, 2}, 0.3f, 0.3f), glm::vec4(1.0f));
}

TEST(TextureReader, IsTheFunctionForOnePoint) {
  onEveryTarget([](const char* target) {
    SCOPED_TRACE(target);
    compareTexturesWithOnePoint();
  });
}

Mesh sheet(bool turned) {
  Mesh mesh = shapes::ground(4.0f, 4.0f, 2, 2);
  if (!turned) return mesh;
  for (glm::vec3& n : mesh.normals) n = -n;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

// The lit side is the one that is seen, whichever way the triangles are wound; light from behind does not come through.
TEST(Surfaces, BothSidesAreDrawnAndNeitherLetsLightThrough) {
  for (const bool turned : {false, true}) {
    for (const float side : {1.0f, -1.0f}) {
      for (const float lamp_side : {1.0f, -1.0f}) {
        SceneBuilder builder("sheet");
        builder.place("sheet", sheet(turned), builder.glossy("grey", glm::vec3(0.5f), 0.5f));
        builder.light(Light{}, {0.3f, 2.0f * lamp_side, 0.0f});
        const Scene scene = builder.finish();
        const Estimate e =
            estimate(scene, lookingAt({1.0f, side, 0.2f}, glm::vec3(0.1f, 0.0f, 0.1f)), {}, onePixel(0), 1);
        if (side == lamp_side) {
          EXPECT_GT(e.mean, 0.02);
        } else {
          EXPECT_EQ(e.mean, 0.0);
        }
        const PosedScene posed = pose(scene, 0.0f);
        const Integrator integrator(scene, posed, lookingAt({1.0f, side, 0.2f}, glm::vec3(0.1f, 0.0f, 0.1f)),
                                    {}, onePixel(0), {});
        const CameraPoint point = integrator.look(0, 0);
        EXPECT_NEAR(point.normal.y, side, 1e-6f);
        EXPECT_NEAR(point.geometric_normal.y, side, 1e-6f);
        EXPECT_NEAR(glm::length(point.position - glm::vec3(0.1f, 0.0f, 0.1f)), 0.0f, 1e-4f);
      }
    }
  }
}

// A mask of two texels under a lamp: the half that is cut out neither stops light nor is seen; the cutoff counts.
TEST(Surfaces, MasksHaveHolesInEveryRay) {
  SceneBuilder builder("mask");
  const int solid = builder.diffuse("floor", glm::vec3(0.5f)),
            masked = builder.diffuse("mask", glm::vec3(1.0f));
  const int texture = builder.texture({"", 2, 1, {255, 255, 255, 255, 255, 255, 255, 100}});
  builder.material(masked).base_color_map.texture = texture;
  builder.material(masked).base_color_map.nearest = true;
  builder.material(masked).alpha_mask = true;
  builder.place("floor", sheet(false), solid);
  builder.place("mask", sheet(false), masked, {0.0f, 0.5f, 0.0f});
  builder.light(Light{}, {0.0f, 3.0f, 0.0f});
  Scene scene = builder.finish();
  const auto seen = [&](float x) {
    const PosedScene posed = pose(scene, 0.0f);
    const Integrator integrator(scene, posed, lookingAt({x, 2.0f, 0.3f}, {x, 0.0f, 0.3f}), {}, onePixel(0),
                                {});
    return integrator.look(0, 0).instance;
  };
  EXPECT_EQ(seen(-1.0f), 1);
  EXPECT_EQ(seen(1.0f), 0);
  // On the floor, below: in shadow, and in light.
  const auto below = [&](float x) { return lookingAt({x, 0.3f, 0.3f}, {x, 0.0f, 0.2f}); };
  EXPECT_EQ(estimate(scene, below(-1.0f), {}, onePixel(0), 1).mean, 0.0);
  EXPECT_GT(estimate(scene, below(1.0f), {}, onePixel(0), 1).mean, 0.0);
  scene.materials[1].alpha_cutoff = 0.3f;  // 100 / 255 is above it
  EXPECT_EQ(seen(1.0f), 1);
  EXPECT_EQ(estimate(scene, below(1.0f), {}, onePixel(0), 1).mean, 0.0);
}

// A checkerboard too fine for the pixel: its mean, in the layer and in every mean over samples.
TEST(Surfaces, TexturesAreAveragedOverThePixel) {
  SceneBuilder builder("checker");
  const int material = builder.diffuse("checker", glm::vec3(1.0f));
  builder.material(material).base_color_map.texture =
      builder.texture({"", 2, 2, {255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255}});
  builder.material(material).base_color_map.nearest = true;
  builder.place("floor", shapes::withUvScale(sheet(false), glm::vec2(64.0f)), material);
  const Scene scene = builder.finish();
  PosedCamera camera = lookingAt({1.0f, 2.0f, 0.2f}, {0.101f, 0.0f, 0.113f});
  camera.camera.vertical_fov_rad = 0.15f;
  expectTruth(estimate(scene, camera, uniformSky(), onePixel(0), 8192), 0.5, 0.02);
  const PosedScene posed = pose(scene, 0.0f);
  const Integrator integrator(scene, posed, camera, {}, onePixel(0), {});
  EXPECT_NEAR(integrator.look(0, 0).albedo.g, 0.5f, 0.2f);  // 16 points of the footprint
  // The footprint is the shift from this pixel to the next: compared with looking there.
  ReferenceOptions two = onePixel(0);
  two.width = two.height = 64;
  const Integrator fine(scene, posed, camera, {}, two, {});
  const CameraPoint here = fine.look(30, 31), right = fine.look(31, 31), below = fine.look(30, 32);
  ASSERT_EQ(here.triangle, right.triangle);
  ASSERT_EQ(here.triangle, below.triangle);
  EXPECT_NEAR(right.u - here.u, here.uv_per_x.x, 1e-5f);
  EXPECT_NEAR(right.v - here.v, here.uv_per_x.y, 1e-5f);
  EXPECT_NEAR(below.u - here.u, here.uv_per_y.x, 1e-5f);
  EXPECT_NEAR(below.v - here.v, here.uv_per_y.y, 1e-5f);
}

// A normal map that tilts by 30 degrees toward +u, on a plane and on its mirror image; and seen from below.
TEST(Surfaces, NormalMapsTiltInTheFrameOfTheMesh) {
  SceneBuilder builder("tilted");
  const int material = builder.diffuse("tilted", glm::vec3(0.5f));
  builder.material(material).normal_map.texture = builder.texture({"", 1, 1, {191, 128, 238, 255}});
  const int node = builder.place("sheet", sheet(false), material);
  Scene scene = builder.finish();
  for (const float mirror : {1.0f, -1.0f}) {
    scene.nodes[std::size_t(node)].scale = {mirror, 1.0f, 1.0f};
    const PosedScene posed = pose(scene, 0.0f);
    for (const float side : {1.0f, -1.0f}) {
      const Integrator integrator(scene, posed, lookingAt({0.2f, 2.0f * side, 0.3f}, {0.2f, 0.0f, 0.2f}), {},
                                  onePixel(0), {});
      const CameraPoint point = integrator.look(0, 0);
      EXPECT_NEAR(point.normal.x, 0.5f * mirror * side, 0.01f);  // turned round as a whole
      EXPECT_NEAR(point.normal.y, side * std::sqrt(0.75f), 0.01f);
      EXPECT_NEAR(point.geometric_normal.y, side, 1e-6f);
    }
  }
}

TEST(Surfaces, VertexColorsAndDeformedVerticesCount) {
  SceneBuilder builder("colors");
  Mesh mesh = sheet(false);
  for (const glm::vec3& p : mesh.positions) mesh.colors.emplace_back(0.5f + 0.2f * p.x, 0.5f, 0.5f, 1.0f);
  builder.place("sheet", mesh, builder.diffuse("white", glm::vec3(1.0f)));
  const Scene scene = builder.finish();
  PosedScene posed = pose(scene, 0.0f);
  const auto look = [&](float height) {
    const Integrator integrator(scene, posed, lookingAt({1.0f, 5.0f, 0.1f}, {1.0f, height, 0.1f}), {},
                                onePixel(0), {});
    return integrator.look(0, 0);
  };
  EXPECT_NEAR(look(0.0f).albedo.r, 0.7f, 1e-3f);
  Instance& instance = posed.instances[0];
  for (const glm::vec3& p : mesh.positions)
    instance.deformed_positions.push_back(p + glm::vec3(0.0f, 2.0f, 0.0f));
  instance.deformed_normals.assign(mesh.positions.size(), glm::normalize(glm::vec3(1.0f, 1.0f, 0.0f)));
  EXPECT_NEAR(look(2.0f).eye_depth, 3.0f, 1e-4f);
  EXPECT_NEAR(look(2.0f).normal.x, std::sqrt(0.5f), 1e-5f);
  instance.deformed_normals.pop_back();
  EXPECT_THROW(look(2.0f), Error);
}

// Pixel centres, eye depth and the near plane are those of scene/camera_rays.h, for both kinds of camera.
TEST(Camera, SeesWhatItsRaysMeet) {
  SceneBuilder builder("sheet");
  builder.place("sheet", sheet(false), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.place("glass", sheet(false), builder.diffuse("near", glm::vec3(0.5f)), {0.0f, 2.5f, 0.0f});
  const Scene scene = builder.finish();
  const PosedScene posed = pose(scene, 0.0f);
  for (const bool perspective : {true, false}) {
    PosedCamera camera = lookingAt({0.1f, 3.0f, 0.4f}, {0.1f, 0.0f, 0.4f});
    camera.camera.perspective = perspective;
    camera.camera.vertical_fov_rad = 0.5f;
    camera.camera.half_height = 0.7f;
    ReferenceOptions options = onePixel(0);
    options.width = 9;
    options.height = 5;
    const CameraRays rays = makeCameraRays(camera, 9, 5);
    for (const float z_near : {0.1f, 1.0f}) {
      camera.camera.z_near = z_near;
      const Integrator integrator(scene, posed, camera, uniformSky(), options, {});
      const CameraPoint point = integrator.look(7, 1);
      EXPECT_NEAR(point.eye_depth, z_near < 0.5f ? 0.5f : 3.0f, 1e-5f);
      const glm::vec3 want = rays.origin(7.5f, 1.5f) + rays.direction(7.5f, 1.5f) * point.eye_depth;
      EXPECT_LT(glm::length(point.position - want), 1e-5f);
      EXPECT_LT(
          glm::length(point.to_eye - glm::normalize(perspective ? rays.eye - point.position : -rays.forward)),
          1e-6f);
    }
  }
}

TEST(Camera, BackgroundIsTheSkyOrNothing) {
  SceneBuilder builder("sheet");
  builder.place("sheet", sheet(false), builder.diffuse("grey", glm::vec3(0.5f)));
  const Scene scene = builder.finish();
  const PosedScene posed = pose(scene, 0.0f);
  for (const bool background : {true, false}) {
    ReferenceOptions options = onePixel(0);
    options.background = background;
    options.environment_order = 2;  // its pixels are drawn, whatever shines
    const Integrator integrator(scene, posed, lookingAt({0.0f, 1.0f, 0.0f}, {0.0f, 2.0f, 0.3f}),
                                uniformSky({3.0f, 2.0f, 1.0f}), options, {});
    const CameraPoint point = integrator.look(0, 0);
    EXPECT_EQ(point.instance, kNone);
    EXPECT_EQ(point.eye_depth, 0.0f);
    std::size_t rays = 0;
    const PathLight light = integrator.trace(point, 0, 0, 0, 0, rays);
    EXPECT_EQ(rays, 0u);
    EXPECT_NEAR(light[kSeen].r, background ? 3.0f : 0.0f, 1e-6f);
    EXPECT_EQ(light[kEnvironmentDirect].r, 0.0f);
    EXPECT_EQ(integrator.has(kSeen), background);
  }
}

// Emitters without area, with a black texture, in a mask's holes: nothing, and no harm.
TEST(Emitters, OddOnesAreHarmless) {
  SceneBuilder builder("odd");
  builder.place("floor", sheet(false), builder.diffuse("grey", glm::vec3(0.5f)));
  const auto shining = [&] {
    const int material = builder.diffuse("light", glm::vec3(0.0f));
    builder.material(material).emission = glm::vec3(5.0f);
    return material;
  };
  Mesh line;
  line.positions = {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  line.normals.assign(3, {0, 1, 0});
  line.indices = {0, 1, 2, 0, 0, 0};
  builder.place("line", line, shining());
  builder.place("empty", Mesh{}, shining());
  const int black = shining();
  builder.material(black).emission_map.texture = builder.texture({"", 1, 1, {0, 0, 0, 255}});
  builder.place("black", sheet(false), black, {0, 2, 0});
  const int hole = shining();
  builder.material(hole).alpha_mask = true;
  builder.material(hole).base_color.a = 0.1f;
  builder.place("hole", sheet(false), hole, {0, 1.5f, 0});
  const Scene scene = builder.finish();
  const Estimate e = estimate(scene, lookingAt({1.0f, 1.0f, 0.5f}, glm::vec3(0.0f)), {}, onePixel(2), 256);
  EXPECT_EQ(e.mean, 0.0);
}

// Half of a lamp's texture shines: half of its light.
TEST(Emitters, TexturesShine) {
  const auto light = [](bool textured) {
    SceneBuilder builder("lit");
    builder.place("floor", sheet(false), builder.diffuse("grey", glm::vec3(0.5f)));
    const int material = builder.diffuse("light", glm::vec3(0.0f));
    builder.material(material).emission = glm::vec3(2.0f);
    const int stripes = builder.texture({"", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
    if (textured) {
      builder.material(material).emission_map.texture = stripes;
      builder.material(material).emission_map.nearest = true;
      builder.place("lamp", shapes::withUvScale(sheet(false), glm::vec2(64.0f)), material,
                    {0.0f, 1.0f, 0.0f});
    } else {
      builder.place("lamp", sheet(false), material, {0.0f, 1.0f, 0.0f});
    }
    return estimate(builder.finish(), lookingAt({1.0f, 0.5f, 0.5f}, glm::vec3(0.0f)), {}, onePixel(0), 16384);
  };
  expectTruth(light(true), 0.5 * light(false).mean, 3e-3);
}

}  // namespace
}  // namespace gloam::reference
