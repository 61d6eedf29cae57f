// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baked transfer against the path tracer, vertex by vertex, under the same SH light: what one dot product gives at a vertex
// of a body with hollows must be the irradiance that paths find there. The light has as many bands as the transfer, so
// nothing of it is lost; what may differ is the baker's quadrature and, with bounces, its interpolation between vertices.
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <numbers>

#include "reference/integrator.h"
#include "scene/environment.h"

namespace gloam {
namespace {

constexpr int kOrder = 5, kSamples = 1024;
constexpr std::size_t kVertices = 400;

Scene hollowBody() {
  Scene scene = loadScene("builtin:furnace-concave");
  for (Material& material : scene.materials) material.base_color = {0.8f, 0.6f, 0.4f, 1.0f};
  return scene;
}

// A bright side, a dark side and some detail, far from symmetric.
Environment unevenSky() {
  Environment sky = loadEnvironment("sky:preetham?elevation=35&turbidity=4");
  sky.rotation_rad = 0.7f;
  return sky;
}

/// What one dot product gives.
glm::vec3 irradiance(const Transfer& transfer, const sh::ShRgb& light, std::size_t vertex, bool bounced) {
  constexpr std::size_t kCoefficients = kOrder * kOrder;
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < kCoefficients; ++i) {
    const float direct = transfer.direct[vertex * kCoefficients + i];
    glm::vec3 row(direct);
    if (bounced) {
      const float* indirect = &transfer.indirect[(vertex * kCoefficients + i) * 3];
      row += glm::vec3(indirect[0], indirect[1], indirect[2]);
    }
    sum += row * light[int(i)];
  }
  return sum;
}

/// A vertex as the path tracer sees it: in one of its triangles, the vertex's own normal for both normals, as in a bake.
reference::CameraPoint pointAt(const Mesh& mesh, std::size_t corner) {
  const std::uint32_t vertex = mesh.indices[corner];
  reference::CameraPoint point;
  point.instance = 0;
  point.triangle = int(corner / 3);
  point.u = corner % 3 == 1 ? 1.0f : 0.0f;
  point.v = corner % 3 == 2 ? 1.0f : 0.0f;
  point.eye_depth = 1.0f;
  point.position = mesh.positions[vertex];
  point.normal = point.geometric_normal = point.to_eye = glm::normalize(mesh.normals[vertex]);
  point.albedo = glm::vec3(0.8f, 0.6f, 0.4f);
  return point;
}

/// sqrt(sum (prt - reference)^2 / sum reference^2). Two independent references take the noise out of the square.
double relativeRmse(bool bounced) {
  const Scene scene = hollowBody();
  BakeOptions bake;
  bake.kind = bounced ? TransferKind::kInterreflected : TransferKind::kShadowed;
  bake.order = kOrder;
  bake.bounces = 2;
  bake.directions = 8192;
  const Scene baked = bakeTransfer(scene, bake);
  const Mesh& mesh = baked.meshes.at(0);
  const PosedScene posed = pose(baked, 0.0f);
  EXPECT_EQ(posed.instances.size(), 1u);
  EXPECT_EQ(posed.instances[0].world_from_object, glm::mat4(1.0f));

  const Environment sky = unevenSky();
  ReferenceOptions options;
  options.bounces = bounced ? bake.bounces : 0;
  options.environment_order = kOrder;
  const reference::Integrator integrator(baked, posed, framingCamera(posed, 1.0f), sky, options, {});
  const sh::ShRgb light = projectEnvironment(sky, kOrder);

  const std::size_t count = std::min(kVertices, mesh.indices.size()), step = mesh.indices.size() / count;
  std::vector<double> squared(count), reference_squared(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    const std::size_t corner = i * step;
    const reference::CameraPoint point = pointAt(mesh, corner);
    glm::vec3 found[2] = {};
    std::size_t rays = 0;
    for (std::uint32_t replicate = 0; replicate < 2; ++replicate) {
      for (std::uint32_t k = 0; k < kSamples; ++k) {
        const reference::PathLight paths =
            integrator.trace(point, 0, 0, std::uint32_t(2 * i) + replicate, k, rays);
        for (int bounces = 0; bounces <= options.bounces; ++bounces)
          found[replicate] += paths[std::size_t(pathAfter(reference::kEnvironmentDirect, bounces))];
      }
      found[replicate] *= float(std::numbers::pi / kSamples) / point.albedo;
    }
    const glm::vec3 baked_light = irradiance(*mesh.transfer, light, mesh.indices[corner], bounced);
    squared[i] = glm::dot(baked_light - found[0], baked_light - found[1]);
    reference_squared[i] = glm::dot(found[0], found[1]);
  });
  double numerator = 0.0, denominator = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    numerator += squared[i];
    denominator += reference_squared[i];
  }
  return std::sqrt(std::max(0.0, numerator) / denominator);
}

TEST(TransferAgainstPaths, ShadowedIsWithinOnePercentAtVertices) {
  const double error = relativeRmse(false);
  std::printf("DS against paths: relative RMSE %.3f %% at vertices\n", 100.0 * error);
  EXPECT_LT(error, 0.01);
}

TEST(TransferAgainstPaths, InterreflectedIsWithinOnePercentAtVertices) {
  const double error = relativeRmse(true);
  std::printf("DI against paths: relative RMSE %.3f %% at vertices\n", 100.0 * error);
  EXPECT_LT(error, 0.01);
}

}  // namespace
}  // namespace gloam
