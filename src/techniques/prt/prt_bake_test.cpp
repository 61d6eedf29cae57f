// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Laws of baked transfer on scenes whose answer a person can derive (PRT-1, PRT-3).
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_measures.h"
#include "techniques/prt/prt_bake_test_scenes.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

void expectCosineTransfer(const Mesh& mesh, std::size_t vertex, const glm::vec3& normal, float tolerance) {
  const Transfer& t = *mesh.transfer;
  const sh::Sh expected = sh::rotateZonal(sh::clampedCosine(t.order), normal);
  for (int i = 0; i < t.order * t.order; ++i) {
    EXPECT_NEAR(t.direct[vertex * coefficients(t) + std::size_t(i)], expected[i], tolerance)
        << "coefficient " << i;
  }
}

// Whether triangles use a vertex: those at the poles of a sphere are partly spare.
std::vector<bool> usedVertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertexCount());
  for (const std::uint32_t i : mesh.indices) used[i] = true;
  return used;
}

// ---- Convex bodies: DS = DU = A_l y_l(n) -----------------------------------------------------------------------------

TEST(PrtBake, ConvexBodiesAreUnshadowed) {
  for (const int order : {3, 4, 5, 6}) {
    const Scene baked = bakeTransfer(sceneOf(sphereMesh(8, 16)), shadowed(order, 1024));
    const Mesh& mesh = baked.meshes[0];
    for (std::size_t v = 0; v < mesh.vertexCount(); v += 3)
      expectCosineTransfer(mesh, v, mesh.normals[v], 1e-5f);
  }
  // Corners with one normal a side, and with one smooth normal for three sides.
  for (const bool smooth : {false, true}) {
    const Scene baked = bakeTransfer(sceneOf(boxMesh(glm::vec3(3.0f, 0.01f, 1.0f), smooth)), shadowed());
    const Mesh& mesh = baked.meshes[0];
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
      expectCosineTransfer(mesh, v, mesh.normals[v], 1e-5f);
  }
}

TEST(PrtBake, WhiteFurnaceOfAConvexBodyIsOne) {
  const Scene baked = bakeTransfer(sceneOf(sphereMesh(12, 24)), interreflected(2));
  const std::vector<bool> used = usedVertices(baked.meshes[0]);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) {
      EXPECT_NEAR(brightness(baked.meshes[0], v), 1.0f, 0.002f);
    }
  }
}

TEST(PrtBake, UnshadowedNeedsNoRays) {
  BakeOptions options = shadowed();
  options.kind = TransferKind::kUnshadowed;
  BakeReport report;
  const Scene baked = bakeTransfer(sceneOf(bowlMesh(0.7f, 8, 16)), options, {}, &report);
  EXPECT_EQ(report.rays, 0u);
  const Mesh& mesh = baked.meshes[0];
  const std::vector<bool> used = usedVertices(mesh);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) expectCosineTransfer(mesh, v, mesh.normals[v], 1e-6f);
  }
}

// Coefficients belong to the object's own axes, scale taken out.
TEST(PrtBake, TransferStandsInTheObjectsAxes) {
  const glm::mat3 turned(0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f);
  for (const glm::vec3& scale :
       {glm::vec3(2.0f), glm::vec3(-1.0f, 1.0f, 1.0f), glm::vec3(1.0f, 3.0f, 0.5f)}) {
    const glm::mat3 matrix = turned * glm::mat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z);
    Scene scene = sceneOf(sphereMesh(8, 16));
    scene.nodes[0].matrix = glm::mat4(matrix);
    const Scene baked = bakeTransfer(scene, shadowed(4, 512));
    const Mesh& mesh = baked.meshes[0];
    for (std::size_t v = 0; v < mesh.vertexCount(); v += 5) {
      const glm::vec3 world_normal = glm::normalize(normalTransform(matrix) * mesh.normals[v]);
      expectCosineTransfer(mesh, v, glm::transpose(rotationFactor(matrix)) * world_normal, 2e-5f);
    }
  }
}

// ---- Shadows ---------------------------------------------------------------------------------------------------------

// A wall that subtends the elevation alpha along all of one side of a plane's point blocks (1 - cos alpha) / 2 of its
// irradiance; an endless one blocks a half, whose x coefficient is 0.488603 * 2/3.
TEST(PrtBake, HalfPlaneBlocker) {
  for (const float alpha : {kPi / 2, kPi / 4, kPi / 8}) {
    const float height = alpha > 1.5f ? 1e4f : std::tan(alpha);
    Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}));
    addMesh(scene, quadMesh({1, height / 2, 0}, {0, height / 2, 0}, {0, 0, 1e4f}));
    const Scene baked = bakeTransfer(scene, shadowed(5, 16384));
    const Mesh& plane = baked.meshes[0];
    for (std::size_t v = 0; v < plane.vertexCount(); ++v) {
      const float distance = 1.0f - plane.positions[v].x;
      const float cosine = alpha > 1.5f ? 0.0f : distance / std::hypot(height, distance);
      EXPECT_NEAR(directBrightness(plane, v), (1.0f + cosine) / 2, 0.004f) << alpha;
      if (alpha < 1.5f) continue;
      EXPECT_NEAR(plane.transfer->direct[v * 25 + 3], -0.488603f * 2.0f / 3.0f, 0.004f);
    }
  }
}

TEST(PrtBake, ClosedRoomIsDarkToItsCorners) {
  Mesh room = boxMesh(glm::vec3(2.0f, 1.0f, 3.0f), false);
  turnInsideOut(room);
  for (const bool smooth : {false, true}) {
    if (smooth) {
      room = boxMesh(glm::vec3(2.0f, 1.0f, 3.0f), true);
      turnInsideOut(room);
    }
    const Scene baked = bakeTransfer(sceneOf(room), shadowed());
    for (std::size_t v = 0; v < room.vertexCount(); ++v) {
      EXPECT_NEAR(directBrightness(baked.meshes[0], v), 0.0f, 2e-4f);
    }
  }
}

// In a room nearly every direction meets something: half of them find as many surfaces.
TEST(PrtBake, RoomsTakeFewerBounceDirections) {
  Mesh room = boxMesh(glm::vec3(2.0f, 1.0f, 3.0f), false);
  turnInsideOut(room);
  const auto taken = [](const Scene& scene, int asked, GlossyMeshes glossy = GlossyMeshes::kNone) {
    BakeOptions options = interreflected(1, 3, 4096, asked);
    options.glossy = glossy;
    BakeReport report;
    bakeTransfer(scene, options, {}, &report);
    return report.bounce_directions;
  };
  Scene closed = sceneOf(room), open = sceneOf(gridMesh(1.0f, 4));
  addMesh(open, boxMesh(glm::vec3(0.2f), false));
  EXPECT_EQ(taken(closed, 0), taken(closed, 256));
  EXPECT_EQ(taken(closed, 0, GlossyMeshes::kAll), taken(closed, 1024));
  EXPECT_EQ(taken(open, 0), taken(open, 1024));
  EXPECT_LT(taken(closed, 256), taken(closed, 1024));
}

// A box that stands on a floor, its lower vertices exactly in the floor: they see the floor on one half, the sky on the
// other, whether the box stands on it or reaches through it.
TEST(PrtBake, CreasesAreNeitherBlackNorBright) {
  for (const float sunk : {0.0f, 0.2f}) {
    Scene scene = sceneOf(gridMesh(1000.0f, 8));
    Mesh box = boxMesh(glm::vec3(1.0f), false);
    for (glm::vec3& p : box.positions) p.y += 1.0f - sunk;
    addMesh(scene, box);
    const Scene baked = bakeTransfer(scene, shadowed(3, 10000));
    for (std::size_t v = 0; v < box.vertexCount(); ++v) {
      if (box.normals[v].y < -0.5f) continue;  // lies in the floor or below
      const bool top = box.normals[v].y > 0.5f;
      EXPECT_NEAR(directBrightness(baked.meshes[1], v), top ? 1.0f : 0.5f, top ? 1e-5f : 0.01f) << sunk;
    }
  }
}

// A sheet three millimetres above a floor of two large triangles, whose rays start higher than that.
TEST(PrtBake, ThinGapsDoNotLeak) {
  Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 10}, {10, 0, 0}));
  addMesh(scene, quadMesh({0, 0.003f, 0}, {0, 0, 11}, {11, 0, 0}));
  scene.materials[0].double_sided = true;
  const Scene baked = bakeTransfer(scene, shadowed());
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LT(directBrightness(baked.meshes[0], v), 0.001f);
}

// A room of six closed slabs that touch along their edges and nowhere overlap: no light comes in.
TEST(PrtBake, TouchingBodiesLeakNothing) {
  Scene scene = sceneOf(sphereMesh(8, 16));
  for (glm::vec3& p : scene.meshes[0].positions) p *= 0.3f;
  const float t = 0.05f;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 half(1.0f), middle(0.0f);
      half[axis] = t;
      for (int before = 0; before < axis; ++before) half[before] += 2.0f * t;
      middle[axis] = side * (1.0f + t);
      Mesh slab = boxMesh(half, false);
      for (glm::vec3& p : slab.positions) p += middle;
      addMesh(scene, slab);
    }
  }
  const Scene baked = bakeTransfer(scene, interreflected(2, 3, 8192));
  const std::vector<bool> used = usedVertices(scene.meshes[0]);
  for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
    if (!used[v]) continue;
    EXPECT_LT(directBrightness(baked.meshes[0], v), 1e-4f) << v;
    EXPECT_LT(indirectBrightness(baked.meshes[0], v).g, 0.01f) << v;
  }
}

// Three sheets on one edge, a face twice, one without area, one that lies upside down, vertices that nobody uses: transfer is
// that of some surface, and finite.
TEST(PrtBake, MeshesThatAreNoSurfaceGetAnAnswer) {
  Mesh mesh = gridMesh(1.0f, 2);
  const auto add = [&](const glm::vec3& p) {
    mesh.positions.push_back(p);
    mesh.normals.push_back({0, 1, 0});
    return std::uint32_t(mesh.positions.size() - 1);
  };
  const std::uint32_t up = add({0, 1, 0}), lonely = add({3, 3, 3}), far = add({1e4f, 0, 0});
  mesh.indices.insert(mesh.indices.end(), {4, 5, up});          // a third sheet on an inner edge
  mesh.indices.insert(mesh.indices.end(), {0, 3, 4, 0, 4, 3});  // a face twice, and its other side
  mesh.indices.insert(mesh.indices.end(), {4, 4, 5, 0, 4, 8});  // no area: a point twice, three in a line
  mesh.indices.insert(mesh.indices.end(), {0, 1, far});         // a needle
  const Scene baked = bakeTransfer(sceneOf(mesh), interreflected(3));
  ASSERT_EQ(baked.meshes[0].vertexCount(), mesh.vertexCount());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float bright = brightness(baked.meshes[0], v);
    EXPECT_TRUE(std::isfinite(bright) && bright > -0.01f && bright < 1.01f) << v << " " << bright;
  }
  for (const float value : baked.meshes[0].transfer->indirect) ASSERT_TRUE(std::isfinite(value));
  EXPECT_EQ(brightness(baked.meshes[0], lonely), 0.0f);
}

TEST(PrtBake, WhatIsHiddenInsideDoesNotDarkenWhatIsSeen) {
  Scene scene = sceneOf(gridMesh(4.0f, 16));  // vertices half a metre apart, nine of them under the box
  Mesh box = boxMesh(glm::vec3(0.7f), false);
  for (glm::vec3& p : box.positions) p.y += 0.7f;
  addMesh(scene, box);
  for (const bool double_sided : {false, true}) {
    scene.materials[0].double_sided = double_sided;
    const Scene baked = bakeTransfer(scene, shadowed());
    int under = 0;
    for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
      const glm::vec3& p = scene.meshes[0].positions[v];
      EXPECT_GT(directBrightness(baked.meshes[0], v), 0.45f);
      under += std::abs(p.x) < 0.7f && std::abs(p.z) < 0.7f;
    }
    EXPECT_EQ(under, 9);
  }
}

// A pebble above one vertex of a coarse floor is not spread over the cells around it; a table above many is a shadow.
// A face that lies upside down in a closed surface has vertices of its own that look into the body. What is seen of it is
// its back, which is as bright as what surrounds it.
TEST(PrtBake, FacesUpsideDownAreNotBlack) {
  for (const bool double_sided : {false, true}) {
    Mesh mesh = sphereMesh(12, 24);
    const std::size_t face = mesh.triangleCount() / 2, first = mesh.vertexCount();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& corner = mesh.indices[3 * face + k];
      mesh.positions.push_back(mesh.positions[corner]);
      mesh.normals.push_back(-mesh.normals[corner]);
      corner = std::uint32_t(first + k);
    }
    std::swap(mesh.indices[3 * face], mesh.indices[3 * face + 1]);
    Scene scene = sceneOf(mesh);
    scene.materials[0].double_sided = double_sided;
    const Scene baked = bakeTransfer(scene, interreflected(2));
    const std::vector<bool> used = usedVertices(baked.meshes[0]);
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v]) {
        EXPECT_NEAR(brightness(baked.meshes[0], v), 1.0f, 0.02f) << v << " of " << first;
      }
    }
  }
}

TEST(PrtBake, NooksSmallerThanTheMeshDoNotBlackenIt) {
  for (const float half : {0.1f, 2.5f}) {
    Scene scene = sceneOf(gridMesh(4.0f, 8));
    Mesh plate = boxMesh(glm::vec3(half, 0.01f, half), false);
    for (glm::vec3& p : plate.positions) p.y += 0.03f;
    addMesh(scene, plate);
    const Scene baked = bakeTransfer(scene, shadowed());
    const float middle = directBrightness(baked.meshes[0], 4 * 9 + 4);
    if (half < 1.0f) {
      EXPECT_GT(middle, 0.7f);
    } else {
      EXPECT_LT(middle, 0.01f);
    }
  }
}

// Seams of texture coordinates do not show: vertices at one place with one normal get the same bits.
TEST(PrtBake, SeamsDoNotShow) {
  Scene scene = sceneOf(sphereMesh(8, 16));
  addMesh(scene, quadMesh({0, -1.5f, 0}, {0, 0, 4}, {4, 0, 0}));
  const Scene baked = bakeTransfer(scene, interreflected(1));
  const Mesh& mesh = baked.meshes[0];
  for (std::size_t ring = 1; ring < 8; ++ring) {
    const std::size_t first = ring * 17, last = first + 16;
    ASSERT_EQ(mesh.positions[first], mesh.positions[last]);
    EXPECT_NE(mesh.transfer->direct[first * 9], 0.0f);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_EQ(mesh.transfer->direct[first * 9 + i], mesh.transfer->direct[last * 9 + i]);
      EXPECT_EQ(mesh.transfer->indirect[first * 27 + 3 * i], mesh.transfer->indirect[last * 27 + 3 * i]);
    }
  }
}

// ---- Interreflection -------------------------------------------------------------------------------------------------

// A spherical bowl that covers the share a of its sphere: each point of it sees the share a of its cosine-weighted
// hemisphere covered by the rest, wherever it lies. DS leaves rho (1 - a) L, each bounce rho a times the last.
TEST(PrtBake, OpenBowlHasTheRightPartialSums) {
  for (const auto& [a, albedo] : {std::pair(0.3f, 0.9f), std::pair(0.6f, 0.6f)}) {
    Scene scene = sceneOf(bowlMesh(a, 16, 32));
    scene.materials[0].base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    const std::vector<bool> used = usedVertices(scene.meshes[0]);
    for (const int bounces : {1, 3, 20}) {
      const Scene baked = bakeTransfer(scene, interreflected(bounces, 3, 10000, 1024));
      const float ratio = albedo * a;
      const float direct = albedo * (1.0f - a);
      const float total = direct * (1.0f - std::pow(ratio, float(bounces + 1))) / (1.0f - ratio);
      if (bounces == 20) {
        EXPECT_NEAR(total, direct / (1.0f - ratio), 1e-5f);
      }
      // Each vertex has directions of its own: its noise is its own, too, and the facets' error stands in the mean.
      double direct_sum = 0.0, sum = 0.0, count = 0.0;
      for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
        if (!used[v]) continue;
        const float direct_part = albedo * directBrightness(baked.meshes[0], v) / direct;
        const float part = albedo * brightness(baked.meshes[0], v) / total;
        EXPECT_NEAR(direct_part, 1.0f, 0.015f);
        EXPECT_NEAR(part, 1.0f, 0.015f) << a << " " << bounces;
        direct_sum += double(direct_part), sum += double(part), ++count;
      }
      EXPECT_NEAR(direct_sum / count, 1.0, 0.005);
      EXPECT_NEAR(sum / count, 1.0, 0.005);
    }
  }
}

TEST(PrtBake, WhiteFurnaceOfAConcaveBodyConvergesToOne) {
  const Scene scene = sceneOf(bowlMesh(0.75f, 12, 24));
  const std::vector<bool> used = usedVertices(scene.meshes[0]);
  float last = 0.0f;
  for (const int bounces : {1, 4, 16, 64}) {
    const Scene baked = bakeTransfer(scene, interreflected(bounces, 3, 2048, 512));
    float least = 2.0f, most = 0.0f;
    for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
      if (!used[v]) continue;
      least = std::min(least, brightness(baked.meshes[0], v));
      most = std::max(most, brightness(baked.meshes[0], v));
    }
    EXPECT_GT(least, last);
    EXPECT_LT(most, 1.0f + 1e-4f);
    last = least;
  }
  EXPECT_NEAR(last, 1.0f, 0.002f);
}

TEST(PrtBake, BacksBlockAndSendNothing) {
  // A sheet above a floor: what looks up sees its lower side.
  for (const bool facing_down : {false, true}) {
    Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}));
    Mesh sheet = quadMesh({0, 1, 0}, {0, 0, 1.5f}, {1.5f, 0, 0});
    if (facing_down) turnInsideOut(sheet);
    addMesh(scene, sheet);
    addMesh(scene, quadMesh({0, -0.01f, 0}, {0, 0, 50}, {50, 0, 0}));
    scene.materials[0].double_sided = true;
    const Scene baked = bakeTransfer(scene, interreflected(2));
    EXPECT_NEAR(directBrightness(baked.meshes[0], 0), 0.4f, 0.2f);
    if (facing_down) {
      EXPECT_GT(indirectBrightness(baked.meshes[0], 0).g, 0.1f);
    } else {
      EXPECT_LT(indirectBrightness(baked.meshes[0], 0).g, 1e-5f);
    }
  }
}

// Two halves of a wall, painted by a texture: the floor before each takes its colour.
TEST(PrtBake, TexturesBleed) {
  Scene scene = sceneOf(gridMesh(1.0f, 8));
  Mesh wall = quadMesh({0, 1, -1}, {1, 0, 0}, {0, 1, 0});
  wall.uv_sets = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  Material painted = scene.materials[0];
  painted.base_color_map.texture = 0;
  painted.base_color_map.nearest = true;
  scene.textures.push_back({"", 2, 1, {255, 0, 0, 255, 0, 0, 255, 255}});
  addMesh(scene, wall).material = 1;
  scene.materials.push_back(painted);
  const Scene baked = bakeTransfer(scene, interreflected(1));
  const Mesh& floor = baked.meshes[0];
  for (std::size_t v = 0; v < floor.vertexCount(); ++v) {
    const glm::vec3 light = indirectBrightness(floor, v), p = floor.positions[v];
    if (p.z > 0.0f || std::abs(p.x) < 0.3f) continue;
    EXPECT_NEAR(light.g, 0.0f, 1e-6f);
    EXPECT_GT(p.x < 0.0f ? light.r : light.b, 1.2f * (p.x < 0.0f ? light.b : light.r)) << p.x << " " << p.z;
  }
  scene.materials[1].metallic = 1.0f;  // metal has no diffuse albedo
  BakeOptions no_mirrors = interreflected(1);
  no_mirrors.caustics = false;
  const Scene metal = bakeTransfer(scene, no_mirrors);
  for (const float value : metal.meshes[0].transfer->indirect) EXPECT_EQ(value, 0.0f);
}

}  // namespace
}  // namespace gloam::prt
