// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nodes that carry neighbourhood transfer (gloam/neighbourhood.h), and where they are in this frame.
#pragma once

#include <gloam/scene.h>

#include <cstdint>

namespace gloam::frame {

inline constexpr std::uint32_t kNoCarrier = 0xffffffffu;

struct Carrier {
  std::string name;
  std::shared_ptr<const NeighbourhoodTransfer> transfer;
  glm::mat4 world_from_node{1.0f};
};

/// A posed scene has instances, no nodes: where a carrier is follows from a mesh that stands in it. What hangs between the two
/// is taken as the file places it.
class Carriers {
 public:
  Carriers() = default;
  explicit Carriers(const Scene& scene);
  void pose(const PosedScene& posed);

  /// Those of which something is shown.
  const std::vector<Carrier>& shown() const { return shown_; }
  /// By instance: which of shown() it belongs to, or kNoCarrier.
  const std::vector<std::uint32_t>& ofInstances() const { return of_instances_; }

 private:
  struct Known {
    Carrier carrier;
    std::vector<std::uint8_t> below;           ///< by node
    std::vector<glm::mat4> carrier_from_node;  ///< by node, where below
  };
  std::vector<Known> known_;
  std::vector<std::uint8_t> instanced_;  ///< by node: EXT_mesh_gpu_instancing, which says nothing of its node
  std::vector<Carrier> shown_;
  std::vector<std::uint32_t> of_instances_;
};

}  // namespace gloam::frame
