// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/carriers.h"

#include "scene/transforms.h"

namespace gloam::frame {

Carriers::Carriers(const Scene& scene) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (!scene.nodes[n].neighbourhood) continue;
    Known known{{scene.nodes[n].name, scene.nodes[n].neighbourhood, glm::mat4(1.0f)},
                std::vector<std::uint8_t>(scene.nodes.size(), 0),
                std::vector<glm::mat4>(scene.nodes.size(), glm::mat4(1.0f))};
    std::vector<std::size_t> open = {n};
    known.below[n] = 1;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (const int child : scene.nodes[at].children) {
        const Node& node = scene.nodes[std::size_t(child)];
        const glm::mat4 local =
            node.matrix ? *node.matrix : composeTrs({node.translation, node.rotation, node.scale});
        known.below[std::size_t(child)] = 1;
        known.carrier_from_node[std::size_t(child)] = known.carrier_from_node[at] * local;
        open.push_back(std::size_t(child));
      }
    }
    known_.push_back(std::move(known));
  }
  for (const Node& node : scene.nodes) instanced_.push_back(!node.instances.empty());
}

void Carriers::pose(const PosedScene& posed) {
  shown_.clear();
  of_instances_.assign(posed.instances.size(), kNoCarrier);
  for (const Known& known : known_) {
    bool found = false;
    for (const Instance& instance : posed.instances) {
      if (instance.node < 0 || std::size_t(instance.node) >= known.below.size()) continue;
      const std::size_t node = std::size_t(instance.node);
      if (found || !known.below[node] || instance.deformed() || instanced_[node]) continue;
      found = true;
      shown_.push_back(known.carrier);
      shown_.back().world_from_node =
          instance.world_from_object * glm::inverse(known.carrier_from_node[node]);
    }
    if (!found) continue;
    for (std::size_t i = 0; i < posed.instances.size(); ++i) {
      const int node = posed.instances[i].node;
      if (node >= 0 && std::size_t(node) < known.below.size() && known.below[std::size_t(node)])
        of_instances_[i] = std::uint32_t(shown_.size() - 1);
    }
  }
}

}  // namespace gloam::frame
