// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Kajiya 1986, "The rendering equation"; Veach 1997, chapter 9: at every vertex one direction by light and one by lobes, joined
// by the power heuristic. The direction by lobes is the path's own next step. A lamp is a delta: by light alone.
#include "reference/paths.h"

#include <algorithm>
#include <cmath>

namespace gloam::reference {
namespace {

// Pairs of random numbers: one for the picture, then so many a vertex.
enum Pair : std::uint32_t { kLobes, kEnvironment, kEmitterPoint, kEmitter, kLampAndRoulette, kPairsAVertex };
constexpr std::uint32_t kPixelPair = 0;

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
struct Paths::Walk {
  const Sampler& sampler;
  std::size_t& rays;
  std::vector<trace::LoggedRay>* log;
  PathLight light{};
  Vertex vertex{};
  glm::vec3 to_view{0.0f};
  glm::vec3 throughput{1.0f};
  glm::vec3 origin{0.0f};  ///< of rays that leave the vertex
  Sources sources;
  int depth = 0;
  const PointLobes* lobes = nullptr;

  glm::vec2 pair(Pair which) const { return sampler.pair(number(which)); }
  glm::uvec2 bits(Pair which) const { return sampler.bits(number(which)); }
  std::uint32_t number(Pair which) const { return 1u + std::uint32_t(depth) * kPairsAVertex + which; }
  void add(LightPath direct, const glm::vec3& radiance) {
    light[std::size_t(direct) + (depth > 0 ? 1u : 0u)] += throughput * radiance;
  }
  void count(const trace::Ray& ray, bool occlusion) {
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
      sample_lights_(sampling != Sampling::kLobes),
      sample_lobes_(sampling != Sampling::kLights) {
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

float Paths::weight(float pdf, float other_pdf) const {
  if (!sample_lights_ || !sample_lobes_) return 1.0f;
  const float ratio = other_pdf / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

bool Paths::visible(Walk& walk, const trace::Ray& ray) const {
  walk.count(ray, true);
  return !tracer_.occluded(ray);
}

void Paths::fromEnvironment(Walk& walk) const {
  const EnvironmentSampler::Sample sample = environment_->sample(walk.bits(kEnvironment));
  if (!(sample.light.pdf > 0.0f) || glm::dot(walk.vertex.geometric_normal, sample.direction) <= 0.0f) return;
  const PointLobes::Value lobes = walk.lobes->at(sample.direction);
  const glm::vec3 radiance =
      lobes.value * sample.light.radiance * (weight(sample.light.pdf, lobes.pdf) / sample.light.pdf);
  if (isBlack(radiance) || !visible(walk, {walk.origin, sample.direction})) return;
  walk.add(kEnvironmentDirect, radiance);
}

void Paths::fromEmitters(Walk& walk) const {
  const Emitters::Sample sample = emitters_.sample(walk.bits(kEmitter).x, walk.pair(kEmitterPoint));
  if (isBlack(sample.radiance)) return;
  const glm::vec3 between = sample.position - walk.vertex.position;
  const float squared = glm::dot(between, between);
  if (!(squared > 0.0f)) return;
  const glm::vec3 direction = between * (1.0f / std::sqrt(squared));
  if (glm::dot(walk.vertex.geometric_normal, direction) <= 0.0f) return;
  const float cosine = glm::dot(sample.normal, direction);
  const float pdf = Emitters::solidAnglePdf(sample.area_pdf, squared, std::abs(cosine));
  if (!(pdf > 0.0f)) return;
  const PointLobes::Value lobes = walk.lobes->at(direction);
  const glm::vec3 radiance = lobes.value * sample.radiance * (weight(pdf, lobes.pdf) / pdf);
  if (isBlack(radiance)) return;
  // To just before the triangle, on the side from which it is seen.
  const glm::vec3 end = sample.position - std::copysign(sample.ray_offset, cosine) * sample.normal;
  const glm::vec3 way = end - walk.origin;
  const float length = glm::length(way);
  if (length > 0.0f && !visible(walk, {walk.origin, way / length, 0.0f, length})) return;
  walk.add(kEmitterDirect, radiance);
}

void Paths::fromLamps(Walk& walk) const {
  // One of many, by what it would give without shadow. The number's rest chooses on.
  float u = lamps_.size() > 1 ? walk.pair(kLampAndRoulette).x : 0.0f, total = 0.0f;
  glm::vec3 chosen(0.0f);
  Lamp::Arriving from;
  for (const Lamp& lamp : lamps_) {
    const Lamp::Arriving arriving = lamp.at(walk.vertex.position);
    if (glm::dot(walk.vertex.geometric_normal, arriving.to_lamp) <= 0.0f || isBlack(arriving.irradiance))
      continue;
    const glm::vec3 radiance = arriving.irradiance * walk.lobes->at(arriving.to_lamp).value;
    const float size = radiance.r + radiance.g + radiance.b;
    if (!(size > 0.0f)) continue;
    total += size;
    const float share = size / total;
    if (u < share) {
      chosen = radiance / size;
      from = arriving;
      u /= share;
    } else {
      u = (u - share) / (1.0f - share);
    }
  }
  if (!(total > 0.0f)) return;
  trace::Ray ray{walk.origin, from.to_lamp};
  if (std::isfinite(from.distance)) {
    const glm::vec3 way = walk.vertex.position + from.distance * from.to_lamp - walk.origin;
    ray.t_far = glm::length(way);
    if (ray.t_far > 0.0f) ray.direction = way / ray.t_far;
  }
  if (visible(walk, ray)) walk.add(kLocalDirect, chosen * total);
}

// Along the lobes to the next vertex; collects what shines there. Whether the path goes on.
bool Paths::step(Walk& walk, bool go_on) const {
  const glm::vec3 direction = walk.lobes->sample(walk.pair(kLobes));
  if (glm::dot(walk.vertex.geometric_normal, direction) <= 0.0f) return false;
  const PointLobes::Value lobes = walk.lobes->at(direction);
  if (!(lobes.pdf > 0.0f)) return false;
  walk.throughput *= lobes.value / lobes.pdf;
  if (isBlack(walk.throughput)) return false;
  const trace::Ray ray{walk.origin, direction};
  const auto addEnvironment = [&](const EnvironmentSampler::Light& light) {
    if (!isBlack(light.radiance)) walk.add(kEnvironmentDirect, light.radiance * weight(lobes.pdf, light.pdf));
  };
  if (!go_on && !(walk.sources.emitters && sample_lobes_)) {
    // The last vertex: only whether the sky is free.
    const EnvironmentSampler::Light light = environment_->from(direction);
    if (!isBlack(light.radiance) && visible(walk, ray)) addEnvironment(light);
    return false;
  }
  walk.count(ray, false);
  const trace::Hit hit = tracer_.closest(ray);
  if (!hit) {
    if (walk.sources.environment && sample_lobes_) addEnvironment(environment_->from(direction));
    return false;
  }
  if (walk.sources.emitters && sample_lobes_ && surfaces_.emits(hit.instance)) {
    const float cosine = std::abs(glm::dot(hit.geometric_normal, direction));
    const float pdf = Emitters::solidAnglePdf(emitters_.areaPdf(hit.instance, hit.triangle),
                                              hit.distance * hit.distance, cosine);
    walk.add(kEmitterDirect,
             surfaces_.emission(hit.instance, hit.triangle, hit.u, hit.v) * weight(lobes.pdf, pdf));
  }
  if (!go_on) return false;
  if (walk.depth >= kFirstRoulette) {
    const float chance = std::min(largest(walk.throughput), kSurestRoulette);
    if (walk.pair(kLampAndRoulette).y >= chance) return false;
    walk.throughput /= chance;
  }
  walk.vertex = surfaces_.vertexAt(hit, direction);
  walk.to_view = -direction;
  return true;
}

Vertex Paths::firstVertex(const CameraPoint& point, const Sampler& sampler, PathLight& light) const {
  if (!surfaces_.textured(point.instance)) {
    const trace::SurfacePoint at{point.triangle, point.u, point.v};
    if (surfaces_.emits(point.instance))
      light[kSeen] = surfaces_.emission(point.instance, point.triangle, point.u, point.v);
    return {point.position, point.geometric_normal, point.normal, point.ray_offset,
            surfaces_.lobes(point.instance, at, at)};
  }
  const glm::vec2 place = sampler.pair(kPixelPair) - 0.5f;
  const glm::vec2 shift = point.uv_per_x * place.x + point.uv_per_y * place.y;
  if (surfaces_.emits(point.instance))
    light[kSeen] = surfaces_.emission(point.instance, point.triangle, point.u, point.v, shift);
  return surfaces_.vertexAt(point.instance, point.triangle, point.u, point.v, point.geometric_normal,
                            -point.to_eye, shift);
}

PathLight Paths::trace(const CameraPoint& point, const Sampler& sampler, std::size_t& rays,
                       std::vector<trace::LoggedRay>* log) const {
  Walk walk{sampler, rays, log};
  walk.vertex = firstVertex(point, sampler, walk.light);
  walk.to_view = point.to_eye;
  for (;; ++walk.depth) {
    if (walk.vertex.lobes.black) break;
    walk.sources = walk.depth == 0 ? direct_ : indirect_;
    const bool go_on = walk.depth < last_depth_;
    const PointLobes lobes(walk.vertex.lobes, walk.vertex.normal, walk.to_view);
    walk.lobes = &lobes;
    walk.origin = walk.vertex.rayOrigin();
    if (walk.sources.lamps) fromLamps(walk);
    if (walk.sources.environment && sample_lights_) fromEnvironment(walk);
    if (walk.sources.emitters && sample_lights_) fromEmitters(walk);
    const bool by_lobes = sample_lobes_ && (walk.sources.environment || walk.sources.emitters);
    if (!go_on && !by_lobes) break;
    if (!step(walk, go_on)) break;
  }
  return walk.light;
}

}  // namespace gloam::reference
