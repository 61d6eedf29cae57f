// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sixteen paths side by side and what they work out between two rays, in vectors (path_lanes_simd.cpp). What comes to a lane
// does not depend on its company. Lanes at and beyond a batch's count hold leftovers: worked on, never read.
#pragma once

#include <span>

#include "reference/lamps.h"
#include "reference/lanes.h"
#include "trace/rays.h"

namespace gloam::reference {

struct PathLanes {
  LaneBits place;  ///< Sampler::place
  LaneInts slot;   ///< whose light it is
  LaneVectors throughput;
  // The vertex.
  LaneVectors position, origin;          ///< rays start at the latter
  LaneVectors geometric_normal, normal;  ///< unit, toward whoever looks; the second to be shaded by
  LaneVectors to_view, mirror;           ///< unit; mirror only where `glossy`
  LaneVectors diffuse, specular;         ///< brdf::Lobes
  LaneFloats exponent;
  LaneFloats specular_share;  ///< brdf::specularProbability
  // The step by lobes.
  LaneVectors direction, step;  ///< the latter: throughput beyond it; 0 where there is none
  LaneFloats pdf;               ///< 1/sr; 0: no step
  /// Density, 1/m^2, of the step that found this vertex; infinite where no ray of a lamp could have found it for the path.
  LaneFloats found;
  std::uint32_t going;  ///< bit i: lane i has a step that brings something
  bool glossy;          ///< some lane has a Phong lobe
};

/// What paths need of a corner of a triangle, in the world; comes from memory in one piece.
struct alignas(32) WorldVertex {
  glm::vec3 position, normal;
  glm::vec2 uv{0.0f};
};
/// Where rays have met triangles: only where to find what is there, so that all of it is sent for at once.
struct MeetingLanes {
  const WorldVertex* corners[kLanes][3];
  const float* lobes[kLanes];  ///< diffuse, specular, exponent, specular_share
  LaneFloats u;
  /// v; Hit::geometric_normal.
  alignas(64) float v_and_face[kLanes][4];
  void set(int lane, const trace::Hit& hit) {
    u.at[lane] = hit.u;
    v_and_face[lane][0] = hit.v;
    for (int i = 0; i < 3; ++i) v_and_face[lane][i + 1] = hit.geometric_normal[i];
  }
};
/// What else is known there.
struct PlaceLanes {
  LaneFloats u, v;  ///< WorldVertex::uv
  LaneFloats side;  ///< -1: seen from the side on which the mesh's normals are not
};
/// Sets position, origin, lobes and both normals of those lanes (a bit each), by the rule of sides (frame/README.md); from
/// to_view. The shading normal is not yet tilted.
void setVertices(PathLanes& lanes, const MeetingLanes& meetings, std::uint32_t mask, PlaceLanes& places);
/// Those lanes take their steps and move up to the front: `step` becomes throughput, and they look back.
void takeSteps(PathLanes& lanes, std::uint32_t mask);
/// Sets mirror, once the normals stand.
void setMirrors(PathLanes& lanes);

/// Chooses steps by the lobes (brdf::sampleLobes, the choice of the lobe taken out of the first number).
void chooseSteps(PathLanes& lanes, const Sampler::Scramble& scramble);

/// brdf::evaluateLobes and lobesPdf of one direction a lane.
void lobesOfLanes(const PathLanes& lanes, const LaneVectors& directions, LaneVectors& values,
                  LaneFloats& pdfs);

/// Rays toward light, and what they bring if nothing is in the way.
struct LightLanes {
  LaneVectors direction, light;
  LaneFloats t_far;
  std::uint32_t wanted;  ///< bit i: lane i has light and its ray would leave on the right side
};
/// Bit i: lane i's direction lies above its surface.
std::uint32_t lanesAbove(const PathLanes& lanes, const LaneVectors& directions);
/// Light from afar: `direction` is set and has density `pdf`. `both`: joined with the lobes' by the power heuristic (Veach
/// 1997). `light` becomes that of a radiance of 1.
void lightFromSky(const PathLanes& lanes, const LaneFloats& pdf, bool both, LightLanes& light);
/// Light that steps find in a sky of radiance 1: 0 where there is none.
void lightOfSteps(const PathLanes& lanes, const LaneFloats& pdf, bool both, LaneVectors& light);
/// Points on triangles that shine.
struct EmitterLanes {
  LaneVectors position, normal, radiance;
  LaneFloats area_pdf, ray_offset;
};
void lightFromEmitters(const PathLanes& lanes, const EmitterLanes& points, bool both, LightLanes& light);
void lightFromLamp(const PathLanes& lanes, const Lamp& lamp, LightLanes& light);
/// Where rays from lamps have landed: a second set of lanes is there, and looks at the first.
struct ShotLanes {
  LaneVectors to_lamp;     ///< unit
  LaneVectors irradiance;  ///< across the way to the lamp, divided by area_pdf
  LaneFloats area_pdf;     ///< 1/m^2
  std::uint32_t landed;    ///< bit i: lane i has a vertex
};
/// Joined with the step's density by the power heuristic, as light from lamps is at vertices that were `found`.
void lightFromShots(const PathLanes& lanes, const PathLanes& there, const ShotLanes& shots,
                    LightLanes& light);
/// One of many, by what it would give without shadow; what is left of the number chooses on.
void lightFromOneLamp(const PathLanes& lanes, std::span<const Lamp> lamps, const Sampler::Scramble& scramble,
                      LightLanes& light);

}  // namespace gloam::reference
