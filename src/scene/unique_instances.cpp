// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sharing undone: baked transfer belongs to a mesh in one place of one scene.
#include <gloam/scene.h>

#include <algorithm>

#include "scene/transforms.h"

namespace gloam {
namespace {

class Unsharing {
 public:
  explicit Unsharing(const Scene& scene)
      : source_(scene), result_(scene), copied_(scene.meshes.size(), kNone) {
    result_.meshes.clear();
  }

  Scene run() {
    const std::size_t nodes = source_.nodes.size();
    for (std::size_t i = 0; i < nodes; ++i) {
      result_.nodes[i].meshes.clear();
      if (!shown_.empty() && !shown_[i]) continue;
      place(i);
    }
    return std::move(result_);
  }

  void markShown() {
    shown_.assign(source_.nodes.size(), false);
    std::vector<int> open = source_.roots;
    while (!open.empty()) {
      const std::size_t node = std::size_t(open.back());
      open.pop_back();
      if (shown_[node]) continue;
      shown_[node] = true;
      open.insert(open.end(), source_.nodes[node].children.begin(), source_.nodes[node].children.end());
    }
  }

 private:
  bool rigid(const Node& node, int mesh) const {
    const Mesh& m = source_.meshes[std::size_t(mesh)];
    return m.morph_targets.empty() && (node.skin == kNone || m.influences == 0);
  }

  /// A copy for a rigid mesh; the one copy for one that deforms.
  int meshFor(const Node& node, int mesh) {
    int& first = copied_[std::size_t(mesh)];
    if (!rigid(node, mesh) && first != kNone) return first;
    result_.meshes.push_back(source_.meshes[std::size_t(mesh)]);
    const int index = int(result_.meshes.size()) - 1;
    if (!rigid(node, mesh)) first = index;
    return index;
  }

  void place(std::size_t index) {
    const Node& node = source_.nodes[index];
    const bool skinned = node.skin != kNone;
    if (node.instances.empty() || skinned) {
      for (const int mesh : node.meshes) result_.nodes[index].meshes.push_back(meshFor(node, mesh));
      if (skinned) result_.nodes[index].instances.clear();  // joints place it: copies would coincide
      return;
    }
    result_.nodes[index].instances.clear();
    for (std::size_t copy = 0; copy < node.instances.size(); ++copy) {
      Node child;
      child.name = node.name + " " + std::to_string(copy + 1);
      child.parent = int(index);
      if (const std::optional<Trs> trs = decomposeTrs(node.instances[copy])) {
        child.translation = trs->translation;
        child.rotation = trs->rotation;
        child.scale = trs->scale;
      } else {
        child.matrix = node.instances[copy];
      }
      for (const int mesh : node.meshes) child.meshes.push_back(meshFor(node, mesh));
      child.morph_weights = node.morph_weights;
      result_.nodes[index].children.push_back(int(result_.nodes.size()));
      result_.nodes.push_back(std::move(child));
    }
    copyMorphAnimation(int(index), int(node.instances.size()));
  }

  /// Weights of morph targets that an animation moved on the node now have to move on its children.
  void copyMorphAnimation(int node, int copies) {
    for (Animation& animation : result_.animations) {
      const std::size_t before = animation.channels.size();
      for (std::size_t c = 0; c < before; ++c) {
        if (animation.channels[c].node != node ||
            animation.channels[c].path != AnimationChannel::Path::kWeights) {
          continue;
        }
        for (int k = 1; k <= copies; ++k) {
          AnimationChannel channel = animation.channels[c];
          channel.node = int(result_.nodes.size()) - k;
          animation.channels.push_back(std::move(channel));
        }
      }
      std::erase_if(animation.channels, [&](const AnimationChannel& channel) {
        return channel.node == node && channel.path == AnimationChannel::Path::kWeights;
      });
    }
    result_.nodes[std::size_t(node)].morph_weights.clear();
  }

  const Scene& source_;
  Scene result_;
  std::vector<int> copied_;  // of meshes that deform
  std::vector<bool> shown_;
};

}  // namespace

Scene makeInstancesUnique(const Scene& scene) {
  Unsharing unsharing(scene);
  unsharing.markShown();
  return unsharing.run();
}

}  // namespace gloam
