// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking transfer: Sloan, Kautz, Snyder 2002, section 5 (PRT-1, PRT-3). prt_bake_passes.cpp has the mathematics.
#include <fmt/format.h>
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <thread>

#include "scene/transforms.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_meter.h"
#include "techniques/prt/prt_bake_passes.h"

namespace gloam {
namespace {

using namespace prt;

void checkRange(const char* name, int value, int low, int high) {
  if (value < low || value > high) {
    throw Error("bake", fmt::format("{} is {}; expected {} to {}", name, value, low, high));
  }
}

void checkOptions(const BakeOptions& options) {
  checkRange("order", options.order, 3, 6);
  checkRange("directions", options.directions, 256, 65536);
  checkRange("threads", options.threads, 0, 1024);
  if (options.kind != TransferKind::kInterreflected) return;
  checkRange("bounces", options.bounces, 1, 64);
  checkRange("bounce_directions", options.bounce_directions, 64, 65536);
}

int bouncesOf(const BakeOptions& options) {
  return options.kind == TransferKind::kInterreflected ? options.bounces : 0;
}

int bounceDirectionsOf(const BakeOptions& options) {
  return std::min(options.bounce_directions, options.directions);
}

void checkBakeable(const Scene& scene, const PosedScene& posed) {
  const std::string place = scene.name.empty() ? "bake" : scene.name;
  bool has_triangles = false;
  for (const Instance& instance : posed.instances) {
    if (scene.meshes[std::size_t(instance.mesh)].indices.empty()) continue;
    if (!instance.deformed()) return;
    has_triangles = true;
  }
  throw Error(place, has_triangles
                         ? "all meshes are skinned or morphed; transfer can be baked for rigid ones only"
                         : "the scene has no triangles to bake");
}

int coresUsed(const BakeOptions& options) {
  return options.threads > 0 ? options.threads : std::max(1, int(std::thread::hardware_concurrency()));
}

// What each pass costs in shadow rays: bounce rays are fewer, but closest hits and their gathering take about four times
// as long as shadow rays; a third of the hemisphere is blocked in a common scene; later bounces find their hits kept.
std::vector<double> passWork(const DirectionTables& tables, int bounces) {
  std::vector<double> work(std::size_t(bounces) + 1, 4.0 / 3.0 * double(tables.bounce_tiles));
  for (std::size_t b = 2; b < work.size(); ++b) work[b] *= 0.25;
  work[0] = double(tables.tiles);
  return work;
}

// All blocks of the pass that are not done, on all cores. Returns the number of rays.
template <class Work>
std::size_t runPass(BakeState& state, BakeMeter& meter, const Work& work) {
  std::atomic<std::size_t> rays{0};
  std::atomic<bool> stop{false};
  meter.beginPass();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, state.blocks, 1),
      [&](const auto& range) {
        for (std::size_t b = range.begin(); b != range.end() && !stop; ++b) {
          if (state.block_done[b].load(std::memory_order_relaxed)) continue;
          const std::size_t traced = work(b);
          rays += traced;
          state.block_done[b].store(1, std::memory_order_release);
          if (!meter.blockDone(traced)) stop = true;
        }
      },
      tbb::simple_partitioner());
  if (stop) meter.interrupt();
  return rays;
}

void runPasses(BakePasses& passes, BakeState& state, BakeMeter& meter, BakeReport& report) {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto since = [&](auto start) { return std::chrono::duration<double>(now() - start).count(); };
  while (state.pass <= state.bounces) {
    const auto start = now();
    if (state.pass == 0) {
      report.rays = runPass(state, meter, [&](std::size_t b) { return passes.shadowBlock(b, state); });
      passes.fillHidden(state, std::size_t(state.coefficients), state.direct);
      report.first_pass_s = since(start);
    } else {
      report.bounce_rays +=
          runPass(state, meter, [&](std::size_t b) { return passes.bounceBlock(b, state); });
      passes.fillHidden(state, state.row, state.next);
      report.bounces_s += since(start);
    }
    state.finishPass();
  }
}

// World to the object's own axes: f_object(s) = f_world(Q s), Q the rotation that the instance's matrix holds.
void writeVertex(const BakeState& state, std::size_t point, const sh::Rotation& object_from_world,
                 std::size_t vertex, Transfer& transfer) {
  const std::size_t coefficients = std::size_t(state.coefficients), stride = rowStride(state.coefficients);
  sh::Sh direct(transfer.order);
  sh::ShRgb indirect(transfer.order);
  for (std::size_t i = 0; i < coefficients; ++i) {
    direct.c[i] = state.direct[point * coefficients + i];
    if (state.bounces == 0) continue;
    const float* row = &state.indirect[point * state.row + i];
    indirect.c[i] = {row[0], row[stride], row[2 * stride]};
  }
  direct = sh::rotate(object_from_world, direct);
  std::copy_n(direct.c.data(), coefficients, &transfer.direct[vertex * coefficients]);
  if (state.bounces == 0) return;
  indirect = sh::rotate(object_from_world, indirect);
  std::copy_n(&indirect.c[0].x, 3 * coefficients, &transfer.indirect[vertex * 3 * coefficients]);
}

void attachTransfer(Scene& scene, const PosedScene& posed, const BakePoints& points, const BakeState& state,
                    const BakeOptions& options) {
  const std::size_t coefficients = std::size_t(state.coefficients);
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const Instance& instance = posed.instances[i];
    Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (instance.deformed() || mesh.indices.empty()) continue;
    auto transfer = std::make_shared<Transfer>();
    transfer->order = options.order;
    transfer->bounces = state.bounces;
    transfer->directions = (options.directions + kTileSize - 1) / kTileSize * kTileSize;
    transfer->direct.resize(mesh.vertexCount() * coefficients);
    if (state.bounces > 0) transfer->indirect.resize(mesh.vertexCount() * coefficients * 3);
    const auto object_from_world =
        sh::makeRotation(options.order, glm::transpose(rotationFactor(instance.world_from_object)));
    tbb::parallel_for(std::size_t(0), mesh.vertexCount(), [&](std::size_t v) {
      const std::uint32_t point = points.point_of_vertex[points.first_vertex[i] + v];
      if (point != BakePoints::kNoPoint) writeVertex(state, point, object_from_world, v, *transfer);
    });
    mesh.transfer = std::move(transfer);
  }
}

void bakeUnshadowed(const BakePoints& points, const BakeOptions& options, BakeState& state) {
  const sh::Zh cosine = sh::clampedCosine(options.order);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const sh::Sh unshadowed = sh::rotateZonal(cosine, points.normals[p]);
    std::copy_n(unshadowed.c.data(), state.coefficients, &state.direct[p * std::size_t(state.coefficients)]);
  }
}

void bakeShadowed(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                  const DirectionTables& tables, const BakeOptions& options, const Progress& progress,
                  BakeState& state, BakeReport& report) {
  Fingerprint fingerprint;
  if (!options.checkpoint.empty()) {
    fingerprint = fingerprintOf(scene, posed, points, options);
    report.resumed = readCheckpoint(options.checkpoint, fingerprint, state);
  }
  const trace::Tracer tracer(scene, posed, {.reproducible = true, .rigid_only = true}, progress);
  BakePasses passes(scene, posed, points, tracer, tables);
  BakeMeter meter(progress, options, fingerprint, state, passWork(tables, state.bounces));
  runPasses(passes, state, meter, report);
  std::error_code ignored;
  if (!options.checkpoint.empty()) std::filesystem::remove(options.checkpoint, ignored);
}

}  // namespace

BakeEstimate estimateBake(const Scene& scene, const BakeOptions& options) {
  checkOptions(options);
  const PosedScene posed = pose(scene, options.time_s);
  BakeEstimate estimate;
  for (const Instance& instance : posed.instances) {
    if (instance.deformed()) continue;
    estimate.vertices += scene.meshes[std::size_t(instance.mesh)].vertexCount();
    estimate.triangles += scene.meshes[std::size_t(instance.mesh)].triangleCount();
  }
  const DirectionTables tables =
      makeDirectionTables(options.order, options.directions, bounceDirectionsOf(options));
  if (options.kind != TransferKind::kUnshadowed) {
    estimate.rays = estimate.vertices * std::size_t(tables.tiles) * kTileSize / 2;
  }
  const std::size_t coefficients = std::size_t(tables.coefficients);
  const std::size_t colors = options.kind == TransferKind::kInterreflected ? 4 : 1;
  const std::size_t transfer = estimate.vertices * coefficients * colors * sizeof(float);
  // Per triangle: the hierarchy (130 bytes, measured), the points' own lists; per vertex: positions, normals, tangents,
  // texture coordinates of the unique copy and the table that welds.
  const std::size_t hits = estimate.vertices * std::size_t(tables.bounce_tiles) * kTileSize / 2;
  const std::size_t kept = bouncesOf(options) > 1 ? std::min(kKeptHitsBytes, hits * sizeof(GatheredHit)) : 0;
  estimate.memory_bytes = kept + bakeStateBytes(estimate.vertices, tables, bouncesOf(options)) +
                          tables.memoryBytes() + transfer + estimate.triangles * (130 + 40) +
                          estimate.vertices * (60 + 90);
  estimate.file_bytes = transfer + estimate.triangles * 12 + estimate.vertices * 48;
  for (const Texture& texture : scene.textures) estimate.file_bytes += texture.rgba.size() / 2;
  return estimate;
}

Scene bakeTransfer(const Scene& scene, const BakeOptions& options, const Progress& progress,
                   BakeReport* report) {
  checkOptions(options);
  Scene unique = makeInstancesUnique(scene);
  const PosedScene posed = pose(unique, options.time_s);
  checkBakeable(unique, posed);
  const BakePoints points = makeBakePoints(unique, posed);
  const DirectionTables tables =
      makeDirectionTables(options.order, options.directions, bounceDirectionsOf(options));
  BakeState state = makeBakeState(points.size(), tables, bouncesOf(options));
  BakeReport local;
  BakeReport& done = report ? *report : local;
  done = {};
  done.vertices = points.size();
  // More threads than cores are given if asked for: that the result does not depend on them has to be testable.
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    std::size_t(coresUsed(options)));
  tbb::task_arena(coresUsed(options)).execute([&] {
    if (options.kind == TransferKind::kUnshadowed) {
      bakeUnshadowed(points, options, state);
    } else {
      bakeShadowed(unique, posed, points, tables, options, progress, state, done);
    }
    attachTransfer(unique, posed, points, state, options);
  });
  return unique;
}

}  // namespace gloam
