// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace gloam::trace {
namespace {

Mesh triangleSoup(int count, unsigned seed, float size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f);
  const auto point = [&] { return glm::vec3(place(random), place(random), place(random)); };
  Mesh mesh;
  for (int t = 0; t < count; ++t) {
    const glm::vec3 center = point();
    for (int k = 0; k < 3; ++k) {
      mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
      mesh.positions.push_back(center + size * point());
      mesh.normals.push_back({0.0f, 1.0f, 0.0f});
    }
  }
  return mesh;
}

// A box of 24 vertices, outward counter-clockwise.
Mesh box(const glm::vec3& half) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = std::uint32_t(mesh.positions.size());
      glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1.0f;
      for (const glm::vec2& c : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        mesh.positions.push_back((normal + u * c.x + v * c.y) * half);
        mesh.normals.push_back(normal);
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    }
  }
  return mesh;
}

struct World {
  Scene scene;
  PosedScene posed;
  World() { scene.materials.emplace_back(); }
  void add(Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0f)) {
    Instance instance;
    instance.mesh = int(scene.meshes.size());
    instance.world_from_object = world_from_object;
    posed.instances.push_back(instance);
    scene.meshes.push_back(std::move(mesh));
  }
};

// Möller, Trumbore 1997 in double, over all triangles.
std::optional<Hit> slowClosest(const World& world, const Ray& ray) {
  std::optional<Hit> best;
  for (std::size_t i = 0; i < world.posed.instances.size(); ++i) {
    const Instance& instance = world.posed.instances[i];
    const Mesh& mesh = world.scene.meshes[std::size_t(instance.mesh)];
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      glm::dvec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = glm::dvec3(
            glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[mesh.indices[3 * t + k]], 1.0f)));
      }
      const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0], d(ray.direction), q = glm::cross(d, e2);
      const double det = glm::dot(e1, q);
      if (det == 0.0) continue;
      const glm::dvec3 s = glm::dvec3(ray.origin) - p[0], r = glm::cross(s, e1);
      const double u = glm::dot(s, q) / det, v = glm::dot(d, r) / det, distance = glm::dot(e2, r) / det;
      if (u < 0 || v < 0 || u + v > 1 || distance < ray.t_near || distance > ray.t_far) continue;
      if (best && distance >= best->distance) continue;
      best = Hit{int(i),   int(t),   float(distance),
                 float(u), float(v), glm::vec3(glm::normalize(glm::cross(e1, e2)))};
    }
  }
  return best;
}

Ray randomRay(std::mt19937& random) {
  std::uniform_real_distribution<float> place(-1.5f, 1.5f);
  const glm::vec3 from(place(random), place(random), place(random)),
      to(place(random), place(random), place(random));
  return {from, glm::normalize(to - from)};
}

TEST(Tracer, FindsWhatTheSlowTwinFinds) {
  World world;
  world.add(triangleSoup(60, 1, 0.3f));
  world.add({});  // a mesh without triangles takes an index and nothing else
  world.add(triangleSoup(60, 2, 0.3f),
            glm::mat4(glm::mat3(0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 2.0f, 1.0f, 0.0f, 0.0f)));
  const Tracer tracer(world.scene, world.posed);
  EXPECT_EQ(tracer.triangleCount(), 120u);
  std::mt19937 random(3);
  int hits = 0, apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = randomRay(random);
    const std::optional<Hit> expected = slowClosest(world, ray);
    const Hit hit = tracer.closest(ray);
    EXPECT_EQ(tracer.occluded(ray), bool(hit));
    // Rays that graze an edge may be seen either way.
    if (bool(hit) != bool(expected) || (hit && hit.triangle != expected->triangle)) {
      ++apart;
      continue;
    }
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(hit.instance, expected->instance);
    EXPECT_NEAR(hit.distance, expected->distance, 1e-4f);
    EXPECT_NEAR(hit.u, expected->u, 2e-3f);
    EXPECT_NEAR(hit.v, expected->v, 2e-3f);
    EXPECT_GT(glm::dot(hit.geometric_normal, expected->geometric_normal), 0.999f);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LE(apart, 2);
}

TEST(Tracer, PacketsFindWhatSingleRaysFind) {
  World world;
  world.add(triangleSoup(300, 4, 0.2f));
  const Tracer tracer(world.scene, world.posed);
  std::mt19937 random(5);
  for (int n = 0; n < 100; ++n) {
    RayPacket rays;
    Ray single[kPacketSize];
    for (int i = 0; i < kPacketSize; ++i) rays.setRay(i, single[i] = randomRay(random));
    const std::uint32_t traced = random() & 0xffffu;
    LaneMask mask;
    mask.set(traced);
    HitPacket hits;
    tracer.closest(rays, mask, n % 2 == 0, hits);
    tracer.occluded(rays, mask, n % 2 == 0);
    for (int i = 0; i < kPacketSize; ++i) {
      const Hit hit = traced >> i & 1u ? tracer.closest(single[i]) : Hit{};
      EXPECT_EQ(hits.instance[i], hit.instance);
      EXPECT_EQ(rays.t_far[i] < 0.0f, bool(hit));
      if (!hit) continue;
      EXPECT_EQ(hits.triangle[i], hit.triangle);
      EXPECT_NEAR(hits.distance[i], hit.distance, 1e-5f);
    }
  }
}

TEST(Tracer, NormalsKeepTheirSideInAMirror) {
  for (const float mirror : {1.0f, -1.0f}) {
    World world;
    world.add(box(glm::vec3(1.0f)),
              glm::mat4(glm::mat3(mirror, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f)));
    const Tracer tracer(world.scene, world.posed);
    const Hit hit = tracer.closest({{3.0f, 0.1f, 0.2f}, {-1.0f, 0.0f, 0.0f}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.geometric_normal.x, 1.0f, 1e-6f);
    EXPECT_NEAR(hit.distance, 2.0f, 1e-6f);
    RayPacket rays;
    rays.setRay(0, {{3.0f, 0.1f, 0.2f}, {-1.0f, 0.0f, 0.0f}});
    LaneMask mask;
    mask.set(1);
    HitPacket hits;
    tracer.closest(rays, mask, false, hits);
    EXPECT_GT(hits.normal_x[0], 0.0f);
  }
}

TEST(Tracer, DeformedVerticesAreTakenOrLeftOut) {
  World world;
  world.add(box(glm::vec3(1.0f)));
  for (const glm::vec3& p : world.scene.meshes[0].positions) {
    world.posed.instances[0].deformed_positions.push_back(p + glm::vec3(10.0f, 0.0f, 0.0f));
  }
  const Ray at_rest{{0.0f, 5.0f, 0.0f}, {0.0f, -1.0f, 0.0f}}, moved{{10.0f, 5.0f, 0.1f}, {0.0f, -1.0f, 0.0f}};
  const Tracer tracer(world.scene, world.posed);
  EXPECT_FALSE(tracer.occluded(at_rest));
  EXPECT_TRUE(tracer.occluded(moved));
  const Tracer rigid(world.scene, world.posed, {.rigid_only = true});
  EXPECT_FALSE(rigid.occluded(moved));
  EXPECT_EQ(rigid.triangleCount(), 0u);
}

TEST(Tracer, MaskedMaterialsHaveHoles) {
  World world;
  Mesh quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  quad.uv_sets = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  world.add(quad);
  Texture texture{"", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}};  // left half there, right half cut out
  world.scene.textures.push_back(texture);
  Material& material = world.scene.materials[0];
  material.base_color_map.texture = 0;
  material.base_color_map.nearest = true;
  const auto blocked = [&](float x) {
    const Ray ray{{x, 0.4f, 1.0f}, {0.0f, 0.0f, -1.0f}};
    const Tracer tracer(world.scene, world.posed);
    RayPacket rays;
    for (int i = 0; i < kPacketSize; ++i) rays.setRay(i, ray);
    LaneMask mask;
    mask.set(0xffffu);
    tracer.occluded(rays, mask, true);
    for (const float t : rays.t_far) EXPECT_EQ(t < 0.0f, tracer.occluded(ray));
    EXPECT_EQ(bool(tracer.closest(ray)), tracer.occluded(ray));
    return tracer.occluded(ray);
  };
  EXPECT_TRUE(blocked(0.25f));
  EXPECT_TRUE(blocked(0.75f));
  material.alpha_mask = true;
  EXPECT_TRUE(blocked(0.25f));
  EXPECT_FALSE(blocked(0.75f));
}

// From any point of a box, moved by the offset: outside nothing is in the way, inside everything is. At any size and place.
TEST(Tracer, SurfaceOffsetNeitherLeaksNorCatches) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const float size : {1e-3f, 1.0f, 1e3f}) {
    for (const glm::vec3& center : {glm::vec3(0.0f), size * glm::vec3(20.0f, -30.0f, 10.0f)}) {
      World world;
      const glm::mat3 turned(0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f);
      glm::mat4 placed(turned);
      placed[3] = glm::vec4(center, 1.0f);
      world.add(box(size * glm::vec3(1.0f, 0.5f, 2.0f)), placed);
      const Tracer tracer(world.scene, world.posed, {.robust = true});
      const Mesh& mesh = world.scene.meshes[0];
      for (int i = 0; i < 5000; ++i) {
        const std::size_t t = random() % mesh.triangleCount();
        float u = unit(random), v = unit(random);
        if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
        const std::uint32_t* c = &mesh.indices[3 * t];
        const glm::vec3 p =
            mesh.positions[c[0]] * (1 - u - v) + mesh.positions[c[1]] * u + mesh.positions[c[2]] * v;
        const auto corner = [&](int k) { return glm::vec3(placed * glm::vec4(mesh.positions[c[k]], 1.0f)); };
        const float offset = surfaceOffset(corner(0), corner(1), corner(2));
        const glm::vec3 on_surface(placed * glm::vec4(p, 1.0f)), normal = turned * mesh.normals[c[0]];
        glm::vec3 direction = randomRay(random).direction;
        if (glm::dot(direction, normal) < 0.0f) direction = -direction;
        EXPECT_FALSE(tracer.occluded({on_surface + normal * offset, direction}));
        const Hit hit = tracer.closest({on_surface + 2.0f * size * normal, -normal});
        ASSERT_TRUE(hit);
        EXPECT_EQ(tracer.surfaceOffset(hit) > 0.0f, offset > 0.0f);
        EXPECT_TRUE(tracer.occluded({on_surface - normal * offset, -direction}));
      }
    }
  }
}

TEST(Tracer, DegenerateAndMissingTrianglesAreHarmless) {
  World world;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {INFINITY, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2, 0, 0, 0, 0, 1, 3};
  world.add(mesh);
  const Tracer tracer(world.scene, world.posed);
  EXPECT_FALSE(tracer.occluded({{0.5f, 0.5f, 1.0f}, glm::normalize(glm::vec3(0.0f, -0.5f, -1.0f))}));
  const World nothing;
  const Tracer empty(nothing.scene, nothing.posed);
  EXPECT_FALSE(empty.closest({{0, 0, 0}, {0, 1, 0}}));
}

TEST(Tracer, BuildStopsWhenAsked) {
  World world;
  world.add(triangleSoup(100000, 8, 0.01f));
  Progress progress;
  progress.should_stop = [] { return true; };
  EXPECT_THROW(Tracer(world.scene, world.posed, {}, progress), Interrupted);
}

}  // namespace
}  // namespace gloam::trace
