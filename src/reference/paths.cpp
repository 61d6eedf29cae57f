// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Kajiya 1986, "The rendering equation"; Veach 1997, chapter 9: at every vertex one direction by light and one by lobes, joined
// by the power heuristic. The direction by lobes is the path's own next step. A lamp is a delta: by light alone.
//
// Sixteen samples of a point walk side by side, step by step, one a lane of vectors (path_lanes.h); rays are traced one by
// one. Paths that end leave their lanes to those that go on.
#include "reference/paths.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "reference/paths_batch.h"

namespace gloam::reference {
namespace {

constexpr int kFirstRoulette = 4;  // vertices before it are always followed
constexpr float kLeastDensity = 1e-30f;
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

void Paths::shootNear(std::span<const glm::vec3> seen) {
  if (indirect_.lamps && both_) shots_ = LampShots(lamps_, tracer_, seen);
}

// The sky behind the steps.
void Paths::findSky(Batch& batch) const {
  environment_->find(batch.lanes.direction, batch.sky_by_lobes);
  LaneFloats pdf;
  densitiesOf(batch.sky_by_lobes, pdf);
  lightOfSteps(batch.lanes, pdf, both_, batch.step_light);
}

// The last vertices under a sky alone: only whether it is free.
void Paths::finish(Batch& batch) const {
  std::uint32_t free = 0;
  for (int i = 0; i < batch.count; ++i) {
    if (batch.step_light.isZero(i)) continue;
    const trace::Ray ray = batch.stepOf(i);
    batch.record(ray, true);
    if (tracer_.occluded(ray)) continue;
    free |= 1u << i;
    environment_->sendFor(batch.sky_by_lobes, i);
  }
  addSky(batch, batch.sky_by_lobes, batch.lanes.direction, free, batch.step_light);
}

void Paths::addEmission(Batch& batch, int lane, const trace::Hit& hit) const {
  const PathLanes& lanes = batch.lanes;
  const float cosine = std::abs(glm::dot(hit.geometric_normal, lanes.direction.get(lane)));
  const float pdf = Emitters::solidAnglePdf(emitters_.areaPdf(hit.instance, hit.triangle),
                                            hit.distance * hit.distance, cosine);
  const glm::vec3 radiance = surfaces_.emission(hit.instance, hit.triangle, hit.u, hit.v);
  batch.add(lane, kEmitterDirect, lanes.step.get(lane) * radiance * weight(lanes.pdf.at[lane], pdf));
}

void Paths::traceSteps(Batch& batch, trace::Hit* hits, bool go_on) const {
  const bool to_sky = batch.sources.environment && sample_lobes_;
  const trace::Hit* before = nullptr;  // whose vertices can be sent for while the next ray is traced
  std::uint32_t free = 0;
  for (std::uint32_t rest = batch.going(); rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const trace::Ray ray = batch.stepOf(i);
    batch.record(ray, false);
    hits[i] = tracer_.closest(ray);
    if (go_on && before) surfaces_.prefetchVertices(*before);
    before = nullptr;
    if (!hits[i]) {
      free |= 1u << i;
      if (to_sky) environment_->sendFor(batch.sky_by_lobes, i);
    } else if (go_on) {
      surfaces_.prefetchCorners(hits[i]);
      before = &hits[i];
    }
  }
  if (go_on && before) surfaces_.prefetchVertices(*before);
  if (to_sky) addSky(batch, batch.sky_by_lobes, batch.lanes.direction, free, batch.step_light);
}

// Of the step to a vertex, over area.
float Paths::densityOf(const Batch& batch, int lane, const trace::Hit& hit) const {
  const float cosine = std::abs(glm::dot(hit.geometric_normal, batch.lanes.direction.get(lane)));
  return std::max(batch.lanes.pdf.at[lane] * cosine / (hit.distance * hit.distance), kLeastDensity);
}

// Paths end by chance, what goes on makes up for it.
bool Paths::survives(Batch& batch, int lane, std::uint32_t number) const {
  const glm::vec3 step = batch.lanes.step.get(lane);
  const float chance = std::min(largest(step), kSurestRoulette);
  if (Sampler::toUnit(number) >= chance) return false;
  batch.lanes.step.set(lane, step / chance);
  return true;
}

// To the next vertices; collects what shines there.
void Paths::advance(Batch& batch, bool go_on) const {
  PathLanes& lanes = batch.lanes;
  trace::Hit hits[kLanes];
  traceSteps(batch, hits, go_on);
  const bool roulette = batch.depth >= kFirstRoulette;
  LaneBits unused, chances;
  if (roulette) numbersOfLanes(batch.scramble(kLampAndRoulette), lanes.place, unused, chances);
  batch.arrivals.clear();
  std::uint32_t taken = 0;
  int left = 0;
  for (int i = 0; i < batch.count; ++i) {
    if (!hits[i]) continue;
    if (batch.sources.emitters && sample_lobes_ && surfaces_.emits(hits[i].instance))
      addEmission(batch, i, hits[i]);
    if (!go_on || (roulette && !survives(batch, i, chances.at[i]))) continue;
    if (!surfaces_.arrive(batch.arrivals, left, hits[i])) continue;
    if (!shots_.empty()) lanes.found.at[left] = densityOf(batch, i, hits[i]);
    taken |= 1u << i;
    ++left;
  }
  batch.count = left;
  if (left == 0) return;
  takeSteps(lanes, taken);
  surfaces_.setVertices(lanes, batch.arrivals, batch.used());
}

void Paths::walk(Batch& batch) const {
  for (; batch.count > 0; ++batch.depth) {
    batch.sources = batch.depth == 0 ? direct_ : indirect_;
    const bool go_on = batch.depth < last_depth_;
    const bool sky_by_light = batch.sources.environment && sample_lights_;
    const bool sky_by_lobes = batch.sources.environment && sample_lobes_;
    const bool by_lobes = sky_by_lobes || (batch.sources.emitters && sample_lobes_);
    if (batch.sources.lamps) fromLamps(batch);
    if (sky_by_light) fromEnvironment(batch);
    if (batch.sources.emitters && sample_lights_) fromEmitters(batch);
    if (go_on && !shots_.empty()) fromShots(batch);
    if (!go_on && !by_lobes) return;
    chooseSteps(batch.lanes, batch.scramble(kLobes));
    if (sky_by_lobes) findSky(batch);
    if (!go_on && !batch.sources.emitters) return finish(batch);
    advance(batch, go_on);
  }
}

void Paths::begin(Batch& batch, const CameraPoint& point, std::uint32_t first,
                  std::span<PathLight> light) const {
  const bool textured = surfaces_.textured(point.instance), emits = surfaces_.emits(point.instance);
  const trace::Hit hit{point.instance, point.triangle, 0.0f, point.u, point.v, point.geometric_normal};
  PathLanes& lanes = batch.lanes;
  Surfaces::Arrivals& arrivals = batch.arrivals;
  batch.light = light;
  batch.depth = batch.count = 0;
  arrivals.clear();
  arrivals.shifted = textured;
  std::fill(light.begin(), light.end(), PathLight{});
  LaneBits x, y;
  for (int i = 0; i < kLanes; ++i) lanes.place.at[i] = bits::reversedBits(first + std::uint32_t(i));
  if (textured) numbersOfLanes(batch.sampler.scramble(kPixelPair), lanes.place, x, y);
  bool sends = false;
  for (int i = 0; i < int(light.size()); ++i) {
    lanes.slot.at[i] = i;
    lanes.found.at[i] = std::numeric_limits<float>::infinity();
    lanes.throughput.set(i, glm::vec3(1.0f));
    lanes.to_view.set(i, point.to_eye);
    sends = surfaces_.arrive(arrivals, i, hit);
    glm::vec2 shift(0.0f);
    if (textured) {
      const glm::vec2 place = glm::vec2(Sampler::toUnit(x.at[i]), Sampler::toUnit(y.at[i])) - 0.5f;
      shift = point.uv_per_x * place.x + point.uv_per_y * place.y;
      arrivals.shift_u.at[i] = shift.x;
      arrivals.shift_v.at[i] = shift.y;
    }
    if (emits)
      light[std::size_t(i)][kSeen] =
          surfaces_.emission(point.instance, point.triangle, point.u, point.v, shift);
  }
  if (!sends) return;
  batch.count = int(light.size());
  surfaces_.setVertices(lanes, arrivals, batch.used());
}

void Paths::trace(const CameraPoint& point, std::uint32_t pixel, std::uint32_t first,
                  std::span<PathLight> light, std::size_t& rays, std::vector<trace::LoggedRay>* log) const {
  Batch batch(rays, log, Sampler(seed_, pixel, first));
  for (std::size_t done = 0; done < light.size(); done += kLanes) {
    begin(batch, point, first + std::uint32_t(done),
          light.subspan(done, std::min(std::size_t(kLanes), light.size() - done)));
    walk(batch);
  }
}

}  // namespace gloam::reference
