// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Directions by light (Veach 1997, chapter 9), all lanes of a batch for one kind of source, then their shadow rays.
#include <cmath>

#include "reference/paths_batch.h"

namespace gloam::reference {

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

}  // namespace gloam::reference
