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
};

/// Throws Error where proxies and emission do not fit together.
Rows rowsOf(std::span<const frame::Proxy> proxies, const frame::Emission& emission);

/// SL-9: adds point lamps as balls of that radius (metres) that glow as brightly and block nothing; says which stand within an
/// object. Lamps of other kinds are left out.
void addLamps(Rows& rows, std::span<const frame::LightRow> lamps, float radius, Warnings& warnings);

/// SL-6: spheres of different objects that meet, told by how many pairs of objects do; nothing where none do.
void warnOfMeetingObjects(const Rows& rows, Warnings& warnings);

}  // namespace gloam::spherical_lights
