// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Kajiya 1986, "The rendering equation"; Veach 1997, chapter 9: at every vertex one direction by light and one by lobes, joined
// by the power heuristic. The direction by lobes is the path's own next step. A lamp is a delta: by light alone.
//
// Several samples of a point walk side by side, step by step: between two rays a path does little, and most of that is
// waiting, for memory or for the last result. Each goes its own way; what they come to does not depend on their company.
#include "reference/paths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>

namespace gloam::reference {
namespace {

// Pairs of random numbers: one for the picture, then so many a vertex.
enum Pair : std::uint32_t { kLobes, kEnvironment, kEmitterPoint, kEmitter, kLampAndRoulette, kPairsAVertex };
constexpr std::uint32_t kPixelPair = 0;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr std::size_t kFewLamps = 8;      // so many all shine on what the camera sees
constexpr int kFirstRoulette = 4;         // vertices before it are always followed
constexpr float kSurestRoulette = 0.95f;  // so that a white furnace ends too

float largest(const glm::vec3& v) {
  return std::max(v.x, std::max(v.y, v.z));
}
bool isBlack(const glm::vec3& v) {
  return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

}  // namespace

/// What a path carries from vertex to vertex.
struct Paths::Lane {
  PathLight* light;
  std::uint32_t place;  // Sampler::place
  Vertex vertex;
  PointLobes lobes;
  glm::vec3 origin;  // of rays that leave the vertex
  glm::vec3 throughput;
  EnvironmentSampler::Block block;
  // The step by lobes.
  glm::vec3 direction, step_throughput;
  float pdf;  // 0: no step

  void setUp(const glm::vec3& to_view) {
    lobes = PointLobes(*vertex.lobes, vertex.normal, to_view);
    origin = vertex.rayOrigin();
  }
};

struct Paths::Batch {
  std::size_t& rays;
  std::vector<trace::LoggedRay>* log;
  Sampler sampler;  // of the first sample; all share its scrambles
  Lane* active[kLanes];
  int count = 0;
  int depth = 0;
  bool same_vertex = false;  // all stand at one point that has no textures
  Sources sources;
  struct Shadow {
    trace::Ray ray;
    glm::vec3 light;
    Lane* lane;
  };
  Shadow* shadows;  // room for all lanes
  int shadow_count = 0;
  EnvironmentSampler::Place skies[kLanes];  // where the active lanes' steps look

  std::span<Lane*> all() { return {active, std::size_t(count)}; }
  std::uint32_t number(Pair which) const { return 1u + std::uint32_t(depth) * kPairsAVertex + which; }
  /// Random numbers of the active lanes.
  void numbers(Pair which, LaneBits& x, LaneBits& y) const {
    LaneBits places;
    for (int i = 0; i < kLanes; ++i) places.at[i] = active[i < count ? i : 0]->place;
    numbersOfLanes(sampler.scramble(number(which)), places, x, y);
  }
  void add(Lane& lane, LightPath direct, const glm::vec3& radiance) {
    (*lane.light)[std::size_t(direct) + (depth > 0 ? 1u : 0u)] += radiance;
  }
  void push(Lane& lane, const glm::vec3& direction, float t_far, const glm::vec3& light) {
    Shadow& shadow = shadows[shadow_count++];
    shadow.ray.origin = lane.origin;
    shadow.ray.direction = direction;
    shadow.ray.t_near = 0.0f;
    shadow.ray.t_far = t_far;
    shadow.light = light;
    shadow.lane = &lane;
  }
  void record(const trace::Ray& ray, bool occlusion) {
    ++rays;
    if (log) log->push_back({ray, occlusion});
  }
};

Paths::Paths(const Scene& scene, const PosedScene& posed,
             std::shared_ptr<const EnvironmentSampler> environment, const ReferenceOptions& options,
             Sampling sampling, const Progress& progress)
    : tracer_(scene, posed, {.reproducible = true, .robust = true}, progress),
      surfaces_(scene, posed, tracer_),
      environment_(std::move(environment)),
      seed_(options.seed),
      sample_lights_(sampling != Sampling::kLobes),
      sample_lobes_(sampling != Sampling::kLights),
      both_(sampling == Sampling::kBoth) {
  const Coverage& light = options.light;
  const bool bounces = options.bounces > 0;
  if (light.emitter_direct || (light.emitter_indirect && bounces))
    emitters_ = Emitters(scene, posed, surfaces_, tracer_);
  if (light.local_direct || (light.local_indirect && bounces)) lamps_ = makeLamps(posed);
  direct_ = {light.environment_direct && !environment_->black(), light.local_direct && !lamps_.empty(),
             light.emitter_direct && !emitters_.empty()};
  indirect_ = {bounces && light.environment_indirect && !environment_->black(),
               bounces && light.local_indirect && !lamps_.empty(),
               bounces && light.emitter_indirect && !emitters_.empty()};
  last_depth_ = indirect_.any() ? options.bounces : 0;
}

// ---- Light, by sources ----------------------------------------------------------------------------------------------

void Paths::castShadows(Batch& batch, LightPath direct) const {
  for (int i = 0; i < batch.shadow_count; ++i) {
    const Batch::Shadow& shadow = batch.shadows[i];
    batch.record(shadow.ray, true);
    if (!tracer_.occluded(shadow.ray)) batch.add(*shadow.lane, direct, shadow.light);
  }
  batch.shadow_count = 0;
}

void Paths::fromEnvironment(Batch& batch) const {
  for (Lane* lane : batch.all()) {
    const EnvironmentSampler::Sample sample = environment_->sample(lane->block);
    if (!(sample.light.pdf > 0.0f) || glm::dot(lane->vertex.geometric_normal, sample.direction) <= 0.0f)
      continue;
    const PointLobes::Value lobes = lane->lobes.at(sample.direction);
    const glm::vec3 light = lane->throughput * lobes.value * sample.light.radiance *
                            (weight(sample.light.pdf, lobes.pdf) / sample.light.pdf);
    if (!isBlack(light)) batch.push(*lane, sample.direction, kInfinity, light);
  }
  castShadows(batch, kEnvironmentDirect);
}

void Paths::fromEmitters(Batch& batch) const {
  const Sampler::Scramble which = batch.sampler.scramble(batch.number(kEmitter)),
                          at_point = batch.sampler.scramble(batch.number(kEmitterPoint));
  for (Lane* lane : batch.all()) {
    const glm::vec2 u = Sampler::unit(Sampler::numbers(at_point, lane->place));
    const Emitters::Sample sample = emitters_.sample(Sampler::numbers(which, lane->place).x, u);
    const glm::vec3 between = sample.position - lane->vertex.position;
    const float squared = glm::dot(between, between);
    if (isBlack(sample.radiance) || !(squared > 0.0f)) continue;
    const glm::vec3 direction = between * (1.0f / std::sqrt(squared));
    const float cosine = glm::dot(sample.normal, direction);
    const float pdf = Emitters::solidAnglePdf(sample.area_pdf, squared, std::abs(cosine));
    if (!(pdf > 0.0f) || glm::dot(lane->vertex.geometric_normal, direction) <= 0.0f) continue;
    const PointLobes::Value lobes = lane->lobes.at(direction);
    const glm::vec3 light = lane->throughput * lobes.value * sample.radiance * (weight(pdf, lobes.pdf) / pdf);
    // To just before the triangle, on the side from which it is seen.
    const glm::vec3 end = sample.position - std::copysign(sample.ray_offset, cosine) * sample.normal;
    const glm::vec3 way = end - lane->origin;
    const float length = std::sqrt(glm::dot(way, way));
    if (!isBlack(light) && length > 0.0f) batch.push(*lane, way * (1.0f / length), length, light);
  }
  castShadows(batch, kEmitterDirect);
}

// ---- Light, by lamps ------------------------------------------------------------------------------------------------

glm::vec3 Paths::lampLight(const Lane& lane, const Lamp::Arriving& from) {
  if (glm::dot(lane.vertex.geometric_normal, from.to_lamp) <= 0.0f || isBlack(from.irradiance))
    return glm::vec3(0.0f);
  return from.irradiance * lane.lobes.at(from.to_lamp).value;
}

void Paths::pushLamp(Batch& batch, Lane& lane, const Lamp::Arriving& from, const glm::vec3& light) {
  if (from.distance == kInfinity) return batch.push(lane, from.to_lamp, kInfinity, lane.throughput * light);
  const glm::vec3 way = lane.vertex.position + from.distance * from.to_lamp - lane.origin;
  const float length = std::sqrt(glm::dot(way, way));
  const glm::vec3 direction = length > 0.0f ? way * (1.0f / length) : from.to_lamp;
  batch.push(lane, direction, length, lane.throughput * light);
}

void Paths::fromAllLamps(Batch& batch) const {
  for (const Lamp& lamp : lamps_) {
    Lamp::Arriving from;
    glm::vec3 light(0.0f);
    for (int i = 0; i < batch.count; ++i) {
      Lane& lane = *batch.active[i];
      if (i == 0 || !batch.same_vertex) {
        from = lamp.at(lane.vertex.position);
        light = lampLight(lane, from);
      }
      if (!isBlack(light)) pushLamp(batch, lane, from, light);
    }
    castShadows(batch, kLocalDirect);
  }
}

// One of many, by what it would give without shadow. What is left of the number chooses on.
void Paths::fromOneLamp(Batch& batch) const {
  const Sampler::Scramble scramble = batch.sampler.scramble(batch.number(kLampAndRoulette));
  for (Lane* lane : batch.all()) {
    float u = Sampler::unit(Sampler::numbers(scramble, lane->place)).x, total = 0.0f;
    glm::vec3 chosen(0.0f);
    Lamp::Arriving chosen_from;
    for (const Lamp& lamp : lamps_) {
      const Lamp::Arriving from = lamp.at(lane->vertex.position);
      const glm::vec3 light = lampLight(*lane, from);
      const float size = light.r + light.g + light.b;
      if (!(size > 0.0f)) continue;
      total += size;
      const float share = size / total;
      if (u < share) {
        chosen = light / size;
        chosen_from = from;
        u /= share;
      } else {
        u = (u - share) / (1.0f - share);
      }
    }
    if (total > 0.0f) pushLamp(batch, *lane, chosen_from, chosen * total);
  }
  castShadows(batch, kLocalDirect);
}

// ---- The walk -------------------------------------------------------------------------------------------------------

void Paths::chooseSteps(Batch& batch) const {
  LaneBits bits_x, bits_y;
  LaneFloats u, v;
  LaneVectors normals, directions;
  batch.numbers(kLobes, bits_x, bits_y);
  for (int i = 0; i < kLanes; ++i) {
    const PointLobes& lobes = batch.active[i < batch.count ? i : 0]->lobes;
    u.at[i] = lobes.stretched(Sampler::toUnit(bits_x.at[i]));
    v.at[i] = Sampler::toUnit(bits_y.at[i]);
    normals.set(i, lobes.normal());
  }
  cosineOfLanes(u, v, normals, directions);
  for (int i = 0; i < batch.count; ++i) {
    Lane& lane = *batch.active[i];
    const float choice = Sampler::toUnit(bits_x.at[i]);
    if (lane.lobes.choosesPhong(choice)) directions.set(i, lane.lobes.samplePhong({choice, v.at[i]}));
    lane.direction = directions.get(i);
    const PointLobes::Value lobes = lane.lobes.at(lane.direction);
    const bool above = glm::dot(lane.vertex.geometric_normal, lane.direction) > 0.0f;
    lane.pdf = above ? lobes.pdf : 0.0f;
    lane.step_throughput = lane.throughput * lobes.value * (1.0f / lobes.pdf);
  }
  if (batch.sources.environment && sample_lobes_) environment_->places(directions, batch.count, batch.skies);
}

void Paths::addEnvironment(Batch& batch, int i) const {
  Lane& lane = *batch.active[i];
  const EnvironmentSampler::Light light = environment_->at(batch.skies[i], lane.direction);
  if (!isBlack(light.radiance))
    batch.add(lane, kEnvironmentDirect, lane.step_throughput * light.radiance * weight(lane.pdf, light.pdf));
}

// The last vertices under a sky alone: only whether it is free.
void Paths::finish(Batch& batch) const {
  for (int i = 0; i < batch.count; ++i) {
    const Lane& lane = *batch.active[i];
    if (!(lane.pdf > 0.0f) || environment_->isDark(batch.skies[i])) continue;
    const trace::Ray ray{lane.origin, lane.direction};
    batch.record(ray, true);
    if (!tracer_.occluded(ray)) addEnvironment(batch, i);
  }
}

// Whether the path goes on from what its step has met.
bool Paths::arrive(Batch& batch, Lane& lane, const trace::Hit& hit) const {
  lane.throughput = lane.step_throughput;
  if (batch.depth >= kFirstRoulette) {
    const float chance = std::min(largest(lane.throughput), kSurestRoulette);
    const Sampler::Scramble scramble = batch.sampler.scramble(batch.number(kLampAndRoulette));
    if (Sampler::unit(Sampler::numbers(scramble, lane.place)).y >= chance) return false;
    lane.throughput /= chance;
  }
  surfaces_.setVertex(lane.vertex, hit, lane.direction);
  lane.setUp(-lane.direction);
  return !lane.vertex.lobes->black;
}

// To the next vertices; collects what shines there.
void Paths::advance(Batch& batch, bool go_on) const {
  trace::Hit hits[kLanes];
  for (int i = 0; i < batch.count; ++i) {
    const Lane& lane = *batch.active[i];
    const trace::Ray ray{lane.origin, lane.direction};
    if (!(lane.pdf > 0.0f) || isBlack(lane.step_throughput)) continue;
    batch.record(ray, false);
    hits[i] = tracer_.closest(ray);
    if (go_on && hits[i]) surfaces_.prefetchCorners(hits[i]);
  }
  if (go_on) {
    for (int i = 0; i < batch.count; ++i) {
      if (hits[i]) surfaces_.prefetchVertices(hits[i]);
    }
  }
  int left = 0;
  for (int i = 0; i < batch.count; ++i) {
    Lane& lane = *batch.active[i];
    const trace::Hit& hit = hits[i];
    if (!hit) {
      if (lane.pdf > 0.0f && batch.sources.environment && sample_lobes_) addEnvironment(batch, i);
      continue;
    }
    if (batch.sources.emitters && sample_lobes_ && surfaces_.emits(hit.instance)) {
      const float cosine = std::abs(glm::dot(hit.geometric_normal, lane.direction));
      const float pdf = Emitters::solidAnglePdf(emitters_.areaPdf(hit.instance, hit.triangle),
                                                hit.distance * hit.distance, cosine);
      const glm::vec3 radiance = surfaces_.emission(hit.instance, hit.triangle, hit.u, hit.v);
      batch.add(lane, kEmitterDirect, lane.step_throughput * radiance * weight(lane.pdf, pdf));
    }
    if (go_on && arrive(batch, lane, hit)) batch.active[left++] = &lane;
  }
  batch.count = left;
  batch.same_vertex = false;
}

void Paths::walk(Batch& batch) const {
  for (; batch.count > 0; ++batch.depth) {
    batch.sources = batch.depth == 0 ? direct_ : indirect_;
    const bool go_on = batch.depth < last_depth_;
    const bool sky_by_light = batch.sources.environment && sample_lights_;
    if (sky_by_light) {  // early: it takes its time to come from memory
      LaneBits x, y;
      batch.numbers(kEnvironment, x, y);
      for (int i = 0; i < batch.count; ++i) batch.active[i]->block = environment_->choose({x.at[i], y.at[i]});
    }
    const bool by_lobes = sample_lobes_ && (batch.sources.environment || batch.sources.emitters);
    if (go_on || by_lobes) chooseSteps(batch);
    if (batch.sources.lamps && (batch.depth == 0 ? lamps_.size() <= kFewLamps : lamps_.size() == 1)) {
      fromAllLamps(batch);
    } else if (batch.sources.lamps) {
      fromOneLamp(batch);
    }
    if (sky_by_light) fromEnvironment(batch);
    if (batch.sources.emitters && sample_lights_) fromEmitters(batch);
    if (!go_on && !by_lobes) return;
    if (!go_on && !batch.sources.emitters) return finish(batch);
    advance(batch, go_on);
  }
}

void Paths::begin(Batch& batch, Lane* lanes, const CameraPoint& point, std::uint32_t first,
                  std::span<PathLight> light) const {
  const bool textured = surfaces_.textured(point.instance), emits = surfaces_.emits(point.instance);
  const trace::Hit hit{point.instance, point.triangle, 0.0f, point.u, point.v, point.geometric_normal};
  const Sampler::Scramble scramble = batch.sampler.scramble(kPixelPair);
  batch.same_vertex = !textured;
  for (std::size_t i = 0; i < light.size(); ++i) {
    Lane& lane = *new (&lanes[i]) Lane;
    lane.light = &light[i];
    lane.place = bits::reversedBits(first + std::uint32_t(i));
    lane.throughput = glm::vec3(1.0f);
    light[i] = {};
    glm::vec2 shift(0.0f);
    if (textured) {
      const glm::vec2 place = Sampler::unit(Sampler::numbers(scramble, lane.place)) - 0.5f;
      shift = point.uv_per_x * place.x + point.uv_per_y * place.y;
      surfaces_.setVertex(lane.vertex, hit, -point.to_eye, shift);
      lane.setUp(point.to_eye);
    } else if (i == 0) {
      const trace::SurfacePoint at{point.triangle, point.u, point.v};
      lane.vertex.position = point.position;
      lane.vertex.geometric_normal = point.geometric_normal;
      lane.vertex.normal = point.normal;
      lane.vertex.ray_offset = point.ray_offset;
      surfaces_.setLobes(lane.vertex, point.instance, at, at);
      lane.setUp(point.to_eye);
    } else {
      lane.vertex.position = point.position;
      lane.vertex.geometric_normal = point.geometric_normal;
      lane.vertex.lobes = lanes[0].vertex.lobes;
      lane.lobes = lanes[0].lobes;
      lane.origin = lanes[0].origin;
    }
    if (emits) light[i][kSeen] = surfaces_.emission(point.instance, point.triangle, point.u, point.v, shift);
    if (!lane.vertex.lobes->black) batch.active[batch.count++] = &lane;
  }
}

void Paths::trace(const CameraPoint& point, std::uint32_t pixel, std::uint32_t first,
                  std::span<PathLight> light, std::size_t& rays, std::vector<trace::LoggedRay>* log) const {
  // Plain memory: most of it is never read where few samples are asked for.
  alignas(64) std::byte lanes[kLanes * sizeof(Lane)], shadows[kLanes * sizeof(Batch::Shadow)];
  Batch batch{rays, log, Sampler(seed_, pixel, first)};
  batch.shadows = reinterpret_cast<Batch::Shadow*>(shadows);
  for (std::size_t done = 0; done < light.size(); done += kLanes) {
    batch.count = batch.depth = 0;
    begin(batch, reinterpret_cast<Lane*>(lanes), point, first + std::uint32_t(done),
          light.subspan(done, std::min(std::size_t(kLanes), light.size() - done)));
    walk(batch);
  }
}

}  // namespace gloam::reference
