// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Laws and slow twins of baked glossy transfer (PRT-2).
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "math/brdf.h"
#include "math/sampling.h"
#include "math/sh_high_order.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_gloss_bench.h"
#include "techniques/prt/prt_glossy_state.h"
#include "trace/tracer.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

BakeOptions glossy(BakeOptions options, int light_order = 0, int field_order = 0) {
  options.glossy = GlossyMeshes::kAll;
  options.glossy_light_order = light_order;
  options.glossy_order = field_order;
  options.caustics = false;  // prt_mirror_bake_test.cpp
  return options;
}

Material metal(const glm::vec3& color, float exponent) {
  return {.base_color = glm::vec4(color, 1.0f),
          .metallic = 1.0f,
          .roughness = std::pow(2.0f / (exponent + 2.0f), 0.25f)};
}

/// Three kinds of surface: a mirroring bowl, a diffuse sphere, a box that is both.
Scene shinyScene() {
  Scene scene = crowdedScene();
  scene.materials[0] = metal({0.9f, 0.8f, 0.6f}, 8.0f);
  scene.materials[2] = metal({0.5f, 0.7f, 0.9f}, 4.0f);
  scene.materials[2].metallic = 0.5f;
  return scene;
}

using Matrix = std::vector<float>;  // [row][column]

/// GS of a vertex, as what is kept of it says.
Matrix gs(const GlossyTransfer& t, std::size_t vertex) {
  const sh::Tripling& tripling = sh::Tripling::of(t.light_order, t.field_order);
  std::vector<float> packed(std::size_t(tripling.shape().size()));
  tripling.expand({&t.visibility[vertex * t.visibilityCount()], t.visibilityCount()}, packed);
  Matrix matrix;
  for (int i = 0; i < tripling.shape().rows(); ++i) {
    for (int j = 0; j < tripling.shape().columns(); ++j)
      matrix.push_back(packed[std::size_t(tripling.shape().at(i, j))]);
  }
  return matrix;
}
float indirectAt(const GlossyTransfer& t, std::size_t vertex, std::size_t entry, std::size_t color) {
  return t.indirect[(vertex * t.matrixCount() + entry) * 3 + color];
}

/// Values that the truncated lobe of that exponent has along an axis, of a function given by coefficients.
float lobeOf(int order, float exponent, const glm::vec3& axis, const std::function<float(int)>& coefficient) {
  const sh::Sh y = sh::evaluate(order, axis);
  float sum = 0.0f;
  for (int i = 0; i < order * order; ++i) {
    sum += brdf::phongBandFactor(int(std::sqrt(float(i) + 0.5f)), exponent) * y[i] * coefficient(i);
  }
  return sum;
}

double relativeDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(double(a[i]) - double(b[i]), 2.0);
    size += double(b[i]) * double(b[i]);
  }
  return a.size() == b.size() ? std::sqrt(difference / size) : 1e9;
}

// ---- What stands free ------------------------------------------------------------------------------------------------

// GS of a point that sees all of its hemisphere is the hemisphere's matrix, by quadrature over the hemisphere alone.
TEST(PrtGlossyBake, UnoccludedPointsHaveTheHemispheresMatrix) {
  const auto directions = sampling::fibonacciSphere(200000);
  for (const auto& [light, field] : {std::pair(3, 3), {5, 5}, {3, 5}, {4, 6}}) {
    const Scene baked =
        bakeTransfer(sceneOf(sphereMesh(6, 12)), glossy(shadowed(std::max(light, 3), 512), light, field));
    const Mesh& mesh = baked.meshes[0];
    const std::size_t vertex = 20;
    const Matrix got = gs(mesh.transfer->glossy, vertex);
    std::vector<double> sums(got.size(), 0.0);
    for (const glm::vec3& s : directions) {
      if (glm::dot(s, mesh.normals[vertex]) <= 0.0f) continue;
      const sh::Sh y = sh::evaluate(field, s);
      for (std::size_t e = 0; e < sums.size(); ++e)
        sums[e] += double(y[int(e) / (light * light)]) * double(y[int(e) % (light * light)]);
    }
    const Matrix want(sums.begin(), sums.end());
    Matrix scaled = want;
    for (float& v : scaled) v *= 4.0f * kPi / float(directions.size());
    EXPECT_LT(relativeDifference(got, scaled), 2e-3) << light << field;
  }
}

TEST(PrtGlossyBake, ConvexBodiesAreUnshadowedExactly) {
  const Scene scene = sceneOf(sphereMesh(8, 16));
  BakeOptions unshadowed = glossy(shadowed(5, 512));
  unshadowed.kind = TransferKind::kUnshadowed;
  const Scene shadows = bakeTransfer(scene, glossy(shadowed(5, 512))), none = bakeTransfer(scene, unshadowed);
  EXPECT_EQ(none.meshes[0].transfer->glossy.visibility, shadows.meshes[0].transfer->glossy.visibility);
  EXPECT_TRUE(none.meshes[0].transfer->glossy.indirect.empty());
}

// ---- The furnace: radiance 1 from everywhere -------------------------------------------------------------------------

/// What a lobe about the normal gathers under uniform light of 1, from GS and from all of GI.
glm::vec2 furnace(const GlossyTransfer& t, std::size_t vertex, const glm::vec3& axis, float exponent) {
  const Matrix direct = gs(t, vertex);
  const std::size_t columns = std::size_t(t.light_order * t.light_order);
  const float light = std::sqrt(4.0f * kPi);
  const float first =
      lobeOf(t.field_order, exponent, axis, [&](int i) { return light * direct[std::size_t(i) * columns]; });
  if (t.indirect.empty()) return {first, first};
  const float further = lobeOf(t.field_order, exponent, axis, [&](int i) {
    return light * indirectAt(t, vertex, std::size_t(i) * columns, 1);
  });
  return {first, first + further};
}

TEST(PrtGlossyBake, ConvexWhiteBodyIsOneInTheFurnace) {
  const Scene baked = bakeTransfer(sceneOf(sphereMesh(6, 12)), glossy(shadowed(5, 512)));
  const Mesh& mesh = baked.meshes[0];
  // The lobe's own share above the horizon: all of it, but for what five bands ring to below.
  for (const float exponent : {3.0f, 6.0f, 10.0f}) {
    double share = 0.0;
    for (int k = 0; k < 4000; ++k) {
      const double z = (k + 0.5) / 4000.0;
      const glm::vec3 s(std::sqrt(1.0 - z * z), 0.0, z);
      const sh::Sh y = sh::evaluate(5, {0, 0, 1});
      const sh::Sh at = sh::evaluate(5, s);
      for (int l = 0; l < 5; ++l) {
        share += 2.0 * 3.14159265358979 / 4000.0 * double(brdf::phongBandFactor(l, exponent)) *
                 double(y[l * (l + 1)]) * double(at[l * (l + 1)]);
      }
    }
    EXPECT_NEAR(share, 1.0, 0.08);
    for (std::size_t v = 0; v < mesh.vertexCount(); v += 5)
      ASSERT_NEAR(furnace(mesh.transfer->glossy, v, mesh.normals[v], exponent).y, float(share), 1e-3f);
  }
}

TEST(PrtGlossyBake, ConcaveWhiteBodyGrowsToOneWithBounces) {
  Scene scene = sceneOf(bowlMesh(0.8f, 12, 24));
  scene.materials[0] = metal(glm::vec3(1.0f), 4.0f);
  float before = 0.0f;
  for (const int bounces : {1, 3, 12}) {
    const Scene baked = bakeTransfer(scene, glossy(interreflected(bounces, 5, 1024, 512)));
    const glm::vec2 seen = furnace(baked.meshes[0].transfer->glossy, 0, baked.meshes[0].normals[0], 4.0f);
    EXPECT_LT(seen.x, 0.5f);
    EXPECT_GT(seen.y, before + 0.02f) << bounces;
    before = seen.y;
  }
  // Not all of it: at a grazing angle part of a Phong lobe lies below the surface and is lost at each reflection.
  EXPECT_GT(before, 0.8f);
  EXPECT_LT(before, 1.0f);
}

// ---- Twins -------------------------------------------------------------------------------------------------------------

/// Rays as the bake has them: from where its points look, above the horizon.
struct Twin {
  const Scene& scene;
  PosedScene posed = pose(scene, 0.0f);
  BakePoints points = makeBakePoints(scene, posed);
  trace::Tracer tracer{scene, posed, {.reproducible = true, .rigid_only = true}};

  template <class Visit>  // visit(direction, hit)
  void forHemisphere(std::size_t point, int count, const Visit& visit) const {
    for (const glm::vec3& s : sampling::fibonacciSphere(count)) {
      if (glm::dot(s, points.normals[point]) <= 0.0f) continue;
      visit(s, tracer.closest({rayOrigin(points, point), s}));
    }
  }
};

// Matrix times light, convolved and taken at R, against the integral of visibility, light and lobe.
TEST(PrtGlossyBake, MatrixIsTheIntegralOfTheShadowedLobe) {
  const Scene baked = bakeTransfer(crowdedScene(), glossy(shadowed(5, 8192)));
  const Twin twin{baked};
  sh::Sh light(5);
  for (int i = 0; i < 25; ++i) light[i] = (i == 0 ? 3.0f : 0.0f) + std::sin(2.3f * float(i) + 1.0f);
  const int count = 20000;
  double difference = 0.0, size = 0.0;
  const GlossyTransfer& t = baked.meshes[1].transfer->glossy;
  for (std::size_t v = 10; v < baked.meshes[1].vertexCount(); v += 9) {
    const std::uint32_t point = twin.points.point_of_vertex[twin.points.first_vertex[1] + v];
    if (point == BakePoints::kNoPoint) continue;
    const Matrix m = gs(t, v);
    const glm::vec3 axis = glm::normalize(twin.points.normals[point] + glm::vec3(0.3f, 0.5f, -0.2f));
    double direct = 0.0;
    twin.forHemisphere(point, count, [&](const glm::vec3& s, const trace::Hit& hit) {
      if (hit) return;
      const sh::Sh y = sh::evaluate(5, s);
      direct += double(sh::dot(light, y)) * double(lobeOf(5, 10.0f, axis, [&](int i) { return y[i]; })) *
                4.0 * 3.14159265358979 / count;
    });
    const float by_matrix = lobeOf(5, 10.0f, axis, [&](int i) {
      float field = 0.0f;
      for (int j = 0; j < 25; ++j) field += m[std::size_t(i * 25 + j)] * light[j];
      return field;
    });
    difference += std::pow(double(by_matrix) - direct, 2.0);
    size += direct * direct;
  }
  EXPECT_GT(size, 1.0);
  EXPECT_LT(std::sqrt(difference / size), 0.01);
}

// What `gloam bench gloss` tells: like for like, and what bands leave of a lobe.
TEST(PrtGlossyBake, BenchHoldsMatricesAgainstIntegrals) {
  const Scene scene = crowdedScene();
  sh::ShRgb light = sh::constantSky(5, glm::vec3(0.5f));
  light += sh::colored(sh::directionalLight(5, glm::normalize(glm::vec3(1, 2, 0.5f))),
                       glm::vec3(2.0f, 1.5f, 1.0f));
  const PrtGlossBench bench = benchGloss(scene, light, {.directions = 4096});
  EXPECT_GT(bench.points, 50u);
  ASSERT_EQ(bench.rows.size(), 4u);
  for (const PrtGlossRow& row : bench.rows) {
    EXPECT_LT(row.matrix, 0.01) << row.exponent;
    EXPECT_GT(row.cheap, 2.0 * row.matrix) << row.exponent;
    EXPECT_GT(row.unshadowed, 2.0 * row.cheap) << row.exponent;
  }
  EXPECT_LT(bench.rows[0].truncation, 0.02) << "five bands hold cos^3";
  EXPECT_GT(bench.rows[3].truncation, bench.rows[1].truncation);
  EXPECT_EQ(bench.rows[3].shown, 10.0f);
}

// The first bounce from GS and DS of what is hit, by as plain a loop as there can be.
TEST(PrtGlossyBake, BouncesAreThoseOfTheSlowTwin) {
  const Scene scene = shinyScene();
  const Scene first = bakeTransfer(scene, glossy(shadowed(4, 8192))),
              bounced = bakeTransfer(scene, glossy(interreflected(1, 4, 8192, 4096)));
  const Twin twin{first};
  const int count = 8000;
  const float solid_angle = 4.0f * kPi / float(count);
  double difference = 0.0, size = 0.0, vector_difference = 0.0, vector_size = 0.0;
  for (const std::size_t v : {30u, 110u, 205u, 280u}) {  // of the bowl
    const std::uint32_t point = twin.points.point_of_vertex[v];
    std::vector<glm::dvec3> want(256, glm::dvec3(0.0)), want_vector(16, glm::dvec3(0.0));
    twin.forHemisphere(point, count, [&](const glm::vec3& s, const trace::Hit& hit) {
      if (!hit || glm::dot(s, hit.geometric_normal) > 0.0f) return;
      const Mesh& mesh = first.meshes[std::size_t(twin.posed.instances[std::size_t(hit.instance)].mesh)];
      const Material& material = first.materials[std::size_t(mesh.material)];
      const brdf::Lobes lobes = brdf::makeLobes(material.base_color, material.metallic, material.roughness);
      const std::uint32_t* corner = &mesh.indices[std::size_t(hit.triangle) * 3];
      const float share[3] = {1.0f - hit.u - hit.v, hit.u, hit.v};
      glm::vec3 normal(0.0f);
      std::vector<float> vector(16, 0.0f), matrix(256, 0.0f);
      for (int k = 0; k < 3; ++k) {
        normal += share[k] * mesh.normals[corner[k]];
        const Matrix m = gs(mesh.transfer->glossy, corner[k]);
        for (std::size_t j = 0; j < 16; ++j)
          vector[j] += share[k] * mesh.transfer->direct[corner[k] * 16 + j];
        for (std::size_t e = 0; e < 256; ++e) matrix[e] += share[k] * m[e];
      }
      const glm::vec3 mirror = brdf::mirrorDirection(glm::normalize(normal), -s);
      const float exponent = shownExponent(4, lobes.exponent);
      const sh::Sh y = sh::evaluate(4, s);
      for (std::size_t j = 0; j < 16; ++j) {
        const float lobe =
            lobeOf(4, exponent, mirror, [&](int i) { return matrix[std::size_t(i) * 16 + j]; });
        const glm::dvec3 sent = glm::dvec3(lobes.diffuse) / 3.14159265358979 * double(vector[j]) +
                                glm::dvec3(lobes.specular) * double(lobe);
        for (std::size_t i = 0; i < 16; ++i) want[i * 16 + j] += double(solid_angle * y[int(i)]) * sent;
        want_vector[j] += double(solid_angle * glm::dot(s, twin.points.normals[point])) * sent;
      }
    });
    const Transfer& got = *bounced.meshes[0].transfer;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t e = 0; e < 256; ++e) {
        difference += std::pow(double(indirectAt(got.glossy, v, e, c)) - want[e][int(c)], 2.0);
        size += want[e][int(c)] * want[e][int(c)];
      }
      for (std::size_t j = 0; j < 16; ++j) {
        vector_difference +=
            std::pow(double(got.indirect[(v * 16 + j) * 3 + c]) - want_vector[j][int(c)], 2.0);
        vector_size += want_vector[j][int(c)] * want_vector[j][int(c)];
      }
    }
  }
  EXPECT_GT(size, 0.1);
  EXPECT_LT(std::sqrt(difference / size), 0.03);
  EXPECT_LT(std::sqrt(vector_difference / vector_size), 0.02);
}

// Where nothing mirrors, matrices beside them leave diffuse vectors as they are.
TEST(PrtGlossyBake, DiffuseScenesKeepTheirVectors) {
  Scene scene = crowdedScene();
  for (Material& material : scene.materials) material.specular = 0.0f;
  const BakeOptions options = interreflected(2, 4);
  const Scene plain = bakeTransfer(scene, options), with = bakeTransfer(scene, glossy(options));
  for (std::size_t m = 0; m < plain.meshes.size(); ++m) {
    const Transfer &a = *plain.meshes[m].transfer, &b = *with.meshes[m].transfer;
    EXPECT_LT(relativeDifference(b.direct, a.direct), 1e-5);
    EXPECT_LT(relativeDifference(b.indirect, a.indirect), 1e-5);
  }
}

// Nine coefficients of light are the first nine columns of twenty-five.
TEST(PrtGlossyBake, FewerBandsOfLightAreColumnsOfTheWhole) {
  const Scene scene = shinyScene();
  const BakeOptions options = interreflected(2, 5, 2048, 512);
  const Scene all = bakeTransfer(scene, glossy(options)), few = bakeTransfer(scene, glossy(options, 3, 5));
  const GlossyTransfer &a = all.meshes[2].transfer->glossy, &b = few.meshes[2].transfer->glossy;
  ASSERT_EQ(b.visibilityCount(), 49u);
  ASSERT_EQ(b.matrixCount(), 225u);
  const std::size_t vertices = few.meshes[2].vertexCount();
  ASSERT_EQ(b.indirect.size(), vertices * 225 * 3);
  for (std::size_t v = 0; v < vertices; v += 5) {
    for (std::size_t k = 0; k < 49; ++k)
      ASSERT_NEAR(a.visibility[v * 81 + k], b.visibility[v * 49 + k], 1e-5f);
    for (std::size_t i = 0; i < 25; ++i) {
      for (std::size_t j = 0; j < 9; ++j)
        ASSERT_NEAR(indirectAt(a, v, i * 25 + j, 0), indirectAt(b, v, i * 9 + j, 0), 1e-5f);
    }
  }
}

// A body that turns with its light is lit as before: transfer is in the object's axes.
TEST(PrtGlossyBake, TransferTurnsWithItsObject) {
  const Scene still = shinyScene();
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), 1.2f, glm::normalize(glm::vec3(1.0f, 2.0f, -0.5f)));
  Scene turned = still;
  for (Node& node : turned.nodes) node.matrix = turn;
  const BakeOptions options = glossy(interreflected(1, 4, 8192, 2048));
  const GlossyTransfer a = bakeTransfer(still, options).meshes[2].transfer->glossy,
                       b = bakeTransfer(turned, options).meshes[2].transfer->glossy;
  EXPECT_LT(relativeDifference(b.visibility, a.visibility), 0.02);
  EXPECT_LT(relativeDifference(b.indirect, a.indirect), 0.04);
  // Not so in the world's axes.
  EXPECT_GT(relativeDifference({b.visibility.begin() + 1, b.visibility.end()},
                               {a.visibility.begin() + 1, a.visibility.end() - 1}),
            0.1);
}

// ---- Which meshes, how many threads, what is refused -------------------------------------------------------------------

TEST(PrtGlossyBake, ShinyMeshesAloneGetMatrices) {
  const Scene scene = shinyScene();
  EXPECT_NEAR(greatestSpecular(scene, scene.materials[0]), 0.9f, 1e-5f);
  EXPECT_NEAR(greatestSpecular(scene, scene.materials[1]), 0.04f, 1e-5f);
  BakeOptions options = glossy(interreflected(1, 3, 512, 256));
  options.glossy = GlossyMeshes::kShiny;
  BakeReport report;
  const Scene baked = bakeTransfer(scene, options, {}, &report);
  EXPECT_FALSE(baked.meshes[0].transfer->glossy.empty());
  EXPECT_TRUE(baked.meshes[1].transfer->glossy.empty());
  EXPECT_FALSE(baked.meshes[2].transfer->glossy.empty());
  EXPECT_GT(report.glossy_points, 0u);
  EXPECT_LT(report.glossy_points, report.vertices);
  const BakeEstimate estimate = estimateBake(scene, options);
  EXPECT_EQ(estimate.glossy_vertices, scene.meshes[0].vertexCount() + scene.meshes[2].vertexCount());
  BakeOptions plain = options;
  plain.glossy = GlossyMeshes::kNone;
  EXPECT_GT(estimate.memory_bytes,
            estimateBake(scene, plain).memory_bytes + estimate.glossy_vertices * 81 * 12);
  EXPECT_TRUE(bakeTransfer(scene, plain).meshes[0].transfer->glossy.empty());
}

// V's own bands alone err by some percent: more than noise, less than would be useless.
TEST(PrtGlossyBake, CheapMatricesErrBySomePercent) {
  BakeReport report;
  bakeTransfer(crowdedScene(), glossy(shadowed(5, 4096)), {}, &report);
  EXPECT_GT(report.cheap_error, 0.03);
  EXPECT_LT(report.cheap_error, 0.10);
}

TEST(PrtGlossyBake, ABakedLobeMultipliesRows) {
  const Scene scene = shinyScene();
  BakeOptions options = glossy(interreflected(1, 5, 512, 256));
  options.glossy_exponent = 6.0f;
  const GlossyTransfer fixed = bakeTransfer(scene, options).meshes[2].transfer->glossy;
  EXPECT_EQ(fixed.exponent, 6.0f);
  // The lobes on the way are of that exponent too: a scene of such materials is the same.
  Scene same = scene;
  for (Material& material : same.materials) material.roughness = std::pow(2.0f / 8.0f, 0.25f);
  options.glossy_exponent = 0.0f;
  const GlossyTransfer chosen = bakeTransfer(same, options).meshes[2].transfer->glossy;
  for (std::size_t e = 0; e < 625; ++e) {
    const float factor = brdf::phongBandFactor(int(std::sqrt(float(e / 25) + 0.5f)), 6.0f);
    ASSERT_NEAR(indirectAt(fixed, 7, e, 1), factor * indirectAt(chosen, 7, e, 1), 2e-5f);
  }
}

TEST(PrtGlossyBake, SameBitsForThreadsAndAfterInterruptions) {
  const Scene scene = shinyScene();
  BakeOptions options = glossy(interreflected(2, 3, 1024, 512), 3, 4);
  options.threads = 1;
  const Scene one = bakeTransfer(scene, options);
  options.threads = 4;
  const Scene four = bakeTransfer(scene, options);
  options.threads = 0;
  options.checkpoint = std::filesystem::path(testing::TempDir()) / "prt_glossy.ckp";
  std::filesystem::remove(options.checkpoint);
  Scene resumed;
  int interruptions = 0;
  for (bool done = false; !done; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    Progress progress;
    int asked = 0;
    progress.should_stop = [&] { return ++asked > 25; };
    try {
      resumed = bakeTransfer(scene, options, progress);
      done = true;
    } catch (const Interrupted&) {
    }
  }
  EXPECT_GT(interruptions, 3);
  for (std::size_t m = 0; m < one.meshes.size(); ++m) {
    const GlossyTransfer& want = one.meshes[m].transfer->glossy;
    for (const Scene* other : std::initializer_list<const Scene*>{&four, &resumed}) {
      EXPECT_EQ(other->meshes[m].transfer->glossy.visibility, want.visibility);
      EXPECT_EQ(other->meshes[m].transfer->glossy.indirect, want.indirect);
      EXPECT_EQ(other->meshes[m].transfer->indirect, one.meshes[m].transfer->indirect);
    }
  }
}

TEST(PrtGlossyBake, OptionsOutOfRangeAreRefused) {
  const Scene scene = sceneOf(sphereMesh(4, 8));
  const auto refused = [&](const BakeOptions& options, const char* part) {
    try {
      estimateBake(scene, options);
    } catch (const Error& error) {
      return std::string(error.what()).find(part) != std::string::npos;
    }
    return false;
  };
  BakeOptions options = glossy(shadowed(4, 512));
  options.glossy_order = 7;
  EXPECT_TRUE(refused(options, "glossy_order is 7"));
  options.glossy_order = 3;
  options.glossy_light_order = 4;
  EXPECT_TRUE(refused(options, "glossy_light_order is 4; expected 3 to 3"));
  options.glossy_light_order = 0;
  options.glossy_exponent = 0.5f;
  EXPECT_TRUE(refused(options, "glossy_exponent is 0.5"));
  options.glossy_exponent = NAN;
  EXPECT_TRUE(refused(options, "glossy_exponent is nan"));
}

}  // namespace
}  // namespace gloam::prt
