// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of glossy transfer (PRT-2, PRT-8): on transfer that is known in closed form.
#include <gloam/bake.h>

#include "golden.h"
#include "math/brdf.h"
#include "math/sh_high_order.h"
#include "scene/environment.h"
#include "techniques/prt/prt_test_frame.h"

namespace gloam::prt {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

Picture draw(const Scene& scene, const Settings& settings = prt::settings(), std::size_t chunk_bytes = 0) {
  return prt::draw(scene, kSize, pose(scene, 0.0f).cameras.at(0), settings, chunk_bytes);
}

/// A sphere of pure metal under a sky, seen by a camera so far off that all its rays are nearly parallel.
Scene metalScene(float exponent, const glm::mat4& placed = glm::mat4(1.0f)) {
  Scene scene = loadScene("builtin:furnace");
  scene.nodes[0].matrix = placed;
  for (Material& material : scene.materials) {
    material.base_color = glm::vec4(0.9f, 0.6f, 0.3f, 1.0f);
    material.metallic = 1.0f;
    material.roughness = std::pow(2.0f / (exponent + 2.0f), 0.25f);
  }
  scene.environment = loadEnvironment("sky:preetham?elevation=25");
  return scene;
}

/// Transfer of vertices whose visibility is `value` everywhere (the light arrives as it is, times that); with
/// `interreflected` also a third, half and all of it, by colour. Diffuse transfer is none.
void addTransfer(Scene& scene, int light_order, int field_order, bool interreflected = false,
                 float exponent = 0.0f) {
  for (Mesh& mesh : scene.meshes) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = 3;
    transfer->direct.assign(mesh.vertexCount() * 9, 0.0f);
    GlossyTransfer& glossy = transfer->glossy;
    glossy.light_order = light_order;
    glossy.field_order = field_order;
    glossy.exponent = exponent;
    glossy.visibility.assign(mesh.vertexCount() * glossy.visibilityCount(), 0.0f);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
      glossy.visibility[v * glossy.visibilityCount()] = std::sqrt(4.0f * kPi);
    if (interreflected) {
      transfer->indirect.assign(mesh.vertexCount() * 27, 0.0f);
      transfer->bounces = 1;
      glossy.indirect.assign(mesh.vertexCount() * glossy.matrixCount() * 3, 0.0f);
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        for (int j = 0; j < light_order * light_order; ++j) {
          const std::size_t e = v * glossy.matrixCount() + std::size_t(j * light_order * light_order + j);
          const float factor =
              exponent > 0.0f ? brdf::phongBandFactor(int(std::sqrt(float(j) + 0.5f)), exponent) : 1.0f;
          for (std::size_t c = 0; c < 3; ++c)
            glossy.indirect[e * 3 + c] = factor * (c == 0 ? 1.0f / 3 : c == 1 ? 0.5f : 1.0f);
        }
      }
    }
    mesh.transfer = transfer;
  }
}

glm::vec3 toEye(const Picture& picture, int x, int y) {
  const float tangent = std::tan(0.5f * picture.camera.camera.vertical_fov_rad);
  const glm::vec3 view((2.0f * (float(x) + 0.5f) / kSize - 1.0f) * tangent,
                       (1.0f - 2.0f * (float(y) + 0.5f) / kSize) * tangent, -1.0f);
  return -glm::normalize(glm::mat3(picture.camera.world_from_view) * view);
}

/// Covered pixels against the lobe under the light, truncated to so many bands, in closed form.
void expectLobe(const Picture& picture, const Scene& scene, int order, float exponent,
                float tolerance = 0.006f) {
  const sh::ShRgb light = projectEnvironment(scene.environment, order);
  const glm::vec3 specular(scene.materials[0].base_color);
  int covered = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t i = std::size_t(y) * kSize + std::size_t(x);
      if (picture.ids[i].x == 0) continue;
      ++covered;
      const glm::vec3 normal = glm::normalize(
          glm::vec3(picture.normal[4 * i], picture.normal[4 * i + 1], picture.normal[4 * i + 2]));
      const glm::vec3 mirror = brdf::mirrorDirection(normal, toEye(picture, x, y));
      const glm::vec3 want = specular * glm::max(brdf::shadePhong(light, mirror, exponent), 0.0f);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(picture.direct[4 * i + std::size_t(c)], want[c], tolerance * (want[c] + 1.0f))
            << x << ' ' << y;
    }
  }
  EXPECT_GT(covered, 300);
}

TEST(PrtGlossy, OpenVisibilityShowsTheLightThroughTheLobe) {
  for (const auto& [order, exponent] : {std::pair(3, 2.0f), {4, 3.0f}, {5, 6.0f}, {6, 9.0f}}) {
    Scene scene = metalScene(exponent);
    addTransfer(scene, order, order);
    expectLobe(draw(scene), scene, order, exponent);
  }
}

// The exponent is the material's at run time; sharper ones than the bands show are clamped.
TEST(PrtGlossy, ExponentsAreChosenAtRunTime) {
  for (const float exponent : {1.0f, 3.0f, 200.0f}) {
    Scene scene = metalScene(exponent);
    addTransfer(scene, 5, 5);
    expectLobe(draw(scene), scene, 5, std::min(exponent, kSharpestLobe[5]));
  }
}

TEST(PrtGlossy, FewerBandsOfLightThanOfRadiance) {
  Scene scene = metalScene(5.0f);
  addTransfer(scene, 3, 5);
  expectLobe(draw(scene), scene, 3, 5.0f);
}

TEST(PrtGlossy, ObjectsTurnUnderTheLight) {
  for (const glm::vec3& scale : {glm::vec3(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f)}) {
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 2.0f, glm::normalize(glm::vec3(1, 2, -0.5f)));
    Scene scene = metalScene(6.0f, glm::scale(turned, scale));
    addTransfer(scene, 5, 5);
    expectLobe(draw(scene), scene, 5, 6.0f);
  }
}

TEST(PrtGlossy, CheapOptionsHalvesAndChunksShowTheSame) {
  Scene scene = metalScene(6.0f);
  addTransfer(scene, 5, 5, true);
  const Picture whole = draw(scene);
  expectLobe(draw(scene, settings({{"glossy", "cheap"}})), scene, 5, 6.0f);
  expectLobe(draw(scene, settings({{"half_float", "on"}})), scene, 5, 6.0f, 0.01f);
  expectLobe(draw(scene, settings({{"order", "4"}})), scene, 4, 3.0f);
  const Picture cut = draw(scene, settings(), 2000000);
  EXPECT_EQ(whole.direct, cut.direct);
  EXPECT_EQ(whole.indirect, cut.indirect);
}

// Matrices that are nothing in particular: what they make of light is the same by the host and by the device.
TEST(PrtGlossy, HostAndDeviceAgree) {
  for (const auto& [light_order, exponent] : {std::pair(3, 0.0f), {5, 0.0f}, {5, 4.0f}}) {
    Scene scene = metalScene(6.0f);
    addTransfer(scene, light_order, 5, true, exponent);
    auto uneven = std::make_shared<Transfer>(*scene.meshes[0].transfer);
    for (std::vector<float>* values : {&uneven->glossy.visibility, &uneven->glossy.indirect})
      for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] += 0.05f * float(std::sin(double(i)));
    scene.meshes[0].transfer = uneven;
    for (const Values& more : {Values{}, {{"half_float", "on"}}, {{"glossy", "cheap"}}}) {
      Settings host = settings(more), device = host;
      host.set("relight", "host");
      device.set("relight", "device");
      const Picture a = draw(scene, host), b = draw(scene, device);
      for (std::size_t i = 0; i < a.direct.size(); ++i) {
        ASSERT_NEAR(a.direct[i], b.direct[i], 2e-3f * (1.0f + b.direct[i]));
        ASSERT_NEAR(a.indirect[i], b.indirect[i], 2e-3f * (1.0f + b.indirect[i]));
      }
    }
  }
}

// What the host keeps from frame to frame is of this light on these objects.
TEST(PrtGlossy, WhatIsKeptFollowsObjects) {
  Scene scene = metalScene(6.0f);
  addTransfer(scene, 5, 5);
  const PosedScene as_it_was = pose(scene, 0.0f);
  PosedScene turned = as_it_was;
  turned.instances[0].world_from_object = glm::rotate(glm::mat4(1.0f), 2.0f, glm::vec3(0, 1, 0));
  const Settings values = settings({{"relight", "host"}});
  frame::TestFrame frame(scene);
  Prt technique(gpu::testDevice());
  const auto drawn = [&](Prt& by, const PosedScene& posed) {
    return frame
        .draw(posed, as_it_was.cameras.at(0), {.width = kSize, .height = kSize},
              [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                return by.record(graph, inputs, values);
              })
        .direct.image()
        .downloadFloats();
  };
  const std::vector<float> first = drawn(technique, as_it_was);
  EXPECT_EQ(drawn(technique, as_it_was), first);
  const std::vector<float> after = drawn(technique, turned);
  Prt fresh(gpu::testDevice());
  EXPECT_EQ(after, drawn(fresh, turned));
  EXPECT_NE(after, first);
}

TEST(PrtGlossy, DirectAndIndirectStayApart) {
  Scene scene = metalScene(6.0f);
  for (const char* half : {"off", "on"}) {
    addTransfer(scene, 5, 5, true);
    const Picture picture = draw(scene, settings({{"half_float", half}}));
    for (std::size_t i = 0; i < picture.ids.size(); ++i) {
      if (picture.ids[i].x == 0) continue;
      const float* direct = &picture.direct[4 * i];
      const float* indirect = &picture.indirect[4 * i];
      ASSERT_NEAR(indirect[0], direct[0] / 3, 4e-3f * direct[0] + 1e-3f);
      ASSERT_NEAR(indirect[1], direct[1] / 2, 4e-3f * direct[1] + 1e-3f);
      ASSERT_NEAR(indirect[2], direct[2], 4e-3f * direct[2] + 1e-3f);
    }
  }
  const Picture without = draw(scene, settings({{"indirect", "off"}}));
  EXPECT_EQ(*std::max_element(without.indirect.begin(), without.indirect.end()), 0.0f);
}

// A lobe that is baked in does not follow the material.
TEST(PrtGlossy, BakedLobesStay) {
  Scene scene = metalScene(200.0f);
  addTransfer(scene, 5, 5, true, 4.0f);
  const Picture picture = draw(scene);
  expectLobe(picture, scene, 5, 4.0f);
  for (std::size_t i = 0; i < picture.ids.size(); ++i) {
    if (picture.ids[i].x == 0) continue;
    ASSERT_NEAR(picture.indirect[4 * i + 2], picture.direct[4 * i + 2],
                4e-3f * picture.direct[4 * i + 2] + 1e-3f);
  }
}

// Lobes that ring below zero are made blunter; the others stay as they are.
TEST(PrtGlossy, RingingIsDampedWhereItShows) {
  Scene scene = metalScene(10.0f);
  scene.environment = loadEnvironment("sky:studio");
  addTransfer(scene, 5, 5, true);
  const Picture none = draw(scene), damped = draw(scene, settings({{"window", "auto"}}));
  int black = 0, same = 0, covered = 0;
  for (std::size_t i = 0; i < none.ids.size(); ++i) {
    if (none.ids[i].x == 0) continue;
    ++covered;
    const float *before = &none.direct[4 * i], *after = &damped.direct[4 * i];
    black += std::min({before[0], before[1], before[2]}) == 0.0f;
    same += std::abs(before[1] - after[1]) <= 1e-3f * before[1];
    ASSERT_GT(std::min({after[0], after[1], after[2]}), 0.0f);
  }
  EXPECT_GT(black, covered / 20);
  EXPECT_GT(same, covered / 3);
}

// What has none keeps the unshadowed lobe of frame/; so does all with glossy=unshadowed.
TEST(PrtGlossy, WhatHasNoMatricesKeepsTheUnshadowedLobe) {
  Scene scene = metalScene(6.0f);
  addTransfer(scene, 5, 5);
  const Picture unshadowed = draw(scene, settings({{"glossy", "unshadowed"}}));
  Mesh mover = scene.meshes[0];
  auto diffuse_only = std::make_shared<Transfer>(*mover.transfer);
  diffuse_only->glossy = {};
  mover.transfer = diffuse_only;
  scene.meshes.push_back(mover);
  scene.nodes[0].matrix = glm::translate(glm::mat4(1.0f), glm::vec3(50, 0, 0));  // out of sight
  scene.nodes.push_back({.name = "mover", .meshes = {1}});
  scene.roots.push_back(int(scene.nodes.size()) - 1);
  const Picture picture = draw(scene);
  for (std::size_t i = 0; i < picture.direct.size(); ++i)
    ASSERT_NEAR(picture.direct[i], unshadowed.direct[i], 2e-3f * (1.0f + unshadowed.direct[i]));
}

TEST(PrtGlossy, SaysWhatItCannotUse) {
  Scene scene = metalScene(6.0f);
  scene.meshes[0].name = "vase";
  const auto complaintAfter = [&](const std::function<void(GlossyTransfer&)>& breakIt) {
    addTransfer(scene, 4, 4);
    auto broken = std::make_shared<Transfer>(*scene.meshes[0].transfer);
    breakIt(broken->glossy);
    scene.meshes[0].transfer = broken;
    return gpu::errorOf([&] { draw(scene); });
  };
  EXPECT_NE(complaintAfter([](GlossyTransfer& g) {
              g.visibility.pop_back();
            }).find("mesh 'vase': glossy transfer from 4 to 4 bands for"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](GlossyTransfer& g) { g.indirect.resize(5); }).find("and 5"), std::string::npos);
  EXPECT_NE(complaintAfter([](GlossyTransfer& g) { g.field_order = 3; }).find("from 4 to 3 bands"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](GlossyTransfer& g) { g.field_order = 9; }).find("to 9 bands"),
            std::string::npos);
}

// Metal spheres that stand on a glossy floor: they darken where they touch, and show each other.
TEST(PrtGlossyByPicture, Golden) {
  Scene scene = loadScene("builtin:spheres?detail=0.3");
  for (Material& material : scene.materials) {
    material.metallic = 0.9f;
    material.roughness = 0.64f;
  }
  const Scene baked = bakeTransfer(scene, {.order = 5,
                                           .bounces = 1,
                                           .directions = 1024,
                                           .bounce_directions = 256,
                                           .glossy = GlossyMeshes::kShiny,
                                           .glossy_light_order = 3});
  frame::TestFrame frame(baked);
  Prt technique(gpu::testDevice());
  const PosedScene posed = pose(baked, 0.0f);
  const Settings values = settings({{"window", "auto"}});
  const frame::FrameImages images =
      frame.draw(posed, posed.cameras.at(0), {.width = 96, .height = 96, .supersample = 2},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, values);
                 });
  Image image(96, 96, 4);
  image.pixels = images.color.image().downloadFloats();
  EXPECT_EQ(test::compareWithGolden(toneMapped(image, {}), "prt_glossy", {.max_difference = 3}), "");
}

}  // namespace
}  // namespace gloam::prt
