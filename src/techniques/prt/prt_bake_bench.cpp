// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_bench.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <limits>
#include <optional>
#include <thread>

#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_passes.h"
#include "techniques/prt/prt_bake_plan.h"

namespace gloam {
namespace {

using namespace prt;

// One point's packets, found beforehand: what is timed is the tracing alone.
struct PointPackets {
  glm::vec3 origin;
  std::vector<std::int32_t> tiles;
  std::vector<std::uint16_t> above;
};

std::vector<PointPackets> packetsOf(const BakePoints& points, const DirectionTables& tables,
                                    const BakeState& state, std::size_t block) {
  std::vector<PointPackets> packets;
  for (std::size_t p = state.blockBegin(block); p < state.blockEnd(block); ++p) {
    PointPackets& of_point = packets.emplace_back();
    of_point.origin = state.sites[p].origin;
    of_point.tiles.resize(std::size_t(tables.tiles));
    of_point.above.resize(std::size_t(tables.tiles));
    const int count = tilesAbove(tables, points.normals[p], of_point.tiles.data(), of_point.above.data());
    of_point.tiles.resize(std::size_t(count));
    of_point.above.resize(std::size_t(count));
  }
  return packets;
}

void traceBare(const trace::Tracer& tracer, const DirectionTables& tables, const PointPackets& packets) {
  trace::RayPacket rays;
  trace::LaneMask all, some;
  all.set(0xffffu);
  rays.setOrigin(packets.origin);
  for (std::size_t i = 0; i < packets.tiles.size(); ++i) {
    std::memcpy(rays.direction_x, tables.tileDirections(packets.tiles[i]), 3 * sizeof rays.direction_x);
    std::fill_n(rays.t_far, trace::kPacketSize, std::numeric_limits<float>::infinity());
    const bool whole = packets.above[i] == 0xffffu;
    if (!whole) some.set(packets.above[i]);
    tracer.occluded(rays, whole ? all : some, true);
  }
}

template <class Work>
double secondsOf(std::size_t count, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
      },
      tbb::simple_partitioner());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

PrtBakeBench measure(const BakePoints& points, const trace::Tracer& tracer, const DirectionTables& tables,
                     BakePasses& passes, BakePasses& forgetful, BakeState& state, int rounds) {
  // As many blocks as a core does in a quarter of a second, found by trying; spread evenly.
  std::size_t chosen = std::min<std::size_t>(state.blocks, 16);
  const auto blockAt = [&](std::size_t i) { return i * state.blocks / chosen; };
  const double trial_s = secondsOf(chosen, [&](std::size_t i) { passes.shadowBlock(blockAt(i), state); });
  chosen =
      std::clamp<std::size_t>(std::size_t(double(chosen) * 0.25 / std::max(1e-6, trial_s)), 1, state.blocks);

  std::vector<std::vector<PointPackets>> packets(chosen);
  std::atomic<std::size_t> rays{0};
  secondsOf(chosen, [&](std::size_t i) {
    passes.shadowBlock(blockAt(i), state);  // finds where the rays start
    packets[i] = packetsOf(points, tables, state, blockAt(i));
    for (const PointPackets& of_point : packets[i]) {
      for (const std::uint16_t above : of_point.above) rays += std::size_t(std::popcount(above));
    }
  });
  PrtBakeBench bench;
  bench.triangles = tracer.triangleCount();
  bench.rays = rays;
  bench.rounds = rounds;
  for (const auto& block : packets) bench.points += block.size();
  const auto bounce = [&](BakePasses& with, int pass) {
    state.pass = pass;
    const double time_s = secondsOf(chosen, [&](std::size_t i) { with.bounceBlock(blockAt(i), state); });
    state.pass = 0;
    return time_s;
  };
  if (state.bounces > 0) bounce(passes, 1);  // finds the hits, which are kept
  std::vector<double> bare, bake, ratio, first_bounce, later_bounce;
  for (int round = 0; round < rounds; ++round) {
    const double bare_s = secondsOf(chosen, [&](std::size_t i) {
      for (const PointPackets& p : packets[i]) traceBare(tracer, tables, p);
    });
    const double bake_s = secondsOf(chosen, [&](std::size_t i) { passes.shadowBlock(blockAt(i), state); });
    bare.push_back(double(bench.rays) * 1e-6 / bare_s);
    bake.push_back(double(bench.rays) * 1e-6 / bake_s);
    ratio.push_back(bake.back() / bare.back());
    if (state.bounces == 0) continue;
    first_bounce.push_back(bounce(forgetful, 1) / bake_s);
    later_bounce.push_back(bounce(passes, 2) / bake_s);
  }
  bench.bare_mrays_s = median(bare);
  bench.bake_mrays_s = median(bake);
  bench.ratio = median(ratio);
  if (state.bounces > 0) {
    bench.first_bounce = median(first_bounce);
    bench.later_bounce = median(later_bounce);
  }
  return bench;
}

}  // namespace

PrtBakeBench benchBake(const Scene& scene, const BakeOptions& given, int rounds) {
  const BakeOptions options = withBounceDirections(scene, given);
  const PosedScene posed = pose(scene, options.time_s);
  const BakePoints points = makeBakePoints(scene, posed);
  if (points.size() == 0) throw Error("bench bake", "the scene has no rigid triangles to bake");
  const DirectionTables tables =
      makeDirectionTables(options.order, options.directions, options.bounce_directions);
  const int cores =
      options.threads > 0 ? options.threads : std::max(1, int(std::thread::hardware_concurrency()));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, std::size_t(cores));
  PrtBakeBench bench{.bounce_directions = tables.bounce_tiles * kTileSize};
  tbb::task_arena(cores).execute([&] {
    const trace::Tracer tracer(scene, posed, {.reproducible = true, .rigid_only = true});
    BakeState state =
        makeBakeState(points.size(), tables, options.kind == TransferKind::kInterreflected ? 2 : 0,
                      followsMirrors(scene, posed, options));
    state.glossy = makeGlossyState(scene, posed, points, options);
    std::optional<GlossyTables> glossy;
    if (!state.glossy.empty())
      glossy.emplace(state.glossy.layout, tables).instances.assign(posed.instances.size(), 1);
    PassSettings settings{.bounces = state.bounces, .caustics = options.caustics};
    BakePasses passes(scene, posed, points, tracer, tables, settings, glossy ? &*glossy : nullptr);
    settings.kept_bytes = 0;
    BakePasses forgetful(scene, posed, points, tracer, tables, settings, glossy ? &*glossy : nullptr);
    const int bounce_directions = bench.bounce_directions;
    bench = measure(points, tracer, tables, passes, forgetful, state, std::max(1, rounds));
    bench.bounce_directions = bounce_directions;
  });
  return bench;
}

}  // namespace gloam
