// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Keller 1997: every path goes on as if diffuse, and fewer go on from surface to surface; how many is fixed, so that no light comes
// and goes as surfaces move. Paths of all sets together are one Owen-scrambled Sobol' sequence, and each set is a run of it: so
// each is even by itself, and all of them together are more so (what a filter over all sets sums).
//
// Differs from Keller: half of the paths go on whatever the albedo; scrambled Sobol' points instead of Halton's.
#include "vpls/walk_rows.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <numbers>

#include "math/brdf.h"
#include "math/punctual.h"
#include "math/sampling.h"
#include "trace/surface.h"

namespace gloam::vpls {

namespace {

using visibility::SightSet;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kGoOn = 0.5f;         // share of paths
constexpr float kLeastCosine = 0.1f;  // what a path covers at grazing incidence stays bounded
constexpr int kMostSets = 256, kMostRows = 1 << 21, kMostBounces = 16, kMostCandidates = 64;

// Pairs of dimensions of a path, and of rows for sources.
constexpr std::uint32_t kStart = 0, kSecond = 1, kSide = 2, kGlow = 3, kSky = 4, kLamp = 5, kBounce = 8;

glm::vec2 pointOf(std::uint32_t index, std::uint32_t pair) {
  return sampling::sobol2(index, 0x9e3779b9u * (pair + 1u));
}

/// How many paths of a set reach each bounce: half as many go on each time, so that light of one bounce is as good with further ones.
std::vector<int> pathCounts(int first, int bounces) {
  std::vector<int> counts;
  double left = first;
  for (int b = 0; first > 0 && b < std::min(bounces, kMostBounces); ++b, left *= double(kGoOn))
    counts.push_back(std::max(1, int(std::ceil(left))));
  return counts;
}

struct Split {
  int glow = 0, sky = 0;  // of the rows for sources
};

Split splitOf(const LightSources& sources, int rows) {
  const double glow = sources.emittersPower(), sky = sources.environmentPower();
  if (!(glow + sky > 0.0) || rows <= 0) return {};
  if (!(glow > 0.0)) return {0, rows};
  if (!(sky > 0.0)) return {rows, 0};
  const double share = std::clamp(glow / (glow + sky), 0.25, 0.75);
  const int glowing = std::clamp(int(std::lround(share * rows)), rows > 1 ? 1 : 0, std::max(rows - 1, 0));
  return {glowing, rows - glowing};
}

WalkVpl lampRow(const frame::LightRow& lamp) {
  WalkVpl row{};
  row.light = lamp.intensity;
  row.cos_inner = -1.0f;
  row.cos_outer = -2.0f;
  row.end.normal = lamp.direction;
  if (lamp.kind == frame::kLightDirectional) {
    row.end.kind = visibility::kSightDirectional;
    row.end.position = -lamp.direction;
    return row;
  }
  row.end.kind = visibility::kSightLamp;
  row.end.position = lamp.position;
  row.range = lamp.range;
  if (lamp.kind == frame::kLightSpot) {
    row.cos_inner = lamp.cos_inner;
    row.cos_outer = lamp.cos_outer;
  }
  return row;
}

bool shines(const glm::vec3& light) {
  return std::isfinite(light.r + light.g + light.b) && light.r + light.g + light.b > 0.0f;
}

/// k_d + k_s, which all leaves as if diffuse.
glm::vec3 albedoAt(const Scene& scene, const Mesh& mesh, const trace::SurfacePoint& point) {
  const trace::MaterialPoint at = trace::materialAt(scene, mesh, point, point);
  const Material& material = scene.materials[std::size_t(mesh.material)];
  const brdf::Lobes lobes =
      brdf::makeLobes(glm::vec3(at.base_color), at.metallic, at.roughness, material.specular);
  return glm::clamp(lobes.diffuse + lobes.specular, 0.0f, 1.0f);
}

struct RowMaker {
  const WalkPlan& plan;
  const WalkLights& lights;
  const LightSources& sources;
  const std::vector<WalkVpl>& lamps;  // all of them
  const Choice& lamp_choice;          // where there are more than the plan has rows for
  std::vector<WalkVpl>& rows;

  WalkVpl* set(int s) const { return &rows[std::size_t(s) * plan.stride()]; }
  std::uint32_t block(int count) const { return std::bit_ceil(std::uint32_t(std::max(count, 1))); }
  /// Number i of `count` points of a set.
  glm::vec2 point(int s, int i, int count, std::uint32_t pair) const {
    return pointOf(std::uint32_t(s) * block(count) + std::uint32_t(i), pair);
  }

  void makeLamps(int s) const {
    WalkVpl* row = set(s);
    for (int i = 0; i < plan.lamps; ++i) {
      if (std::size_t(plan.lamps) == lamps.size()) {
        row[i] = lamps[std::size_t(i)];
        continue;
      }
      const Choice::Chosen chosen = lamp_choice.choose(point(s, i, plan.lamps, kLamp).x);
      if (chosen.probability <= 0.0f) continue;
      row[i] = lamps[chosen.index];
      row[i].light /= chosen.probability * float(plan.lamps);
    }
  }

  void makeDirect(int s, const Split& split) const {
    WalkVpl* row = set(s) + plan.lamps;
    for (int i = 0; i < split.glow; ++i, ++row) {
      const Emitters::Sample sample = lights.emitters.sample(point(s, i, split.glow, kGlow));
      row->end = {sample.position, visibility::kSightBothSides, sample.normal, sample.offset};
      row->light = sample.light / float(split.glow);
      row->bound = sample.area / (kPi * float(split.glow) * float(plan.sets));
    }
    for (int i = 0; i < split.sky; ++i, ++row) {
      const EnvironmentTable::Sample sample = lights.environment.sample(point(s, i, split.sky, kSky));
      row->end = {sample.direction, visibility::kSightDirectional, -sample.direction, 0.0f};
      row->light = sample.light / float(split.sky);
    }
  }

  /// One path: a row at each surface that it reaches.
  void makePath(int s, int i) const {
    const int paths = plan.paths.at(0);
    const glm::vec2 u[3] = {point(s, i, paths, kStart), point(s, i, paths, kSecond),
                            point(s, i, paths, kSide)};
    Emitted ray = sources.emit(u);
    const float all_paths = float(paths) * float(plan.sets);
    glm::vec3 flux = ray.flux / float(paths);
    float area = ray.area / all_paths, spread = ray.spread / all_paths;
    WalkVpl* rows_of_bounce = set(s) + plan.lamps + plan.direct;
    for (std::size_t b = 0; b < plan.paths.size() && i < plan.paths[b]; ++b) {
      if (!shines(flux)) return;
      const trace::Hit hit = lights.world.tracer().closest({ray.origin, ray.direction});
      if (!hit) return;
      if (b == 0) flux *= punctual::rangeFactor(hit.distance, ray.range);
      const bool in_front = glm::dot(hit.geometric_normal, ray.direction) < 0.0f;
      const glm::vec3 normal = in_front ? hit.geometric_normal : -hit.geometric_normal;
      const Scene& scene = lights.world.scene();
      const Mesh& mesh =
          scene.meshes[std::size_t(lights.world.posed().instances[std::size_t(hit.instance)].mesh)];
      flux *= albedoAt(scene, mesh, {hit.triangle, hit.u, hit.v});
      if (!shines(flux)) return;
      const glm::vec3 position = ray.origin + hit.distance * ray.direction;
      const float offset = 4.0f * lights.world.tracer().surfaceOffset(hit);
      area += spread * hit.distance * hit.distance;
      area /= std::max(-glm::dot(normal, ray.direction), kLeastCosine);
      // Paths that set out from all over a room come down evenly: what the two tell of that is to be counted once.
      if (b > 0) area *= 0.5f;
      WalkVpl& row = rows_of_bounce[i];
      row.end = {position, visibility::kSightSurface, normal, offset};
      row.light = flux / kPi;
      row.bound = area / kPi;
      row.bounce = std::uint32_t(b) + 1;
      if (b + 1 >= plan.paths.size()) return;
      rows_of_bounce += plan.paths[b];
      flux *= float(plan.paths[b]) / float(plan.paths[b + 1]);
      area *= float(plan.paths[b]) / float(plan.paths[b + 1]);
      spread = kPi / (float(plan.paths[b + 1]) * float(plan.sets));
      ray.direction = sampling::frame(normal) *
                      sampling::cosineHemisphere(point(s, i, paths, kBounce + std::uint32_t(b)));
      ray.origin = position + offset * normal;
    }
  }
};

}  // namespace

int WalkPlan::indirect() const {
  int sum = 0;
  for (const int count : paths) sum += count;
  return sum;
}

WalkPlan planWalks(const WalkOptions& options, std::size_t lamps, int candidates) {
  if (options.sets < 0 || options.sets > kMostSets)
    throw Error("virtual lights", fmt::format("{} sets; expected 0 to {}", options.sets, kMostSets));
  if (options.candidates < 1 || options.candidates > kMostCandidates)
    throw Error("virtual lights",
                fmt::format("{} candidates a row; expected 1 to {}", options.candidates, kMostCandidates));
  for (const int count : {options.direct, options.indirect, options.bounces, options.most_lamps}) {
    if (count < 0 || count > kMostRows)
      throw Error("virtual lights", fmt::format("{} rows or bounces; expected 0 to {}", count, kMostRows));
  }
  const std::int64_t further = options.bounces > 1 ? options.indirect + kMostBounces : 0;  // at most
  const std::int64_t each =
      std::int64_t(options.direct) + (options.indirect + further) * candidates + options.most_lamps;
  if (each * options.sets > kMostRows)
    throw Error("virtual lights",
                fmt::format("{} sets of {} rows, by direct {}, indirect {}, bounces {} and candidates {}; "
                            "expected at most {} rows in all",
                            options.sets, each, options.direct, options.indirect, options.bounces,
                            options.candidates, kMostRows));
  WalkPlan plan;
  plan.sets = options.sets;
  plan.lamps = int(std::min(lamps, std::size_t(options.most_lamps)));
  plan.direct = options.direct;
  if (options.bounces > 0) plan.paths = pathCounts(options.indirect * candidates, options.bounces);
  return plan;
}

WalkVpl emptyRow() {
  WalkVpl row{};
  row.end.kind = visibility::kSightNothing;
  return row;
}

bool sends(const WalkVpl& row) {
  return row.end.kind < visibility::kSightNothing && shines(row.light);
}

std::vector<WalkVpl> makeRows(const WalkPlan& plan, const WalkLights& lights) {
  const LightSources sources({lights.lamps.begin(), lights.lamps.end()}, lights.emitters, lights.environment,
                             lights.low, lights.high, lights.focus);
  std::vector<WalkVpl> lamps;
  std::vector<double> powers;
  for (const frame::LightRow& lamp : lights.lamps) {
    lamps.push_back(lampRow(lamp));
    powers.push_back(lampPower(lamp, lights.low, lights.high));
  }
  const Choice lamp_choice(powers);
  std::vector<WalkVpl> rows(std::size_t(plan.sets) * plan.stride(), emptyRow());
  const RowMaker maker{plan, lights, sources, lamps, lamp_choice, rows};
  const Split split = splitOf(sources, plan.direct);
  const int paths = plan.paths.empty() || sources.dark() ? 0 : plan.paths[0];
  const std::size_t all = std::size_t(plan.sets) * std::size_t(paths);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all, 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      maker.makePath(int(k / std::size_t(paths)), int(k % std::size_t(paths)));
  });
  tbb::parallel_for(0, plan.sets, [&](int s) {
    maker.makeLamps(s);
    maker.makeDirect(s, split);
  });
  return rows;
}

SightSet packRows(const WalkPlan& plan, std::size_t set, std::span<WalkVpl> rows) {
  SightSet result{std::uint32_t(set) * plan.stride(), 0, 0, 0};
  const std::span<WalkVpl> own = rows.subspan(result.first, plan.stride());
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!sends(own[i])) continue;
    own[result.count++] = own[i];
    if (i < std::size_t(plan.lamps)) ++result.lamps;
    if (i < std::size_t(plan.lamps + plan.direct)) ++result.direct;
  }
  std::fill(own.begin() + result.count, own.end(), emptyRow());
  return result;
}

}  // namespace gloam::vpls
