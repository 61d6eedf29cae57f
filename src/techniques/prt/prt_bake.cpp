// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking transfer: Sloan, Kautz, Snyder 2002, section 5 (PRT-1, PRT-3). prt_bake_passes.cpp has the mathematics.
#include <fmt/format.h>
#include <gloam/bake.h>
#include <gloam/sh.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <optional>

#include "scene/threads.h"
#include "scene/transforms.h"
#include "techniques/prt/prt_bake_apart.h"
#include "techniques/prt/prt_bake_edges.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_meter.h"
#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_bake_plan.h"
#include "techniques/prt/prt_bake_texels.h"

namespace gloam {
namespace {

using namespace prt;

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

// What each pass costs in shadow rays: bounce rays are fewer, but closest hits and their gathering take about four times
// as long as shadow rays; a third of the hemisphere is blocked in a common scene; later bounces find their hits kept.
// Matrices take several times as long to gather as rays to trace.
std::vector<double> passWork(const DirectionTables& tables, int bounces, double glossy_share) {
  const double trace = 4.0 / 3.0 * double(tables.bounce_tiles), gather = 8.0 * glossy_share * trace;
  std::vector<double> work(std::size_t(bounces) + 1, trace + gather);
  for (std::size_t b = 2; b < work.size(); ++b) work[b] = 0.25 * trace + gather;
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
  if (state.pass == state.bounces) meter.lastPassDone();
  return rays;
}

void runPasses(BakePasses& passes, BakeState& state, BakeMeter& meter, BakeReport& report) {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto since = [&](auto start) { return std::chrono::duration<double>(now() - start).count(); };
  while (state.pass <= state.bounces) {
    const auto start = now();
    if (state.pass == 0) {
      report.rays = runPass(state, meter, [&](std::size_t b) { return passes.shadowBlock(b, state); });
      passes.fillHidden(state, {state.direct, std::size_t(state.coefficients)});
      if (!state.glossy.empty()) {
        passes.fillHidden(state,
                          {state.glossy.visibility, state.glossy.layout.visibilityCount(), &state.glossy});
      }
      report.first_pass_s = since(start);
    } else {
      report.bounce_rays +=
          runPass(state, meter, [&](std::size_t b) { return passes.bounceBlock(b, state); });
      passes.fillHidden(state, {state.next, state.row});
      if (!state.glossy.empty()) {
        passes.fillHidden(state, {state.glossy.next, state.glossy.layout.matrixSize(), &state.glossy});
      }
      report.bounce_s.push_back(since(start));
      report.bounces_s += report.bounce_s.back();
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

int mostDirections(const BakeState& state) {
  std::uint32_t most = 0;
  for (const RaySite& site : state.sites) most = std::max(most, site.tiles);
  return int(most) * kTileSize;
}

void reportDirections(const BakeState& state, const DirectionTables& tables, const BakeOptions& options,
                      BakeReport& report) {
  double tiles = 0.0, squares = 0.0;
  for (const RaySite& site : state.sites) {
    tiles += double(site.tiles);
    squares += double(site.error) * double(site.error);
    if (options.error > 0.0f && site.error > options.error) ++report.above_error;
  }
  const double points = double(std::max<std::size_t>(1, state.points));
  report.most_directions = mostDirections(state);
  report.mean_directions = tiles / points * kTileSize;
  report.rays_saved = std::size_t((double(tables.tiles) * double(state.points) - tiles) * kTileSize / 2.0);
  report.error = std::sqrt(squares / points);
}

void attachTransfer(Scene& scene, const PosedScene& posed, const BakePoints& points, const BakeState& state,
                    const BakeOptions& options) {
  const std::vector<std::uint8_t> glossy = glossyInstances(scene, posed, options.glossy);
  const std::size_t coefficients = std::size_t(state.coefficients);
  for (std::size_t i = 0; i < posed.instances.size(); ++i) {
    const Instance& instance = posed.instances[i];
    Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (instance.deformed() || mesh.indices.empty()) continue;
    auto transfer = std::make_shared<Transfer>();
    transfer->order = options.order;
    transfer->bounces = state.bounces;
    transfer->directions = mostDirections(state);
    const TexelMap* texels = points.hasTexels(i) ? &points.texel_maps[i] : nullptr;
    if (texels) {
      transfer->texel_width = texels->width;
      transfer->texel_height = texels->height;
      transfer->uv_set = texels->uv_set;
    }
    const std::size_t count = texels ? texels->points.size() : mesh.vertexCount();
    transfer->direct.resize(count * coefficients);
    if (state.bounces > 0) transfer->indirect.resize(count * coefficients * 3);
    const auto object_from_world =
        sh::makeRotation(options.order, glm::transpose(rotationFactor(instance.world_from_object)));
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t v) {
      const std::uint32_t point =
          texels ? texels->points[v] : points.point_of_vertex[points.first_vertex[i] + v];
      if (point != BakePoints::kNoPoint) writeVertex(state, point, object_from_world, v, *transfer);
    });
    if (glossy[i]) {
      const glm::mat3 turn = glm::transpose(rotationFactor(instance.world_from_object));
      writeGlossy(state.glossy, points, points.first_vertex[i], mesh.vertexCount(),
                  sh::HighRotation(state.glossy.layout.visibilityOrder(), turn), options.glossy_exponent,
                  transfer->glossy);
    }
    mesh.transfer = std::move(transfer);
  }
}

void bakeUnshadowed(const BakePoints& points, const BakeOptions& options, BakeState& state) {
  const sh::Zh cosine = sh::clampedCosine(options.order);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const sh::Sh unshadowed = sh::rotateZonal(cosine, points.normals[p]);
    std::copy_n(unshadowed.c.data(), state.coefficients, &state.direct[p * std::size_t(state.coefficients)]);
    if (!state.glossy.has(p)) continue;
    const std::size_t count = state.glossy.layout.visibilityCount();
    sh::hemisphereHigh(state.glossy.layout.visibilityOrder(), points.normals[p],
                       {&state.glossy.visibility[state.glossy.first_row[p] * count], count});
  }
}

void bakeShadowed(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                  const DirectionTables& tables, const BakeOptions& options, const Progress& progress,
                  BakeState& state, BakeReport& report) {
  Fingerprint fingerprint;
  if (!options.checkpoint.empty()) {
    fingerprint = fingerprintOf(scene, points, options);
    report.resumed = readCheckpoint(options.checkpoint, fingerprint, state);
  }
  const trace::Tracer tracer(scene, posed, {.reproducible = true, .rigid_only = true}, progress);
  std::optional<GlossyTables> glossy;
  if (!state.glossy.empty()) glossy.emplace(state.glossy.layout, tables);
  if (glossy) {
    glossy->instances = glossyInstances(scene, posed, options.glossy);
    glossy->exponent = options.glossy_exponent;
  }
  const PassSettings settings{.bounces = state.bounces,
                              .caustics = options.caustics,
                              .error = options.error,
                              .kept_bytes = keptHitsBytes(leastMemory(scene, options), options),
                              .turned = true};
  BakePasses passes(scene, posed, points, tracer, tables, settings, glossy ? &*glossy : nullptr);
  const double glossy_share = double(state.glossy.rows()) / double(std::max<std::size_t>(1, points.size()));
  BakeMeter meter(progress, options, fingerprint, state, passWork(tables, state.bounces, glossy_share));
  runPasses(passes, state, meter, report);
  std::error_code ignored;
  // Objects that are done wait for the others.
  if (!options.checkpoint.empty() && !options.apart && !options.keep_checkpoint)
    std::filesystem::remove(options.checkpoint, ignored);
}

}  // namespace

static Scene bakeOne(const Scene& scene, const BakeOptions& options, const Progress& progress,
                     BakeReport& done) {
  Scene unique = makeInstancesUnique(scene);
  const PosedScene posed = pose(unique, options.time_s);
  checkBakeable(unique, posed);
  warnOfCrowdedEdges(unique, posed, done.warnings);
  BakePoints points = makeBakePoints(unique, posed);
  addTexels(points, unique, posed, chooseLightmaps(unique, posed, options, done.warnings));
  const DirectionTables tables = tablesFor(options);
  BakeState state =
      makeBakeState(points.size(), tables, bouncesOf(options), followsMirrors(unique, posed, options));
  state.glossy = makeGlossyState(unique, posed, points, options);
  done.vertices = points.size();
  done.texels = points.on_faces.size();
  done.bounce_directions = state.bounces > 0 ? tables.bounce_tiles * kTileSize : 0;
  withThreads(options.threads, [&] {
    if (options.kind == TransferKind::kUnshadowed) {
      bakeUnshadowed(points, options, state);
    } else {
      bakeShadowed(unique, posed, points, tables, options, progress, state, done);
      reportDirections(state, tables, options, done);
    }
    for (std::vector<float>* unneeded :
         {&state.previous, &state.next, &state.glossy.previous, &state.glossy.next})
      std::vector<float>().swap(*unneeded);
    done.glossy_points = state.glossy.rows();
    done.cheap_error = cheapError(state.glossy);
    attachTransfer(unique, posed, points, state, options);
  });
  return unique;
}

Scene bakeTransfer(const Scene& scene, const BakeOptions& given, const Progress& progress,
                   BakeReport* report) {
  checkOptions(given);
  const BakeOptions options = withBounceDirections(scene, given);
  if (options.memory_bytes > 0) keptHitsBytes(leastMemory(scene, options), options);
  BakeReport local;
  BakeReport& done = report ? *report : local;
  done = {};
  if (wantsTexels(options)) requireLightmaps(scene, pose(scene, options.time_s), options);
  if (!options.apart) return bakeOne(scene, options, progress, done);
  Scene unique = makeInstancesUnique(scene);
  checkBakeable(unique, pose(unique, options.time_s));
  return bakeApart(std::move(unique), options, progress, done, bakeOne);
}

}  // namespace gloam
