// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one service for "does this point see that light": many points, each with the lights of its set, answered in bits by the
// fastest means for the device.
#pragma once

#include <memory>
#include <string>

#include "frame/gpu_scene.h"
#include "visibility/visibility_shared.h"

namespace gloam::visibility {

class HostWorld;

enum class Means : std::uint8_t {
  kAuto,   ///< host where the device is a software driver, else device
  kHost,   ///< Embree in a host pass
  kDevice  ///< a hierarchy of boxes in a compute pass
};
/// Of the options' words: auto, host, device; kAuto for any other.
Means meansNamed(const std::string& name);

/// One batch. All buffers are written by earlier passes of the frame or uploaded.
struct Question {
  gpu::BufferRef points;  ///< SightPoint, point_count of them
  std::uint32_t point_count = 0;
  gpu::BufferRef lights;  ///< rows of light_bytes each, a SightEnd at the start of each
  std::uint32_t light_bytes = sizeof(SightEnd);  ///< a multiple of 4
  gpu::BufferRef sets;                           ///< SightSet, set_count of them
  std::uint32_t set_count = 0;
  /// Words of 32 bits a point; lights of a set beyond 32 * words are not looked at.
  std::uint32_t words = 0;
};

/// Points of one set should follow one another in rows of neighbours: then rays are coherent, and faster.
class Visibility {
 public:
  explicit Visibility(gpu::Device& device);
  ~Visibility();

  /// The scene on the host, as of the last pass that updated it: walks of light share it.
  HostWorld& world();
  Means choose(Means means) const;  ///< kHost or kDevice

  /// Adds the passes "NAME" (and "NAME_hierarchy" for the device). The result has question.words * question.point_count
  /// words: light k of its set, counted from the set's first, is seen by point p where bit k % 32 of word
  /// (k / 32) * point_count + p is set. Bits of lights that do not exist are 0. Throws Error where that is more than a buffer
  /// of the device holds.
  gpu::BufferRef record(gpu::FrameGraph& graph, const std::string& name, const frame::GpuScene& scene,
                        const Question& question, Means means);

  std::uint64_t tracedRays() const;  ///< by the host, so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gloam::visibility
