// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Instant radiosity (Keller 1997) from every light of the scene, as interleaved sampling wants it (Wald et al. 2002; Segovia, Wald
// 2008; row RF-1): several sets of virtual lights, each of which holds all light by itself.
#pragma once

#include "frame/frame_inputs.h"
#include "visibility/visibility.h"
#include "vpls/walks_shared.h"

namespace gloam::vpls {

struct WalkOptions {
  int sets = 16;  ///< n * m
  int direct =
      16;  ///< rows a set for surfaces that glow and the environment, of both together; lamps come on top
  int indirect =
      32;  ///< rows a set for surfaces that sources light; each further bounce has half as many as the one before
  int bounces = 1;  ///< surfaces that light meets before it reaches the receiver; 0: direct light alone
  /// Rows a set for punctual lamps themselves: all of them where there are no more, else a choice by power. They light surfaces
  /// either way.
  int most_lamps = 16;
  /// So many times more rows for lit surfaces are made, and those kept, more or less brightened, that add most where the camera looks (RF-7). For
  /// scenes of which little is seen or lit. 1: all that are made are kept.
  int candidates = 1;
  /// Up to half of the paths from far away come down about what the camera sees: in a wide scene most others light nothing that matters.
  bool focus = true;
};

/// Sets of virtual lights on the device. Rows of a set: lamps, then what glows and the environment, then lit surfaces, then rows
/// of kSightNothing. The set's row says where they are: first; lamps: how many of the first kind; direct: of the first and
/// second; count: of all three.
struct Walks {
  gpu::BufferRef rows;                                        ///< WalkVpl, stride a set
  gpu::BufferRef sets;                                        ///< visibility::SightSet
  std::uint32_t set_count = 0;                                ///< 0: nothing was asked for
  std::uint32_t stride = 0;                                   ///< rows from set to set, a multiple of 4
  std::uint32_t words() const { return (stride + 31) / 32; }  ///< for visibility::Question
};

/// The function of walks.glsl: the cosine at a lit surface's light, `height` metres above its plane.
float discCosine(float height, float squared_distance, float bound);
/// The function of walks.glsl: irradiance that a light throws, unshadowed, on a plane that faces it, and the way to it.
glm::vec3 walkIrradiance(const WalkVpl& vpl, const glm::vec3& position, glm::vec3& to_light);

/// Made anew each frame from the same quasi-random points, so that lights glide as things move.
class Walker {
 public:
  Walker();
  ~Walker();

  /// Adds the host pass "vpls.walks", and "vpls.seen" before it where there are candidates or light comes from far away. `world` is updated in it. Throws Error for counts below 0, more than 256 sets, and more
  /// rows than a buffer of the device holds.
  Walks record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const WalkOptions& options,
               visibility::HostWorld& world);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gloam::vpls
