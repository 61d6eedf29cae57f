// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a frame knows of spheres, as the kernels read it.
#pragma once

#include <gloam/scene.h>

#include <span>
#include <vector>

#include "frame/emission.h"
#include "frame/frame_shared.h"
#include "frame/proxy.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

namespace gloam::spherical_lights {

struct Rows {
  std::vector<SphereRow> spheres;
  std::vector<ObjectRow> objects;
  std::vector<PointRow> points;  ///< kDirections a sphere
  std::vector<SenderRow> senders;
  std::vector<SentRow> glow;         ///< world axes; empty where nothing glows
  std::vector<std::uint32_t> meets;  ///< `words` a sphere
  int words = 1;
  std::vector<PatchRow> sending_patches,
      blocking_patches;                ///< kPatchPoints points each of the first, after those of spheres
  std::uint32_t enclosed_patches = 0;  ///< of the first, at their head
  std::vector<std::uint32_t> listed;   ///< of each sphere, of its object: see listNeighbours
  std::vector<LevelRow> levels;        ///< see addCoarse
  std::vector<CoarseRow> coarse;
  std::vector<std::uint32_t> leaves;
};

/// Throws Error where proxies and emission do not fit together.
Rows rowsOf(std::span<const frame::Proxy> proxies, const frame::Emission& emission);
/// Samples of patches; to be called when all spheres are there.
void addPatchPoints(Rows& rows);

/// SL-9: adds point lamps as balls of that radius (metres) that glow as brightly and block nothing; leaves out, and tells, which stand
/// within an object. Lamps of other kinds are left out.
void addLamps(Rows& rows, std::span<const frame::LightRow> lamps, float radius, Warnings& warnings);

/// SL-9: what is flat and shines, rectangle by rectangle as balls of its area that send as a disc does, along its normal with the cosine.
void addGlowing(Rows& rows, std::span<const frame::Patch> patches);

/// SL-6: fills each sphere's list with those of its object that it does not meet (kPerObject), or those others that it meets.
/// Per sphere, each
/// then counts as an object.
void listNeighbours(Rows& rows, int blocking);

/// SL-8: spheres that bound groups of an object's, level by level, after all others; to be called last. Their glow is the mean over
/// those that they stand for by area, as what they send will be.
void addCoarse(Rows& rows, const frame::Emission& emission);

/// SL-6: spheres of different objects that meet, told by how many pairs of objects do; nothing where none do.
void warnOfMeetingObjects(const Rows& rows, Warnings& warnings);

}  // namespace gloam::spherical_lights
