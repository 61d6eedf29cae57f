// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Keller 1997: every path goes on as if diffuse, and fewer go on from surface to surface; how many is fixed, so that no light comes
// and goes as surfaces move. Paths of all sets together are one Owen-scrambled Sobol' sequence, and each set is a run of it: so
// each is even by itself, and all of them together are more so (what a filter over all sets sums).
//
// Differs from Keller: half of the paths go on whatever the albedo; scrambled Sobol' points instead of Halton's.
#include "vpls/walks.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <numbers>

#include "math/brdf.h"
#include "math/punctual.h"
#include "math/sampling.h"
#include "trace/surface.h"
#include "vpls/light_sources.h"

namespace gloam::vpls {

namespace {

using visibility::SightSet;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kGoOn = 0.5f;         // share of paths
constexpr float kLeastCosine = 0.1f;  // what a path covers at grazing incidence stays bounded
constexpr int kMostSets = 256, kMostRows = 1 << 24, kMostBounces = 16;

// Pairs of dimensions of a path, and of rows for sources.
constexpr std::uint32_t kStart = 0, kSecond = 1, kSide = 2, kGlow = 3, kSky = 4, kLamp = 5, kBounce = 8;

glm::vec2 pointOf(std::uint32_t index, std::uint32_t pair) {
  return sampling::sobol2(index, 0x9e3779b9u * (pair + 1u));
}

/// How many paths of a set reach each bounce: halves, `rows` of all together.
std::vector<int> pathCounts(int rows, int bounces) {
  bounces = std::min({bounces, rows, kMostBounces});
  std::vector<int> counts;
  if (bounces <= 0) return counts;
  int first = rows;
  const auto sumOf = [&](int paths) {
    int sum = 0;
    double left = paths;
    for (int b = 0; b < bounces; ++b, left *= double(kGoOn)) sum += std::max(1, int(std::ceil(left)));
    return sum;
  };
  int low = 1;  // the most that fit
  while (low < first) {
    const int middle = (low + first + 1) / 2;
    if (sumOf(middle) <= rows)
      low = middle;
    else
      first = middle - 1;
  }
  double left = low;
  for (int b = 0; b < bounces; ++b, left *= double(kGoOn))
    counts.push_back(std::max(1, int(std::ceil(left))));
  return counts;
}

struct Plan {
  int sets = 0, lamps = 0, direct = 0;
  std::vector<int> paths;  // that reach bounce 1, 2, … of a set
  int indirect() const {
    int sum = 0;
    for (const int count : paths) sum += count;
    return sum;
  }
  std::uint32_t stride() const { return std::uint32_t(lamps + direct + indirect() + 3) / 4 * 4; }
};

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

bool sends(const glm::vec3& light) {
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

/// Makes the rows of one frame.
struct Making {
  const visibility::HostWorld& world;
  const LightSources& sources;
  const Emitters& emitters;
  const EnvironmentTable& environment;
  const Plan& plan;
  const std::vector<WalkVpl>& lamps;  // all of them
  const Choice& lamp_choice;          // where there are more than the plan has rows for
  std::vector<WalkVpl>& rows;         // stride a set, all of kSightNothing

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
      const Emitters::Sample sample = emitters.sample(point(s, i, split.glow, kGlow));
      row->end = {sample.position, visibility::kSightBothSides, sample.normal, sample.offset};
      row->light = sample.light / float(split.glow);
      row->bound = sample.area / (kPi * float(split.glow) * float(plan.sets));
    }
    for (int i = 0; i < split.sky; ++i, ++row) {
      const EnvironmentTable::Sample sample = environment.sample(point(s, i, split.sky, kSky));
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
      if (!sends(flux)) return;
      const trace::Hit hit = world.tracer().closest({ray.origin, ray.direction});
      if (!hit) return;
      if (b == 0) flux *= punctual::rangeFactor(hit.distance, ray.range);
      const bool in_front = glm::dot(hit.geometric_normal, ray.direction) < 0.0f;
      const glm::vec3 normal = in_front ? hit.geometric_normal : -hit.geometric_normal;
      const Scene& scene = world.scene();
      const Mesh& mesh = scene.meshes[std::size_t(world.posed().instances[std::size_t(hit.instance)].mesh)];
      flux *= albedoAt(scene, mesh, {hit.triangle, hit.u, hit.v});
      if (!sends(flux)) return;
      const glm::vec3 position = ray.origin + hit.distance * ray.direction;
      const float offset = 4.0f * world.tracer().surfaceOffset(hit);
      area += spread * hit.distance * hit.distance;
      area /= std::max(-glm::dot(normal, ray.direction), kLeastCosine);
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

  /// Rows that send, in their order; the rest is nothing.
  SightSet pack(int s) const {
    SightSet result{std::uint32_t(s) * plan.stride(), 0, 0, 0};
    WalkVpl* row = set(s);
    const int ends[] = {plan.lamps, plan.lamps + plan.direct, int(plan.stride())};
    std::uint32_t kept[3] = {};
    for (int i = 0, part = 0; i < int(plan.stride()); ++i) {
      while (i >= ends[part]) ++part;
      if (row[i].end.kind >= visibility::kSightNothing || !sends(row[i].light)) continue;
      row[result.count++] = row[i];
      ++kept[part];
    }
    std::fill(row + result.count, row + plan.stride(), nothing());
    result.lamps = kept[0];
    result.direct = kept[0] + kept[1];
    return result;
  }

  static WalkVpl nothing() {
    WalkVpl row{};
    row.end.kind = visibility::kSightNothing;
    return row;
  }
};

void checkOptions(const WalkOptions& options) {
  if (options.sets < 0 || options.sets > kMostSets)
    throw Error("virtual lights", fmt::format("{} sets; expected 0 to {}", options.sets, kMostSets));
  for (const int count : {options.direct, options.indirect, options.bounces, options.most_lamps}) {
    if (count < 0 || count > kMostRows)
      throw Error("virtual lights", fmt::format("{} rows or bounces; expected 0 to {}", count, kMostRows));
  }
}

}  // namespace

struct Walker::State {
  Emitters emitters;
  EnvironmentTable environment;
  LightSources sources;
  std::uint64_t environment_revision = 0, pose_revision = 0, layout_revision = 0;
};

Walker::Walker() : state_(std::make_unique<State>()) {}
Walker::~Walker() = default;

Walks Walker::record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const WalkOptions& options,
                     visibility::HostWorld& world) {
  checkOptions(options);
  const std::vector<frame::LightRow>& lamps = inputs.shadow_maps.lights;
  Plan plan;
  plan.sets = options.sets;
  plan.lamps = std::min(int(lamps.size()), options.most_lamps);
  plan.direct = options.direct;
  if (options.bounces > 0) plan.paths = pathCounts(options.indirect, options.bounces);
  Walks walks;
  walks.stride = plan.stride();
  walks.set_count = walks.stride > 0 ? std::uint32_t(plan.sets) : 0;
  if (walks.set_count == 0) return {};
  walks.rows = graph.create("vpls.walk_rows", gpu::BufferDesc{.bytes = std::size_t(walks.set_count) *
                                                                       walks.stride * sizeof(WalkVpl)});
  walks.sets = graph.create("vpls.walk_sets", gpu::BufferDesc{.bytes = walks.set_count * sizeof(SightSet)});
  State& s = *state_;
  if (s.environment_revision != inputs.environment.revision()) {
    s.environment = EnvironmentTable(inputs.environment);
    s.environment_revision = inputs.environment.revision();
  }
  auto& pass = graph.host("vpls.walks");
  visibility::HostWorld::reads(pass, inputs.scene);
  pass.write(walks.rows).write(walks.sets);
  pass.run([&s, &world, &scene = inputs.scene, plan, walks, lamps](gpu::HostAccess& access) {
    world.update(access, scene);
    world.tracer();  // built here, not by the threads that trace
    if (s.pose_revision != world.poseRevision() || s.layout_revision != world.layoutRevision()) {
      s.emitters = Emitters(world);
      s.pose_revision = world.poseRevision();
      s.layout_revision = world.layoutRevision();
    }
    s.sources = LightSources(lamps, s.emitters, s.environment, scene.boundsMin(), scene.boundsMax());
    std::vector<WalkVpl> lamp_rows;
    std::vector<double> lamp_powers;
    for (const frame::LightRow& lamp : lamps) {
      lamp_rows.push_back(lampRow(lamp));
      lamp_powers.push_back(lampPower(lamp, scene.boundsMin(), scene.boundsMax()));
    }
    const Choice lamp_choice(lamp_powers);
    std::vector<WalkVpl> rows(std::size_t(plan.sets) * plan.stride(), Making::nothing());
    std::vector<SightSet> sets(static_cast<std::size_t>(plan.sets));
    const Making making{world, s.sources, s.emitters, s.environment, plan, lamp_rows, lamp_choice, rows};
    const Split split = splitOf(s.sources, plan.direct);
    const int paths = plan.paths.empty() || s.sources.dark() ? 0 : plan.paths[0];
    tbb::parallel_for(tbb::blocked_range<int>(0, plan.sets * paths, 64), [&](const auto& range) {
      for (int k = range.begin(); k < range.end(); ++k) making.makePath(k / paths, k % paths);
    });
    tbb::parallel_for(0, plan.sets, [&](int k) {
      making.makeLamps(k);
      making.makeDirect(k, split);
      sets[std::size_t(k)] = making.pack(k);
    });
    access.upload(walks.rows, std::span<const WalkVpl>(rows));
    access.upload(walks.sets, std::span<const SightSet>(sets));
  });
  return walks;
}

}  // namespace gloam::vpls
