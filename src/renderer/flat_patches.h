// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What only receives (ground, walls, rooms) as rectangles: a few large ones that stand in the light, and more that send it; those of what
// shines by itself (panels, screens).
#pragma once

#include <gloam/spheres.h>

#include "frame/emission.h"

namespace gloam {

/// Rectangles that stand in the light: about so many of all things together, at least those of each thing's sides; the largest
/// kMostBlockers of them.
inline constexpr int kBlockingPatches = 12, kMostBlockers = 24;
/// About so many that shine, at least one to each side of a thing.
inline constexpr int kGlowingPatches = 32;

class FlatPatches {
 public:
  FlatPatches() = default;
  /// At most that many rectangles of each kind, over all rigid things without spheres, as large as they stand at time 0; 0: none.
  FlatPatches(const Scene& scene, const SceneSpheres& spheres, int senders, int blockers, int glowing);
  /// Adds them where they are now.
  void pose(const PosedScene& posed, frame::Emission& emission) const;
  std::vector<frame::Patch> blockers(const PosedScene& posed) const;

 private:
  struct Placed {
    int node = kNone, mesh = kNone, copy = 0;
    std::vector<frame::Patch> senders, blockers, glowing;  // in the object
  };
  std::vector<Placed> things_;
};

}  // namespace gloam
