// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Kajiya 1986, "The rendering equation"; Veach 1997, chapter 9: at every vertex one direction by light and one by lobes, joined
// by the power heuristic. The direction by lobes is the path's own next step. A lamp is a delta: by light alone.
#include "reference/paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gloam::reference {
namespace {

// Pairs of random numbers: one for the picture, then so many a vertex.
enum Pair : std::uint32_t { kLobes, kEnvironment, kEmitterPoint, kEmitter, kLampAndRoulette, kPairsAVertex };
constexpr std::uint32_t kPixelPair = 0;

constexpr std::uint32_t kFirstRoulette = 4;  // vertices before it are always followed
constexpr float kSurestRoulette = 0.95f;     // so that a white furnace ends too

float largest(const glm::vec3& v) {
  return std::max(v.x, std::max(v.y, v.z));
}
bool isBlack(const glm::vec3& v) {
  return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

}  // namespace

/// What a path carries from vertex to vertex.
struct Paths::Walk {
  const Sampler& sampler;
  std::size_t& rays;
  std::vector<trace::LoggedRay>* log;
  PathLight& light;
  Vertex vertex;
  PointLobes lobes;
  glm::vec3 origin;  // of rays that leave the vertex
  glm::vec3 throughput{1.0f};
  Sources sources;
  std::uint32_t depth = 0, first_pair = 1;

  glm::vec2 pair(Pair which) const { return sampler.pair(first_pair + which); }
  glm::uvec2 numbers(Pair which, std::uint32_t ahead = 0) const {
    return sampler.numbers(first_pair + ahead * kPairsAVertex + which);
  }
  void arrive(const glm::vec3& to_view) {
    lobes = PointLobes(*vertex.lobes, vertex.normal, to_view);
    origin = vertex.rayOrigin();
  }
  void add(LightPath direct, const glm::vec3& radiance) {
    light[std::size_t(direct) + (depth > 0 ? 1u : 0u)] += throughput * radiance;
  }
  void count(const trace::Ray& ray, bool occlusion) {
    ++rays;
    if (log) log->push_back({ray, occlusion});
  }
};

/// A direction by lobes.
struct Paths::Step {
  glm::vec3 direction{0.0f};
  glm::vec3 throughput{0.0f};  ///< of the step alone
  float pdf = 0.0f;
  EnvironmentSampler::Place sky;
};

Paths::Paths(const Scene& scene, const PosedScene& posed,
             std::shared_ptr<const EnvironmentSampler> environment, const ReferenceOptions& options,
             Sampling sampling, const Progress& progress)
    : tracer_(scene, posed, {.reproducible = true, .robust = true}, progress),
      surfaces_(scene, posed, tracer_),
      environment_(std::move(environment)),
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

bool Paths::visible(Walk& walk, const trace::Ray& ray) const {
  walk.count(ray, true);
  return !tracer_.occluded(ray);
}

void Paths::fromEnvironment(Walk& walk, const EnvironmentSampler::Block& block) const {
  const EnvironmentSampler::Sample sample = environment_->sample(block);
  if (!(sample.light.pdf > 0.0f) || glm::dot(walk.vertex.geometric_normal, sample.direction) <= 0.0f) return;
  const PointLobes::Value lobes = walk.lobes.at(sample.direction);
  const glm::vec3 radiance =
      lobes.value * sample.light.radiance * (weight(sample.light.pdf, lobes.pdf) / sample.light.pdf);
  if (isBlack(radiance) || !visible(walk, {walk.origin, sample.direction})) return;
  walk.add(kEnvironmentDirect, radiance);
}

void Paths::fromEmitters(Walk& walk) const {
  const Emitters::Sample sample = emitters_.sample(walk.numbers(kEmitter).x, walk.pair(kEmitterPoint));
  if (isBlack(sample.radiance)) return;
  const glm::vec3 between = sample.position - walk.vertex.position;
  const float squared = glm::dot(between, between);
  if (!(squared > 0.0f)) return;
  const glm::vec3 direction = between * (1.0f / std::sqrt(squared));
  if (glm::dot(walk.vertex.geometric_normal, direction) <= 0.0f) return;
  const float cosine = glm::dot(sample.normal, direction);
  const float pdf = Emitters::solidAnglePdf(sample.area_pdf, squared, std::abs(cosine));
  if (!(pdf > 0.0f)) return;
  const PointLobes::Value lobes = walk.lobes.at(direction);
  const glm::vec3 radiance = lobes.value * sample.radiance * (weight(pdf, lobes.pdf) / pdf);
  if (isBlack(radiance)) return;
  // To just before the triangle, on the side from which it is seen.
  const glm::vec3 end = sample.position - std::copysign(sample.ray_offset, cosine) * sample.normal;
  const glm::vec3 way = end - walk.origin;
  const float length = glm::length(way);
  if (length > 0.0f && !visible(walk, {walk.origin, way / length, 0.0f, length})) return;
  walk.add(kEmitterDirect, radiance);
}

void Paths::fromLamp(Walk& walk, const Lamp::Arriving& from, const glm::vec3& radiance) const {
  trace::Ray ray{walk.origin, from.to_lamp};
  if (from.distance < std::numeric_limits<float>::infinity()) {
    const glm::vec3 way = walk.vertex.position + from.distance * from.to_lamp - walk.origin;
    ray.t_far = std::sqrt(glm::dot(way, way));
    if (ray.t_far > 0.0f) ray.direction = way * (1.0f / ray.t_far);
  }
  if (visible(walk, ray)) walk.add(kLocalDirect, radiance);
}

void Paths::fromLamps(Walk& walk) const {
  const auto shown = [&](const Lamp::Arriving& from) {
    if (glm::dot(walk.vertex.geometric_normal, from.to_lamp) <= 0.0f || isBlack(from.irradiance))
      return glm::vec3(0.0f);
    return from.irradiance * walk.lobes.at(from.to_lamp).value;
  };
  if (lamps_.size() == 1) {
    const Lamp::Arriving from = lamps_[0].at(walk.vertex.position);
    const glm::vec3 radiance = shown(from);
    if (!isBlack(radiance)) fromLamp(walk, from, radiance);
    return;
  }
  // One of many, by what it would give without shadow. What is left of the number chooses on.
  float u = walk.pair(kLampAndRoulette).x, total = 0.0f;
  glm::vec3 chosen(0.0f);
  Lamp::Arriving chosen_from;
  for (const Lamp& lamp : lamps_) {
    const Lamp::Arriving from = lamp.at(walk.vertex.position);
    const glm::vec3 radiance = shown(from);
    const float size = radiance.r + radiance.g + radiance.b;
    if (!(size > 0.0f)) continue;
    total += size;
    const float share = size / total;
    if (u < share) {
      chosen = radiance / size;
      chosen_from = from;
      u /= share;
    } else {
      u = (u - share) / (1.0f - share);
    }
  }
  if (total > 0.0f) fromLamp(walk, chosen_from, chosen * total);
}

bool Paths::chooseStep(Walk& walk, Step& step) const {
  step.direction = walk.lobes.sample(walk.pair(kLobes));
  if (glm::dot(walk.vertex.geometric_normal, step.direction) <= 0.0f) return false;
  const PointLobes::Value lobes = walk.lobes.at(step.direction);
  if (!(lobes.pdf > 0.0f)) return false;
  step.pdf = lobes.pdf;
  step.throughput = lobes.value * (1.0f / lobes.pdf);
  if (walk.sources.environment) step.sky = environment_->place(step.direction);
  return !isBlack(step.throughput);
}

void Paths::addEnvironment(Walk& walk, const Step& step) const {
  const EnvironmentSampler::Light light = environment_->at(step.sky, step.direction);
  if (!isBlack(light.radiance))
    walk.add(kEnvironmentDirect, step.throughput * light.radiance * weight(step.pdf, light.pdf));
}

// The last vertex under a sky alone: only whether it is free.
void Paths::finish(Walk& walk, const Step& step) const {
  if (!environment_->isDark(step.sky) && visible(walk, {walk.origin, step.direction}))
    addEnvironment(walk, step);
}

// To the next vertex; collects what shines there. Whether the path goes on.
bool Paths::advance(Walk& walk, const Step& step, bool go_on) const {
  const trace::Ray ray{walk.origin, step.direction};
  walk.count(ray, false);
  const trace::Hit hit = tracer_.closest(ray);
  if (!hit) {
    if (walk.sources.environment && sample_lobes_) addEnvironment(walk, step);
    return false;
  }
  if (walk.sources.emitters && sample_lobes_ && surfaces_.emits(hit.instance)) {
    const float cosine = std::abs(glm::dot(hit.geometric_normal, step.direction));
    const float pdf = Emitters::solidAnglePdf(emitters_.areaPdf(hit.instance, hit.triangle),
                                              hit.distance * hit.distance, cosine);
    walk.add(kEmitterDirect, step.throughput * surfaces_.emission(hit.instance, hit.triangle, hit.u, hit.v) *
                                 weight(step.pdf, pdf));
  }
  if (!go_on) return false;
  walk.throughput *= step.throughput;
  if (walk.depth >= kFirstRoulette) {
    const float chance = std::min(largest(walk.throughput), kSurestRoulette);
    if (walk.pair(kLampAndRoulette).y >= chance) return false;
    walk.throughput /= chance;
  }
  surfaces_.setVertex(walk.vertex, hit, step.direction);
  walk.arrive(-step.direction);
  ++walk.depth;
  walk.first_pair += kPairsAVertex;
  walk.sources = indirect_;
  return true;
}

void Paths::begin(Walk& walk, const CameraPoint& point) const {
  glm::vec2 shift(0.0f);
  if (!surfaces_.textured(point.instance)) {
    walk.vertex.position = point.position;
    walk.vertex.geometric_normal = point.geometric_normal;
    walk.vertex.normal = point.normal;
    walk.vertex.ray_offset = point.ray_offset;
    const trace::SurfacePoint at{point.triangle, point.u, point.v};
    surfaces_.setLobes(walk.vertex, point.instance, at, at);
  } else {
    const glm::vec2 place = walk.sampler.pair(kPixelPair) - 0.5f;
    shift = point.uv_per_x * place.x + point.uv_per_y * place.y;
    const trace::Hit hit{point.instance, point.triangle, 0.0f, point.u, point.v, point.geometric_normal};
    surfaces_.setVertex(walk.vertex, hit, -point.to_eye, shift);
  }
  if (surfaces_.emits(point.instance))
    walk.light[kSeen] = surfaces_.emission(point.instance, point.triangle, point.u, point.v, shift);
  walk.arrive(point.to_eye);
  walk.sources = direct_;
}

PathLight Paths::trace(const CameraPoint& point, const Sampler& sampler, std::size_t& rays,
                       std::vector<trace::LoggedRay>* log) const {
  PathLight light{};
  Walk walk{sampler, rays, log, light};
  const bool sky_by_light = sample_lights_ && (direct_.environment || indirect_.environment);
  // A vertex ahead: the sky's light takes its time to come from memory.
  EnvironmentSampler::Block block, next;
  if (sky_by_light) next = environment_->choose(walk.numbers(kEnvironment));
  begin(walk, point);
  for (bool go_on = true; go_on && !walk.vertex.lobes->black;) {
    go_on = int(walk.depth) < last_depth_;
    block = next;
    if (sky_by_light && go_on) next = environment_->choose(walk.numbers(kEnvironment, 1));
    if (walk.sources.lamps) fromLamps(walk);
    Step step;
    const bool by_lobes = sample_lobes_ && (walk.sources.environment || walk.sources.emitters);
    const bool stepping = (go_on || by_lobes) && chooseStep(walk, step);
    if (walk.sources.environment && sample_lights_) fromEnvironment(walk, block);
    if (walk.sources.emitters && sample_lights_) fromEmitters(walk);
    if (!stepping) break;
    if (!go_on && !walk.sources.emitters) {
      finish(walk, step);
      break;
    }
    go_on = advance(walk, step, go_on);
  }
  return light;
}

}  // namespace gloam::reference
