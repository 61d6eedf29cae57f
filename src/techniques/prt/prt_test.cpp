// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of transfer: against light on transfer that is known in closed form, and bakes by picture.
#include "techniques/prt/prt.h"

#include <gloam/bake.h>

#include <array>
#include <glm/gtc/constants.hpp>
#include <ranges>

#include "golden.h"
#include "math/sh_light_parts.h"
#include "scene/environment.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_test_frame.h"

namespace gloam::prt {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

Picture draw(const Scene& scene, const Settings& settings = prt::settings(), std::size_t chunk_bytes = 0) {
  return prt::draw(scene, kSize, pose(scene, 0.0f).cameras.at(0), settings, chunk_bytes);
}

/// Unshadowed transfer of every vertex, in closed form; the interreflected part is a third, half and all of
/// it.
void addTransfer(Scene& scene, int order, bool indirect = false) {
  for (Mesh& mesh : scene.meshes) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = order;
    for (const glm::vec3& n : mesh.normals) {
      const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(order), n);
      for (const float value : cosine.coefficients()) {
        transfer->direct.push_back(value);
        if (indirect) transfer->indirect.insert(transfer->indirect.end(), {value / 3, value / 2, value});
      }
    }
    mesh.transfer = transfer;
  }
}

Scene skyScene(const glm::mat4& placed = glm::mat4(1.0f)) {
  Scene scene = loadScene("builtin:furnace");
  scene.nodes[0].matrix = placed;
  scene.environment = loadEnvironment("sky:preetham?elevation=25");
  return scene;
}

/// Direct light of all covered pixels against the irradiance at their normals.
void expectIrradiance(const Picture& picture, const sh::ShRgb& light, float tolerance) {
  int covered = 0;
  for (std::size_t i = 0; i < picture.ids.size(); ++i) {
    if (picture.ids[i].x == 0) continue;
    ++covered;
    const glm::vec3 normal(picture.normal[4 * i], picture.normal[4 * i + 1], picture.normal[4 * i + 2]);
    const glm::vec3 want = sh::irradiance(light, glm::normalize(normal)) / kPi;
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.direct[4 * i + std::size_t(c)], std::max(want[c], 0.0f),
                  tolerance * std::abs(want[c]) + tolerance);
  }
  EXPECT_GT(covered, 300);
}

TEST(Prt, UnshadowedTransferIsIrradiance) {
  Scene scene = skyScene();
  const sh::ShRgb light = projectEnvironment(scene.environment, 6);
  for (int order = 3; order <= 6; ++order) {
    addTransfer(scene, order);
    expectIrradiance(draw(scene), sh::truncated(light, order), 0.004f);
  }
  expectIrradiance(draw(scene, settings({{"order", "4"}})), sh::truncated(light, 4), 0.004f);  // of 6 baked
}

// Receivers that see the light through a narrow opening show how it rings: a sun that is below 0 there takes nothing from
// the sky. Light that does not ring stays one.
TEST(Prt, RingingIsDampedWhereItShows) {
  Scene scene = skyScene();
  for (Mesh& mesh : scene.meshes) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = 5;
    for (const glm::vec3& n : mesh.normals) {
      const sh::Sh narrow = sh::evaluate(5, n);
      transfer->direct.insert(transfer->direct.end(), narrow.c.begin(), narrow.c.begin() + narrow.size());
    }
    mesh.transfer = transfer;
  }
  const sh::LightParts parts = sh::lightParts(projectEnvironment(scene.environment, 6), 5);
  const sh::ShRgb peak = sh::colored(sh::directionalLight(5, parts.direction), parts.peak);
  ASSERT_GT(parts.peak.g, 0.0f) << "this light has no peak; choose another";
  const Picture none = draw(scene, settings({{"window", "none"}})),
                got = draw(scene, settings({{"window", "auto"}}));
  const float slack = 0.02f * *std::max_element(none.direct.begin(), none.direct.end());  // between vertices
  int mended = 0;
  for (std::size_t i = 0; i < none.ids.size(); ++i) {
    if (none.ids[i].x == 0) continue;
    const glm::vec3 n =
        glm::normalize(glm::vec3(none.normal[4 * i], none.normal[4 * i + 1], none.normal[4 * i + 2]));
    const glm::vec3 want = (glm::max(sh::valueAt(parts.rest, n), glm::vec3(0.0f)) +
                            glm::max(sh::valueAt(peak, n), glm::vec3(0.0f))) /
                           kPi;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(got.direct[4 * i + std::size_t(c)], want[c], slack);
      EXPECT_GE(got.direct[4 * i + std::size_t(c)], none.direct[4 * i + std::size_t(c)] - slack);
    }
    mended += none.direct[4 * i] == 0.0f && got.direct[4 * i] > 0.0f ? 1 : 0;
  }
  EXPECT_GT(mended, 50) << "this light does not ring; choose another";
  scene.environment = loadEnvironment("sky:overcast");
  EXPECT_EQ(draw(scene, settings({{"window", "auto"}})).direct, draw(scene).direct);
}

// The light is turned into the object's axes; also where the object is mirrored.
TEST(Prt, ObjectsTurnUnderTheLight) {
  for (const glm::vec3& scale : {glm::vec3(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f), glm::vec3(0.7f)}) {
    glm::mat4 placed = glm::rotate(glm::mat4(1.0f), 2.0f, glm::normalize(glm::vec3(1, 2, -0.5f)));
    placed = glm::scale(placed, scale);
    Scene scene = skyScene(placed);
    addTransfer(scene, 5);
    expectIrradiance(draw(scene), projectEnvironment(scene.environment, 5), 0.004f);
  }
}

TEST(Prt, InstancesOfOneMeshHaveTheirOwnLight) {
  Scene scene =
      skyScene(glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(-0.6f, 0, 0)), glm::vec3(0.5f)));
  Node second = scene.nodes[0];
  second.matrix =
      glm::rotate(glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0.6f, 0, 0)), glm::vec3(0.5f)), 1.0f,
                  glm::vec3(0.6f, 0, 0.8f));
  scene.roots.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(second);
  addTransfer(scene, 4);
  const Picture picture = draw(scene);
  expectIrradiance(picture, projectEnvironment(scene.environment, 4), 0.004f);
  EXPECT_TRUE(
      std::any_of(picture.ids.begin(), picture.ids.end(), [](const glm::uvec2& id) { return id.x == 2; }));
}

TEST(Prt, DirectAndIndirectStayApart) {
  Scene scene = skyScene();
  addTransfer(scene, 5, true);
  const Picture picture = draw(scene);
  for (std::size_t i = 0; i < picture.ids.size(); ++i) {
    const float* direct = &picture.direct[4 * i];
    const float* indirect = &picture.indirect[4 * i];
    if (picture.ids[i].x == 0) continue;
    ASSERT_NEAR(indirect[0], direct[0] / 3, 2e-3f * direct[0]);
    ASSERT_NEAR(indirect[1], direct[1] / 2, 2e-3f * direct[1]);
    ASSERT_NEAR(indirect[2], direct[2], 2e-3f * direct[2]);
  }
  const Picture without = draw(scene, settings({{"indirect", "off"}}));
  EXPECT_EQ(*std::max_element(without.indirect.begin(), without.indirect.end()), 0.0f);
}

TEST(Prt, HalvesAreNearlyFloats) {
  Scene scene = skyScene();
  addTransfer(scene, 5, true);
  const Picture floats = draw(scene), halves = draw(scene, settings({{"half_float", "on"}}));
  for (std::size_t i = 0; i < floats.direct.size(); ++i) {
    ASSERT_NEAR(halves.direct[i], floats.direct[i], 3e-3f * floats.direct[i] + 1e-4f);
    ASSERT_NEAR(halves.indirect[i], floats.indirect[i], 3e-3f * floats.indirect[i] + 1e-4f);
  }
}

// Transfer that does not fit into one buffer is cut; the picture is the same to the bit.
TEST(Prt, ChunksGiveTheSamePicture) {
  Scene scene = skyScene();
  addTransfer(scene, 5, true);
  const PosedScene posed = pose(scene, 0.0f);
  constexpr std::size_t kChunkBytes = 200000;
  frame::TestFrame frame(scene);
  frame.graph.begin();
  frame.gpu_scene.pose(frame.graph, posed);
  const TransferBuffers transfer(gpu::testDevice(), frame.gpu_scene, {.chunk_bytes = kChunkBytes});
  EXPECT_GT(transfer.chunks().size(), 3u);
  std::size_t vertices = 0;
  for (const TransferChunk& chunk : transfer.chunks()) {
    EXPECT_LE(std::max(chunk.direct.bytes(), chunk.indirect.bytes()), kChunkBytes);
    for (const VertexBlock& block : chunk.blocks.download<VertexBlock>()) vertices += block.count;
  }
  EXPECT_EQ(vertices, scene.meshes[0].vertexCount());

  const Picture whole = draw(scene), cut = draw(scene, settings(), kChunkBytes);
  EXPECT_EQ(whole.direct, cut.direct);
  EXPECT_EQ(whole.indirect, cut.indirect);
}

/// Transfer that is linear over the second set of texture coordinates, at vertices or at texels' middles: the same picture.
void addLinearTransfer(Scene& scene, int width, int height) {
  for (Mesh& mesh : scene.meshes) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = 3;
    transfer->bounces = 1;
    const auto add = [&](const glm::vec2& uv) {
      for (int i = 0; i < 9; ++i) {
        const float value = i == 0 ? 0.3f + uv.x + 0.5f * uv.y : 0.0f;
        transfer->direct.push_back(value);
        transfer->indirect.insert(transfer->indirect.end(), {0.2f * value, i == 0 ? uv.x : 0.0f, 0.0f});
      }
    };
    const bool texels = width > 0 && mesh.uv_sets.size() > 1;
    if (texels) {
      transfer->texel_width = width;
      transfer->texel_height = height;
      transfer->uv_set = 1;
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
          add((glm::vec2(float(x), float(y)) + 0.5f) / glm::vec2(float(width), float(height)));
      }
    } else {
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
        add(mesh.uv_sets.size() > 1 ? mesh.uv_sets[1][v] : glm::vec2(0.5f));
    }
    mesh.transfer = transfer;
  }
}

TEST(PrtTexels, BilinearBetweenTexels) {
  Scene scene = loadScene("builtin:gallery?detail=0.25");
  scene.environment = loadEnvironment("sky:uniform");
  addLinearTransfer(scene, 0, 0);
  const Picture vertices = draw(scene);
  for (const char* half : {"off", "on"}) {
    addLinearTransfer(scene, 96, 50);
    const Picture texels = draw(scene, settings({{"half_float", half}}), half[1] == 'n' ? 0 : 100000);
    float most = 0.0f, range = 0.0f;
    for (std::size_t i = 0; i < vertices.direct.size(); ++i) {
      if (i % 4 == 3) continue;
      most = std::max(most, std::abs(texels.direct[i] - vertices.direct[i]));
      most = std::max(most, std::abs(texels.indirect[i] - vertices.indirect[i]));
      range = std::max(range, vertices.direct[i]);
    }
    EXPECT_GT(range, 0.8f);
    // Half a texel from the edge of a map the last texel goes on.
    EXPECT_LT(most, 0.02f) << half;
  }
}

TEST(PrtTexels, SaysWhatDoesNotFit) {
  Scene scene = loadScene("builtin:gallery?detail=0.25");
  addLinearTransfer(scene, 8, 8);
  scene.meshes[0].uv_sets.resize(1);
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("mesh 'floor': transfer of texels"), std::string::npos);
  addLinearTransfer(scene, 8, 8);
  auto broken = std::make_shared<Transfer>(*scene.meshes[1].transfer);
  broken->texel_width = 9;
  scene.meshes[1].transfer = broken;
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("for 72 texels needs 648 values"), std::string::npos);
}

// Soft shadows on walls of two triangles each: against vertices that are many.
TEST(PrtTexels, WallsOfTwoTrianglesShowShadows) {
  const auto sceneWith = [](int cells) {
    Scene scene;
    scene.materials.push_back({.metallic = 0.0f, .specular = 0.0f});
    Mesh floor;
    for (int z = 0; z <= cells; ++z) {
      for (int x = 0; x <= cells; ++x) {
        const glm::vec2 uv = glm::vec2(float(x), float(z)) / float(cells);
        floor.positions.push_back({4.0f * uv.x - 2.0f, 0.0f, 4.0f * uv.y - 2.0f});
        floor.normals.push_back({0, 1, 0});
        floor.uv_sets.resize(2);
        floor.uv_sets[0].push_back(uv), floor.uv_sets[1].push_back(uv);
        if (x == cells || z == cells) continue;
        const auto i = std::uint32_t(z * (cells + 1) + x), below = i + std::uint32_t(cells) + 1;
        floor.indices.insert(floor.indices.end(), {i, below, below + 1, i, below + 1, i + 1});
      }
    }
    Mesh plate;  // looks down, 0.6 m above
    plate.positions = {{-0.5f, 0.6f, -0.4f}, {0.7f, 0.6f, -0.4f}, {0.7f, 0.6f, 0.3f}, {-0.5f, 0.6f, 0.3f}};
    plate.normals.assign(4, {0, -1, 0});
    plate.indices = {0, 1, 2, 0, 2, 3};
    for (Mesh& mesh :
         std::array{&floor, &plate} | std::views::transform([](Mesh* m) -> Mesh& { return *m; })) {
      scene.nodes.push_back({.meshes = {int(scene.meshes.size())}});
      scene.roots.push_back(int(scene.meshes.size()));
      scene.meshes.push_back(mesh);
    }
    Node eye;
    eye.translation = {0, 5, 0};
    eye.rotation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0));
    eye.camera = 0;
    scene.cameras.push_back({});
    scene.roots.push_back(int(scene.nodes.size()));
    scene.nodes.push_back(eye);
    scene.environment = loadEnvironment("sky:uniform");
    return scene;
  };
  BakeOptions options{.kind = TransferKind::kShadowed, .order = 4, .directions = 1024};
  const Picture fine = draw(bakeTransfer(sceneWith(64), options));
  const Picture two = draw(bakeTransfer(sceneWith(1), options));
  options.texels = 64;
  const Picture texels = draw(bakeTransfer(sceneWith(1), options));
  const auto error = [&](const Picture& picture) {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < picture.direct.size(); i += 4) {
      if (fine.ids[i / 4].x != 1) continue;
      sum += std::pow(double(picture.direct[i] - fine.direct[i]), 2.0),
          all += std::pow(double(fine.direct[i]), 2.0);
    }
    return std::sqrt(sum / all);
  };
  EXPECT_GT(error(two), 0.04);
  EXPECT_LT(error(texels), 0.01);
}

// One technique object serves one scene after another.
TEST(Prt, ForgetsTheSceneBefore) {
  Prt technique(gpu::testDevice());
  const Settings values = settings();
  std::vector<std::vector<float>> pictures;
  for (const float tilt : {0.0f, 1.0f, 0.0f}) {
    Scene scene = skyScene();
    for (Mesh& mesh : scene.meshes) {
      for (glm::vec3& n : mesh.normals) n = glm::normalize(n + glm::vec3(0, tilt, 0));
    }
    addTransfer(scene, 4);
    frame::TestFrame frame(scene);
    const PosedScene posed = pose(scene, 0.0f);
    const auto images = frame.draw(posed, posed.cameras.at(0), {.width = kSize, .height = kSize},
                                   [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                                     return technique.record(graph, inputs, values);
                                   });
    pictures.push_back(images.direct.image().downloadFloats());
  }
  EXPECT_NE(pictures[0], pictures[1]);
  EXPECT_EQ(pictures[0], pictures[2]);
}

TEST(Prt, WhatIsNotBakedIsLitWithoutShadows) {
  Scene scene = skyScene();
  addTransfer(scene, 5);
  Mesh mover = scene.meshes[0];
  mover.name = "mover";
  mover.transfer = nullptr;
  scene.meshes.push_back(mover);
  scene.nodes[0].matrix = glm::translate(glm::mat4(1.0f), glm::vec3(50, 0, 0));  // out of sight
  scene.nodes.push_back({.name = "mover", .meshes = {1}});
  scene.roots.push_back(int(scene.nodes.size()) - 1);
  const Picture picture = draw(scene);
  expectIrradiance(picture, projectEnvironment(scene.environment, 5), 0.004f);
  ASSERT_EQ(picture.warnings.size(), 1u);
  EXPECT_NE(picture.warnings[0].find("mover"), std::string::npos);
}

TEST(Prt, SaysWhatItCannotDo) {
  Scene scene = skyScene();
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("gloam bake"), std::string::npos);
  addTransfer(scene, 4);
  EXPECT_TRUE(draw(scene, settings({{"order", "4"}})).warnings.empty());
  EXPECT_EQ(draw(scene, settings({{"order", "5"}})).warnings,
            Warnings{"prt.order 5: the scene is baked with 4 bands"});
  auto broken = std::make_shared<Transfer>(*scene.meshes[0].transfer);
  broken->direct.pop_back();
  scene.meshes[0].name = "vase";
  scene.meshes[0].transfer = broken;
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("mesh 'vase': transfer of order 4"), std::string::npos);
  broken = std::make_shared<Transfer>();
  broken->order = 9;
  scene.meshes[0].transfer = broken;
  EXPECT_NE(gpu::errorOf([&] { draw(scene); }).find("order 9"), std::string::npos);
}

/// Mean of a channel over the covered pixels that are not at an edge.
float meanInside(const std::vector<float>& rgba, const std::vector<glm::uvec2>& ids,
                 float* worst_from_one = nullptr) {
  double sum = 0.0;
  int count = 0;
  for (int y = 1; y + 1 < kSize; ++y) {
    for (int x = 1; x + 1 < kSize; ++x) {
      const auto at = [&](int dx, int dy) {
        return ids[std::size_t(y + dy) * kSize + std::size_t(x + dx)].x;
      };
      if (at(0, 0) == 0 || at(1, 0) == 0 || at(-1, 0) == 0 || at(0, 1) == 0 || at(0, -1) == 0) continue;
      const float value = rgba[4 * (std::size_t(y) * kSize + std::size_t(x))];
      sum += value;
      ++count;
      if (worst_from_one) *worst_from_one = std::max(*worst_from_one, std::abs(value - 1.0f));
    }
  }
  return float(sum / count);
}

TEST(PrtByPicture, ConvexWhiteBodyInTheWhiteFurnaceIsOne) {
  const Scene baked = bakeTransfer(loadScene("builtin:furnace?detail=0.5"),
                                   {.kind = TransferKind::kShadowed, .order = 5, .directions = 2048});
  const Picture picture = draw(baked);
  float worst = 0.0f;
  meanInside(picture.direct, picture.ids, &worst);
  EXPECT_LT(worst, 0.002f);
}

// An open bowl of albedo 1/2 that covers half its sphere: direct rho (1 - a) = 1/4, with all bounces rho (1 -
// a) / (1 - rho a) = 1/3; bounce b adds rho (1 - a) (rho a)^b.
TEST(PrtByPicture, BowlHasItsPartialSums) {
  const Scene bowl = loadScene("builtin:bowl?coverage=0.5&albedo=0.5&detail=0.5");
  const Scene baked =
      bakeTransfer(bowl, {.order = 4, .bounces = 2, .directions = 4096, .bounce_directions = 2048});
  const Picture picture = draw(baked);
  EXPECT_NEAR(meanInside(picture.direct, picture.ids), 0.25f, 0.0025f);
  EXPECT_NEAR(meanInside(picture.indirect, picture.ids), 0.25f * (0.25f + 0.0625f), 0.01f * 0.33f);
}

TEST(PrtByPicture, Golden) {
  const Scene baked = bakeTransfer(loadScene("builtin:shadow?detail=0.4"),
                                   {.order = 5, .bounces = 1, .directions = 1024, .bounce_directions = 512});
  frame::TestFrame frame(baked);
  Prt technique(gpu::testDevice());
  const PosedScene posed = pose(baked, 0.0f);
  const Settings values(info().options);
  const frame::FrameImages images =
      frame.draw(posed, posed.cameras.at(0), {.width = 96, .height = 96, .supersample = 2},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, values);
                 });
  Image image(96, 96, 4);
  image.pixels = images.color.image().downloadFloats();
  EXPECT_EQ(test::compareWithGolden(toneMapped(image, {}), "prt_shadow", {.max_difference = 3}), "");
}

}  // namespace
}  // namespace gloam::prt
