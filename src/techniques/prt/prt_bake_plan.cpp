// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_bake_points.h"

namespace gloam {
namespace prt {
namespace {

void checkRange(const char* name, int value, int low, int high) {
  if (value < low || value > high) {
    throw Error("bake", fmt::format("{} is {}; expected {} to {}", name, value, low, high));
  }
}

void checkGlossyOptions(const BakeOptions& options) {
  if (options.glossy == GlossyMeshes::kNone) return;
  if (options.glossy_order != 0) checkRange("glossy_order", options.glossy_order, 3, 6);
  const int most = std::min(options.order, options.glossy_order > 0 ? options.glossy_order : options.order);
  if (options.glossy_light_order != 0) checkRange("glossy_light_order", options.glossy_light_order, 3, most);
  const float exponent = options.glossy_exponent;
  if (exponent != 0.0f && !(exponent >= 1.0f && exponent <= 1000.0f)) {
    throw Error("bake", fmt::format("glossy_exponent is {}; expected 1 to 1000, or 0", exponent));
  }
}

void checkTexelOptions(const BakeOptions& options) {
  if (options.texels != 0) checkRange("texels", options.texels, kLeastTexels, kMostTexels);
  checkRange("uv_set", options.uv_set, 0, 7);
  const float density = options.texels_per_metre;
  if (!(density >= 0.0f && density <= 1.0e6f)) {
    throw Error("bake", fmt::format("texels_per_metre is {}; expected up to 1000000, or 0", density));
  }
}

}  // namespace

void checkOptions(const BakeOptions& options) {
  checkTexelOptions(options);
  checkRange("order", options.order, 3, 6);
  checkRange("directions", options.directions, 256, 65536);
  checkRange("threads", options.threads, 0, 1024);
  checkGlossyOptions(options);
  const float error = options.error;
  if (error != 0.0f && !(error >= 1.0e-5f && error <= 1.0f))
    throw Error("bake", fmt::format("error is {}; expected 1e-5 to 1, or 0", error));
  if (error > 0.0f && options.kind != TransferKind::kUnshadowed)
    checkRange("directions with error", options.directions, kLeastDirectionsOfError, 65536);
  if (options.kind != TransferKind::kInterreflected) return;
  checkRange("bounces", options.bounces, 1, 64);
  if (options.bounce_directions != 0) checkRange("bounce_directions", options.bounce_directions, 64, 65536);
}

// Some rays from some points: in the open about half of the directions above a floor meet anything, in rooms nearly all.
BakeOptions withBounceDirections(const Scene& scene, BakeOptions options) {
  constexpr int kOpen = 1024, kRoom = 256, kRays = 64;
  constexpr std::size_t kPoints = 256, kMostTriangles = 4000000;
  constexpr double kRoomShare = 0.8;
  if (options.bounce_directions != 0) return options;
  options.bounce_directions = kOpen;
  if (bouncesOf(options) == 0 || options.apart || options.error > 0.0f) return options;
  const PosedScene posed = pose(scene, options.time_s);
  const std::vector<std::uint8_t> glossy = glossyInstances(scene, posed, options.glossy);
  if (std::ranges::find(glossy, 1) != glossy.end()) return options;
  const BakePoints points = makeBakePoints(scene, posed);
  if (points.size() == 0 || points.triangles.size() > kMostTriangles) return options;
  const trace::Tracer tracer(scene, posed, {.reproducible = true, .rigid_only = true});
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(kRays);
  const std::size_t count = std::min(kPoints, points.size());
  std::size_t above = 0, blocked = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t point = k * points.size() / count;
    for (const glm::vec3& direction : directions) {
      if (!(glm::dot(direction, points.normals[point]) > 0.0f)) continue;
      ++above;
      blocked += tracer.occluded({.origin = rayOrigin(points, point), .direction = direction}) ? 1 : 0;
    }
  }
  if (double(blocked) > kRoomShare * double(above)) options.bounce_directions = kRoom;
  return options;
}

int bouncesOf(const BakeOptions& options) {
  return options.kind == TransferKind::kInterreflected ? options.bounces : 0;
}

DirectionTables tablesFor(const BakeOptions& options) {
  const bool in_steps = options.error > 0.0f;  // bounces may need all directions then
  return makeDirectionTables(
      options.order, options.directions,
      in_steps ? options.directions : std::min(options.bounce_directions, options.directions), in_steps);
}

bool followsMirrors(const Scene& scene, const PosedScene& posed, const BakeOptions& options) {
  if (!options.caustics || bouncesOf(options) == 0) return false;
  return std::ranges::any_of(posed.instances, [&](const Instance& instance) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    return !instance.deformed() && !mesh.indices.empty() &&
           greatestSpecular(scene, scene.materials[std::size_t(mesh.material)]) >= kShinySpecular;
  });
}

std::size_t keptHitsBytes(std::size_t least_memory_bytes, const BakeOptions& options) {
  if (options.memory_bytes == 0) return kKeptHitsBytes;
  constexpr double kMiB = 1024.0 * 1024.0;
  if (options.memory_bytes < least_memory_bytes) {
    throw Error(
        "bake",
        fmt::format("memory_bytes is {:.0f} MiB; this bake takes {:.0f} MiB or more: fewer bands, or no "
                    "matrices, take less",
                    std::floor(double(options.memory_bytes) / kMiB),
                    std::ceil(double(least_memory_bytes) / kMiB)));
  }
  return std::min(kKeptHitsBytes, options.memory_bytes - least_memory_bytes);
}

}  // namespace prt
}  // namespace gloam
