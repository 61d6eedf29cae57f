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

void Paths::castShadows(Batch& batch, LightPath direct) const {
  const LightLanes& toward = batch.toward;
  for (std::uint32_t rest = toward.wanted & batch.used(); rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const trace::Ray ray{batch.lanes.origin.get(i), toward.direction.get(i), 0.0f, toward.t_far.at[i]};
    batch.record(ray, true);
    if (!tracer_.occluded(ray)) batch.add(i, direct, toward.light.get(i));
  }
}

void Paths::fromEnvironment(Batch& batch) const {
  environment_->at(batch.sky_by_light, batch.sky_directions, batch.above, batch.sky);
  batch.toward.direction = batch.sky_directions;
  lightFromSky(batch.lanes, batch.sky.radiance, batch.sky.pdf, both_, batch.toward);
  castShadows(batch, kEnvironmentDirect);
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
