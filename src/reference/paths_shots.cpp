// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Veach 1997, chapter 10, no longer than it has to be: a vertex of the path is joined to where a ray from a lamp lands. The same
// two vertices and lamp are found by the step by lobes, too; the power heuristic joins both ways, by their densities over area.
#include <bit>

#include "reference/paths_batch.h"

namespace gloam::reference {

// Rays from lamps to the lanes of `shots`; what these send on if they are seen. Returns the bits of those that got anywhere.
std::uint32_t Paths::shoot(Batch& batch, PathLanes& lanes, ShotLanes& shots) const {
  LaneBits which{}, unused, u, v;
  if (lamps_.size() > 1) numbersOfLanes(batch.shotScramble(0), batch.lanes.place, which, unused);
  numbersOfLanes(batch.shotScramble(1), batch.lanes.place, u, v);
  Surfaces::Arrivals& arrivals = batch.shot->arrivals;
  arrivals.clear();
  std::uint32_t landed = 0;
  int lamp[kLanes];
  for (int i = 0; i < batch.count; ++i) {
    const LampShots::Shot shot =
        shots_.shoot(which.at[i], {Sampler::toUnit(u.at[i]), Sampler::toUnit(v.at[i])});
    const trace::Ray ray{lamps_[std::size_t(shot.lamp)].position, shot.direction};
    batch.record(ray, false);
    const trace::Hit hit = tracer_.closest(ray);
    if (!hit) continue;
    const glm::vec3 way = batch.lanes.position.get(i) - (ray.origin + hit.distance * ray.direction);
    const float length = glm::length(way);
    if (!(length > 0.0f)) continue;
    // On the side of the light, or nothing comes back.
    if (glm::dot(way, hit.geometric_normal) * glm::dot(ray.direction, hit.geometric_normal) >= 0.0f) continue;
    lanes.to_view.set(i, way / length);
    lamp[i] = shot.lamp;
    if (surfaces_.arrive(arrivals, i, hit)) landed |= 1u << i;
  }
  if (landed == 0) return 0;
  surfaces_.setVertices(lanes, arrivals, landed);
  for (std::uint32_t rest = landed; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Lamp& from = lamps_[std::size_t(lamp[i])];
    const Lamp::Arriving arriving = from.at(lanes.position.get(i));
    const float cosine = glm::dot(lanes.geometric_normal.get(i), arriving.to_lamp);
    const float pdf = from.shot_density * cosine / (arriving.distance * arriving.distance);
    if (!(pdf > 0.0f)) {
      landed &= ~(1u << i);
      continue;
    }
    shots.to_lamp.set(i, arriving.to_lamp);
    shots.irradiance.set(i, arriving.irradiance / pdf);
    shots.area_pdf.at[i] = pdf;
  }
  return landed;
}

void Paths::fromShots(Batch& batch) const {
  if (!batch.shot) batch.shot = std::make_unique<Batch::Shot>();
  PathLanes& lanes = batch.shot->lanes;
  ShotLanes& shots = batch.shot->shots;
  shots.landed = shoot(batch, lanes, shots);
  if (shots.landed == 0) return;
  lightFromShots(batch.lanes, lanes, shots, batch.toward);
  for (std::uint32_t rest = batch.toward.wanted & batch.used(); rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const trace::Ray ray{batch.lanes.origin.get(i), batch.toward.direction.get(i), 0.0f,
                         batch.toward.t_far.at[i]};
    batch.record(ray, true);
    if (!tracer_.occluded(ray)) batch.addAfter(i, kLocalDirect, batch.depth + 1, batch.toward.light.get(i));
  }
}

}  // namespace gloam::reference
