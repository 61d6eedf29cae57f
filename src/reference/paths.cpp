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
#include <cstddef>
#include <new>

#include "reference/paths_batch.h"

namespace gloam::reference {
namespace {

constexpr std::size_t kFewLamps = 8;      // so many all shine on what the camera sees
constexpr int kFirstRoulette = 4;         // vertices before it are always followed
constexpr float kSurestRoulette = 0.95f;  // so that a white furnace ends too

float largest(const glm::vec3& v) {
  return std::max(v.x, std::max(v.y, v.z));
}

}  // namespace

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
