// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light by way of specular reflectors (PRT-3): laws, a slow twin.
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/brdf.h"
#include "techniques/prt/prt_bake_measures.h"
#include "techniques/prt/prt_bake_points.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "trace/tracer.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

Material mirror(const glm::vec3& color, float roughness = 0.02f) {
  return {.base_color = glm::vec4(color, 1.0f), .metallic = 1.0f, .roughness = roughness};
}
Material matt(const glm::vec3& albedo) {
  return {.base_color = glm::vec4(albedo, 1.0f), .metallic = 0.0f, .specular = 0.0f};
}

/// A small black floor, material 0, and material 1 for mirrors.
Scene floorAndMirror(const Material& material) {
  Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}));
  scene.materials[0] = matt(glm::vec3(0.0f));
  scene.materials.push_back(material);
  return scene;
}

std::vector<float> indirectOf(const Mesh& mesh, std::size_t vertex, std::size_t color) {
  const std::size_t count = coefficients(*mesh.transfer);
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(mesh.transfer->indirect[(vertex * count + i) * 3 + color]);
  return values;
}

double relativeDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(double(a[i]) - double(b[i]), 2.0);
    size += double(b[i]) * double(b[i]);
  }
  return std::sqrt(difference / size);
}

// What a floor sees in an endless upright mirror is the half of the sky that it sees beside it, with x turned round: the
// vector of that half with the same sign, since the integral is over the same directions.
TEST(PrtMirrorBake, AnUprightMirrorShowsTheOtherHalfOfTheSky) {
  Scene scene = floorAndMirror(mirror({1.0f, 0.8f, 0.4f}));
  addMesh(scene, quadMesh({0.5f, 1e4f, 0}, {0, 0, 1e4f}, {0, 1e4f, 0})).material = 1;
  const Scene baked = bakeTransfer(scene, interreflected(1, 6, 32768, 32768));
  const Mesh& floor = baked.meshes[0];
  for (std::size_t v = 0; v < floor.vertexCount(); ++v) {
    const std::vector<float> direct(floor.transfer->direct.begin() + std::ptrdiff_t(v * 36),
                                    floor.transfer->direct.begin() + std::ptrdiff_t(v * 36 + 36));
    for (const auto& [color, tint] : {std::pair(0, 1.0f), {1, 0.8f}, {2, 0.4f}}) {
      std::vector<float> shown = indirectOf(floor, v, std::size_t(color));
      for (float& value : shown) value /= tint;
      EXPECT_LT(relativeDifference(shown, direct), 0.006) << v << " " << color;
    }
  }
}

// In a corner of two mirrors the floor sees four quarters of the sky, one of them by two mirrors: a bounce each.
TEST(PrtMirrorBake, MirrorsInMirrorsAreABounceEach) {
  Scene scene = floorAndMirror(mirror(glm::vec3(1.0f)));
  addMesh(scene, quadMesh({0.1f, 1e4f, 0}, {0, 0, 1e4f}, {0, 1e4f, 0})).material = 1;
  addMesh(scene, quadMesh({0, 1e4f, 0.1f}, {0, 1e4f, 0}, {1e4f, 0, 0})).material = 1;
  for (const auto& [bounces, expected] : {std::pair(1, 0.75f), {2, 1.0f}, {4, 1.0f}}) {
    const Scene baked = bakeTransfer(scene, interreflected(bounces, 3, 8192, 4096));
    for (std::size_t v = 0; v < 4; ++v) {
      EXPECT_NEAR(directBrightness(baked.meshes[0], v), 0.25f, 0.005f);
      EXPECT_NEAR(brightness(baked.meshes[0], v), expected, 0.01f) << bounces;
    }
  }
}

// White light everywhere, white mirrors and white floors: all is 1, in as many bounces as it takes.
TEST(PrtMirrorBake, AWhiteMirrorInTheFurnaceIsOne) {
  Scene scene = sceneOf(gridMesh(1.0f, 6));
  scene.materials.push_back(mirror(glm::vec3(1.0f)));
  addMesh(scene, quadMesh({0, 0.5f, -1}, {1, 0, 0}, {0, 0.5f, 0})).material = 1;
  addMesh(scene, quadMesh({0, 1.0f, 0}, {0.4f, 0, 0}, {0, 0.1f, 0.4f})).material = 1;
  float last = 0.0f;
  for (const int bounces : {1, 2, 6, 16}) {
    const Scene baked = bakeTransfer(scene, interreflected(bounces, 3, 4096, 2048));
    float least = 2.0f;
    for (std::size_t v = 0; v < baked.meshes[0].vertexCount(); ++v) {
      const float bright = brightness(baked.meshes[0], v);
      EXPECT_LT(bright, 1.001f);
      least = std::min(least, bright);
    }
    EXPECT_GT(least, last);
    last = least;
  }
  EXPECT_GT(last, 0.997f);
}

// A broad lobe is followed as well as a sharp one: under uniform light it makes no difference but for what lies below.
TEST(PrtMirrorBake, LobesOfAnyWidthCarryTheirLight) {
  for (const float roughness : {0.1f, 0.4f, 0.6f}) {
    Scene scene = floorAndMirror(mirror(glm::vec3(0.7f), roughness));
    addMesh(scene, quadMesh({0.5f, 1e4f, 0}, {0, 0, 1e4f}, {0, 1e4f, 0})).material = 1;
    const Scene baked = bakeTransfer(scene, interreflected(1, 3, 4096, 4096));
    for (std::size_t v = 0; v < 4; ++v) {
      const float shown = indirectBrightness(baked.meshes[0], v).g;
      EXPECT_LE(shown, 0.352f) << roughness;
      EXPECT_GT(shown, roughness < 0.3f ? 0.34f : 0.25f) << roughness;
    }
  }
}

// Two bounces that end on diffuse surfaces behind a mirror, by as plain a loop as there can be.
TEST(PrtMirrorBake, SurfacesInMirrorsAreThoseOfTheSlowTwin) {
  Scene scene = crowdedScene();
  const glm::vec3 tint(0.9f, 0.7f, 0.5f);
  scene.materials.push_back(mirror(tint));
  for (Material& m : scene.materials) m.specular = 0.0f;
  addMesh(scene, quadMesh({0, 0.6f, -1.0f}, {0.8f, 0, 0}, {0, 0.8f, 0.2f})).material = 3;
  const Scene one = bakeTransfer(scene, interreflected(1, 4, 8192, 8192)),
              two = bakeTransfer(scene, interreflected(2, 4, 8192, 8192));
  const PosedScene posed = pose(one, 0.0f);
  const BakePoints points = makeBakePoints(one, posed);
  const trace::Tracer tracer(one, posed, {.reproducible = true, .rigid_only = true});
  const int count = 16000;
  double difference = 0.0, size = 0.0;
  for (const std::size_t v : {30u, 110u, 205u, 280u}) {
    const std::uint32_t point = points.point_of_vertex[v];
    std::vector<glm::dvec3> want(16, glm::dvec3(0.0));
    for (const glm::vec3& s : sampling::fibonacciSphere(count)) {
      const float cosine = glm::dot(s, points.normals[point]);
      if (cosine <= 0.0f) continue;
      trace::Ray ray{rayOrigin(points, point), s};
      trace::Hit hit = tracer.closest(ray);
      const auto back = [&] { return glm::dot(ray.direction, hit.geometric_normal) > 0.0f; };
      const auto meshOf = [&]() -> const Mesh& {
        return one.meshes[std::size_t(posed.instances[std::size_t(hit.instance)].mesh)];
      };
      if (!hit || back()) continue;
      const bool mirrored = meshOf().material == 3;
      glm::dvec3 weight(double(cosine) * 4.0 * 3.14159265358979 / count);
      if (mirrored) {
        const glm::vec3 at = ray.origin + hit.distance * ray.direction + 1e-4f * hit.geometric_normal;
        ray = {at, glm::reflect(ray.direction, hit.geometric_normal)};
        hit = tracer.closest(ray);
        weight *= glm::dvec3(tint);
        if (!hit || back() || meshOf().material == 3) continue;
      }
      const Mesh& mesh = meshOf();
      const std::uint32_t* corner = &mesh.indices[std::size_t(hit.triangle) * 3];
      const float share[3] = {1.0f - hit.u - hit.v, hit.u, hit.v};
      weight *=
          glm::dvec3(glm::vec3(one.materials[std::size_t(mesh.material)].base_color)) / 3.14159265358979;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 16; ++i) {
          // Directly: the first bounce of what is hit. By the mirror: its own light, one bounce being spent.
          const float* first = &mesh.transfer->indirect[(corner[k] * 16 + i) * 3];
          const glm::dvec3 sent = mirrored ? glm::dvec3(double(mesh.transfer->direct[corner[k] * 16 + i]))
                                           : glm::dvec3(first[0], first[1], first[2]);
          want[i] += weight * double(share[k]) * sent;
        }
      }
    }
    for (std::size_t i = 0; i < 16; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = (v * 16 + i) * 3 + c;
        const double second =
            double(two.meshes[0].transfer->indirect[at]) - double(one.meshes[0].transfer->indirect[at]);
        difference += std::pow(second - want[i][int(c)], 2.0);
        size += want[i][int(c)] * want[i][int(c)];
      }
    }
  }
  EXPECT_GT(size, 1e-3);
  EXPECT_LT(std::sqrt(difference / size), 0.02);
}

// With matrices or without, sharp lobes throw the same caustics; and they are not held to the bands that matrices show.
TEST(PrtMirrorBake, MatricesDoNotBluntCaustics) {
  Scene scene = crowdedScene();
  scene.materials[1] = mirror({0.9f, 0.8f, 0.6f}, 0.05f);
  for (Material& m : scene.materials) m.specular = 0.0f;
  BakeOptions options = interreflected(2, 4, 4096, 2048);
  const Scene plain = bakeTransfer(scene, options);
  options.glossy = GlossyMeshes::kShiny;
  const Scene with = bakeTransfer(scene, options);
  options.caustics = false;
  const Scene blunt = bakeTransfer(scene, options);
  EXPECT_LT(relativeDifference(with.meshes[0].transfer->indirect, plain.meshes[0].transfer->indirect), 1e-3);
  EXPECT_GT(relativeDifference(blunt.meshes[0].transfer->indirect, plain.meshes[0].transfer->indirect), 0.03);
}

TEST(PrtMirrorBake, NothingChangesWhereNothingMirrors) {
  Scene scene = crowdedScene();
  BakeOptions options = interreflected(2, 4);
  const Scene on = bakeTransfer(scene, options);
  options.caustics = false;
  const Scene off = bakeTransfer(scene, options);
  EXPECT_EQ(on.meshes[0].transfer->indirect, off.meshes[0].transfer->indirect);
}

}  // namespace
}  // namespace gloam::prt
