// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "techniques/prt/prt_bake_passes.h"

namespace gloam {
namespace prt {
namespace {

/// What the program itself takes: code, libraries, a stack a thread.
constexpr std::size_t kProgramBytes = std::size_t(24) << 20;

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
  if (options.kind != TransferKind::kInterreflected) return;
  checkRange("bounces", options.bounces, 1, 64);
  checkRange("bounce_directions", options.bounce_directions, 64, 65536);
}

int bouncesOf(const BakeOptions& options) {
  return options.kind == TransferKind::kInterreflected ? options.bounces : 0;
}

DirectionTables tablesFor(const BakeOptions& options) {
  // Where each point takes as many directions as it needs, bounces may need all of them; those of matrices take the same
  // subset everywhere.
  const bool in_steps = options.error > 0.0f;
  const bool all = in_steps && options.glossy == GlossyMeshes::kNone;
  return makeDirectionTables(
      options.order, options.directions,
      all ? options.directions : std::min(options.bounce_directions, options.directions), in_steps);
}

bool followsMirrors(const Scene& scene, const PosedScene& posed, const BakeOptions& options) {
  if (!options.caustics || bouncesOf(options) == 0) return false;
  return std::ranges::any_of(posed.instances, [&](const Instance& instance) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    return !instance.deformed() && !mesh.indices.empty() &&
           greatestSpecular(scene, scene.materials[std::size_t(mesh.material)]) >= kShinySpecular;
  });
}

std::size_t keptHitsBytes(const BakeEstimate& estimate, const BakeOptions& options) {
  if (options.memory_bytes == 0) return kKeptHitsBytes;
  constexpr double kMiB = 1024.0 * 1024.0;
  if (options.memory_bytes < estimate.least_memory_bytes) {
    throw Error(
        "bake",
        fmt::format("memory_bytes is {:.0f} MiB; this bake takes {:.0f} MiB or more: fewer bands, or no "
                    "matrices, take less",
                    std::floor(double(options.memory_bytes) / kMiB),
                    std::ceil(double(estimate.least_memory_bytes) / kMiB)));
  }
  return std::min(kKeptHitsBytes, options.memory_bytes - estimate.least_memory_bytes);
}

}  // namespace prt

using namespace prt;

BakeEstimate estimateBake(const Scene& scene, const BakeOptions& options) {
  checkOptions(options);
  const PosedScene posed = pose(scene, options.time_s);
  BakeEstimate estimate;
  if (wantsTexels(options)) estimate.texels = countTexels(scene, posed, options);
  const std::vector<std::uint8_t> glossy = glossyInstances(scene, posed, options.glossy);
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const Instance& instance = posed.instances[i];
    if (instance.deformed()) continue;
    if (glossy[i]) estimate.glossy_vertices += scene.meshes[std::size_t(instance.mesh)].vertexCount();
    estimate.vertices += scene.meshes[std::size_t(instance.mesh)].vertexCount();
    estimate.triangles += scene.meshes[std::size_t(instance.mesh)].triangleCount();
  }
  const std::size_t points = estimate.vertices + estimate.texels;
  const DirectionTables tables = tablesFor(options);
  if (options.kind != TransferKind::kUnshadowed) {
    estimate.rays = points * std::size_t(tables.tiles) * kTileSize / 2;
  }
  const std::size_t coefficients = std::size_t(tables.coefficients);
  const std::size_t colors = options.kind == TransferKind::kInterreflected ? 4 : 1;
  const GlossyLayout layout = glossyLayout(options);
  const bool bounces = options.kind == TransferKind::kInterreflected;
  const std::size_t matrices =
      layout.visibilityCount() + (bounces ? std::size_t(3 * layout.lightCount() * layout.fieldCount()) : 0);
  const std::size_t transfer =
      (points * coefficients * colors + estimate.glossy_vertices * matrices) * sizeof(float);
  // Per triangle: the hierarchy (130 bytes, measured), the points' own lists; per vertex: positions, normals, tangents,
  // texture coordinates of the unique copy and the table that welds.
  const std::size_t hits = points * std::size_t(tables.bounce_tiles) * kTileSize / 2;
  const std::size_t hit = estimate.glossy_vertices > 0 ? sizeof(GlossyHit) : sizeof(GatheredHit);
  // Hits of the sky by way of mirrors come on top, of those that mirrors take from surfaces.
  const bool mirrors = followsMirrors(scene, posed, options);
  const std::size_t kept = hits * (hit + (mirrors ? sizeof(SkyHit) / 2 : 0));
  if (estimate.glossy_vertices > 0) {
    estimate.least_memory_bytes = estimate.glossy_vertices * glossyStateBytes(layout, bounces) +
                                  GlossyTables::memoryBytes(layout, tables.tiles);
  }
  estimate.least_memory_bytes += kProgramBytes + bakeStateBytes(points, tables, bouncesOf(options), mirrors) +
                                 tables.memoryBytes() + transfer + estimate.triangles * (130 + 40) +
                                 estimate.vertices * (60 + 90) + estimate.texels * (sizeof(FacePoint) + 60);
  estimate.memory_bytes = estimate.least_memory_bytes;
  if (bouncesOf(options) > 1) {
    std::size_t most = kKeptHitsBytes;
    if (options.memory_bytes > 0)
      most =
          std::min(most, options.memory_bytes - std::min(options.memory_bytes, estimate.least_memory_bytes));
    estimate.memory_bytes += std::min(most, kept);
  }
  estimate.file_bytes = transfer + estimate.triangles * 12 + estimate.vertices * 48;
  for (const Texture& texture : scene.textures) estimate.file_bytes += texture.rgba.size() / 2;
  return estimate;
}

}  // namespace gloam
