// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/builtin_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/mesh_laws.h"

namespace gloam {
namespace {

constexpr double kPi = 3.14159265358979;

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                     c = mesh.positions[mesh.indices[t + 2]];
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

void expectLawful(const Mesh& mesh, float agreement) {
  EXPECT_LT(mesh_laws::frameError(mesh), 1e-4f);
  EXPECT_GT(mesh_laws::leastNormalAgreement(mesh), agreement);
  ASSERT_EQ(mesh.uv_sets.size(), 1u);
  EXPECT_EQ(mesh.uv_sets[0].size(), mesh.vertexCount());
  EXPECT_LT(mesh_laws::wrongUvShare(mesh), 0.01f);
  for (const std::uint32_t i : mesh.indices) ASSERT_LT(i, mesh.vertexCount());
}

void expectClosed(const Mesh& mesh, double volume, double tolerance) {
  EXPECT_EQ(mesh_laws::openEdges(mesh), 0);
  EXPECT_NEAR(mesh_laws::signedVolume(mesh), volume, tolerance * volume);
}

TEST(Shapes, SpheresAreClosedAndHaveTheirVolume) {
  for (const Mesh& mesh : {shapes::icosphere(2.0f, 20), shapes::uvSphere(2.0f, 96, 48)}) {
    expectLawful(mesh, 0.99f);
    expectClosed(mesh, 4.0 / 3.0 * kPi * 8.0, 0.01);
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
      EXPECT_LT(glm::length(mesh.positions[i] - 2.0f * mesh.normals[i]), 1e-5f);
    }
  }
  EXPECT_EQ(shapes::icosphere(1.0f, 7).triangleCount(), 20u * 7 * 7);
}

TEST(Shapes, BoxesAreClosedAndFlatOrRound) {
  const Mesh plain = shapes::box({-1, 0, -2}, {1, 3, 2}, 0.25f);
  expectLawful(plain, 0.9999f);
  expectClosed(plain, 24.0, 1e-5);
  const Mesh round = shapes::roundedBox({1.0f, 0.5f, 0.75f}, 0.1f, 0.1f);
  expectLawful(round, 0.97f);
  expectClosed(round, 3.0, 0.03);
  // A box that is all edge is a sphere.
  const Mesh ball = shapes::roundedBox(glm::vec3(0.5f), 0.5f, 0.1f, 12);
  expectLawful(ball, 0.98f);
  expectClosed(ball, 4.0 / 3.0 * kPi / 8.0, 0.02);
}

TEST(Shapes, SlabLooksUpAndHasNoUnderside) {
  const Mesh mesh = shapes::slab(1.0f, 2.0f, 0.2f, 0.05f, 0.1f);
  expectLawful(mesh, 0.97f);
  float highest = -1.0f;
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    highest = std::max(highest, mesh.positions[i].y);
    EXPECT_GT(mesh.normals[i].y, -0.9f);
  }
  EXPECT_NEAR(highest, 0.0f, 1e-6f);
}

TEST(Shapes, GroundFacesUp) {
  const Mesh mesh = shapes::ground(4.0f, 2.0f, 8, 4);
  expectLawful(mesh, 0.9999f);
  EXPECT_EQ(mesh.normals[3], glm::vec3(0, 1, 0));
  EXPECT_NEAR(area(mesh), 8.0, 1e-5);
}

TEST(Shapes, TorusAndTubesAreClosed) {
  const Mesh torus = shapes::torus(1.0f, 0.25f, 96, 32);
  expectLawful(torus, 0.98f);
  expectClosed(torus, 2.0 * kPi * kPi * 0.0625, 0.02);
  const Mesh ring = shapes::tube(
      [](float t) { return glm::vec3(std::sin(2 * kPi * t), 0.0f, std::cos(2 * kPi * t)); }, 0.25f, 96, 32);
  expectLawful(ring, 0.98f);
  expectClosed(ring, 2.0 * kPi * kPi * 0.0625, 0.02);
  const Mesh knot = shapes::torusKnot(2, 3, 0.6f, 0.25f, 0.1f, 300, 24);
  expectLawful(knot, 0.9f);
  expectClosed(knot, kPi * 0.01 * 9.0, 0.15);  // about nine metres of tube
}

TEST(Shapes, RevolvedShapesAreClosed) {
  const Mesh cylinder = shapes::cylinder(0.5f, 2.0f, 0.02f, 96, 20);
  expectLawful(cylinder, 0.96f);
  expectClosed(cylinder, kPi * 0.25 * 2.0, 0.02);
}

TEST(Shapes, BowlCoversItsShareAndFacesInward) {
  for (const float share : {0.2f, 0.5f, 0.8f}) {
    const Mesh mesh = shapes::bowl(2.0f, share, 32);
    expectLawful(mesh, 0.99f);
    EXPECT_NEAR(area(mesh), double(share) * 4.0 * kPi * 4.0, 0.01 * 4.0 * kPi * 4.0);
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
      EXPECT_LT(glm::length(mesh.positions[i] + 2.0f * mesh.normals[i]), 1e-5f);
      EXPECT_LT(mesh.positions[i].y, 2.0f * (2.0f * share - 1.0f) + 1e-4f);
    }
  }
}

TEST(Shapes, MirroringKeepsTrianglesOutward) {
  const Mesh mesh =
      shapes::transformed(shapes::icosphere(1.0f, 6), glm::scale(glm::mat4(1.0f), {-1, 2, 0.5f}));
  expectLawful(mesh, 0.9f);
  EXPECT_EQ(mesh_laws::openEdges(mesh), 0);
  EXPECT_GT(mesh_laws::signedVolume(mesh), 0.0);
}

}  // namespace
}  // namespace gloam
