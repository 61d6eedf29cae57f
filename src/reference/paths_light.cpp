// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Directions by light (Veach 1997, chapter 9), all lanes of a batch for one kind of source, then their shadow rays.
#include <bit>

#include "reference/paths_batch.h"

namespace gloam::reference {
namespace {

constexpr std::size_t kFewLamps = 8;  // so many all shine on what the camera sees

}  // namespace

// A bit for each lane whose light comes through.
template <class Free>
std::uint32_t Paths::shadowRays(Batch& batch, const Free& whenFree) const {
  const LightLanes& toward = batch.toward;
  std::uint32_t free = 0;
  for (std::uint32_t rest = toward.wanted & batch.used(); rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const trace::Ray ray{batch.lanes.origin.get(i), toward.direction.get(i), 0.0f, toward.t_far.at[i]};
    batch.record(ray, true);
    if (tracer_.occluded(ray)) continue;
    free |= 1u << i;
    whenFree(i);
  }
  return free;
}

void Paths::castShadows(Batch& batch, LightPath direct) const {
  shadowRays(batch, [&](int i) { batch.add(i, direct, batch.toward.light.get(i)); });
}

// The sky's own texels are read only where they are seen: they are far away in memory.
void Paths::addSky(Batch& batch, const SkyPlaces& places, const LaneVectors& directions, std::uint32_t free,
                   const LaneVectors& share) const {
  if (free == 0) return;
  LaneVectors radiance;
  environment_->radiance(places, directions, free, radiance);
  const auto path = std::size_t(pathAfter(kEnvironmentDirect, batch.depth));
  for (std::uint32_t rest = free; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    batch.light[std::size_t(batch.lanes.slot.at[i])][path] += share.get(i) * radiance.get(i);
  }
}

void Paths::fromEnvironment(Batch& batch) const {
  environment_->choose(batch.scramble(kEnvironment), batch.lanes.place, batch.sky_by_light,
                       batch.toward.direction);
  LaneFloats pdf;
  densitiesOf(batch.sky_by_light, pdf);
  lightFromSky(batch.lanes, pdf, both_, batch.toward);
  const std::uint32_t free = shadowRays(batch, [&](int i) { environment_->sendFor(batch.sky_by_light, i); });
  addSky(batch, batch.sky_by_light, batch.toward.direction, free, batch.toward.light);
}

void Paths::fromEmitters(Batch& batch) const {
  LaneBits which, unused, u, v;
  numbersOfLanes(batch.scramble(kEmitter), batch.lanes.place, which, unused);
  numbersOfLanes(batch.scramble(kEmitterPoint), batch.lanes.place, u, v);
  EmitterLanes points;
  for (int i = 0; i < batch.count; ++i) {
    const Emitters::Sample sample =
        emitters_.sample(which.at[i], {Sampler::toUnit(u.at[i]), Sampler::toUnit(v.at[i])});
    points.position.set(i, sample.position);
    points.normal.set(i, sample.normal);
    points.radiance.set(i, sample.radiance);
    points.area_pdf.at[i] = sample.area_pdf;
    points.ray_offset.at[i] = sample.ray_offset;
  }
  lightFromEmitters(batch.lanes, points, both_, batch.toward);
  castShadows(batch, kEmitterDirect);
}

void Paths::fromLamps(Batch& batch) const {
  if (lamps_.size() > 1 && (batch.depth > 0 || lamps_.size() > kFewLamps)) {
    lightFromOneLamp(batch.lanes, lamps_, batch.scramble(kLampAndRoulette), batch.toward);
    return castShadows(batch, kLocalDirect);
  }
  for (const Lamp& lamp : lamps_) {
    lightFromLamp(batch.lanes, lamp, batch.toward);
    castShadows(batch, kLocalDirect);
  }
}

}  // namespace gloam::reference
