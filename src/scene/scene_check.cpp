// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/scene_check.h"

#include <fmt/format.h>

#include <cmath>

namespace gloam {
namespace {

class SceneCheck {
 public:
  SceneCheck(const Scene& scene, const std::string& place, bool finished)
      : scene_(scene), place_(place), finished_(finished) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
      checkTexture(scene.textures[i], fmt::format("texture {}", i));
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
      checkMaterial(scene.materials[i], fmt::format("material {}", i));
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
      checkMesh(scene.meshes[i], fmt::format("mesh {}", i));
    for (std::size_t i = 0; i < scene.skins.size(); ++i) checkSkin(scene.skins[i], fmt::format("skin {}", i));
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
      checkNode(static_cast<int>(i), fmt::format("node {}", i));
    for (const Animation& animation : scene.animations)
      for (const AnimationChannel& channel : animation.channels)
        checkChannel(channel, "animation '" + animation.name + "'");
    checkTree();
  }

 private:
  void require(bool good, const std::string& where, const char* what) const {
    if (!good) throw Error(place_, where + ": " + what);
  }
  template <typename T>
  static bool inRange(int index, const std::vector<T>& array) {
    return index >= 0 && static_cast<std::size_t>(index) < array.size();
  }

  void checkTexture(const Texture& t, const std::string& where) const {
    require(!finished_ || (t.width > 0 && t.height > 0 &&
                           t.rgba.size() == std::size_t(4) * std::size_t(t.width) * std::size_t(t.height)),
            where, "size and pixels do not agree");
  }

  void checkMaterial(const Material& m, const std::string& where) const {
    for (const TextureSlot* slot :
         {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.occlusion_map, &m.emission_map})
      require(!*slot || (inRange(slot->texture, scene_.textures) && slot->uv_set >= 0), where,
              "texture out of range");
  }

  void checkMesh(const Mesh& m, const std::string& where) const {
    const std::size_t n = m.vertexCount();
    const auto fits = [&](std::size_t size) { return (size == 0 && !finished_) || size == n; };
    const auto fitsOrNone = [&](std::size_t size) { return size == 0 || size == n; };
    require(m.indices.size() % 3 == 0, where, "no whole triangles");
    require(!finished_ || (n > 0 && !m.indices.empty()), where, "no triangles");
    require(fits(m.normals.size()) && fits(m.tangents.size()), where,
            "normals and tangents do not fit the vertices");
    require(fitsOrNone(m.colors.size()), where, "colours do not fit the vertices");
    require(inRange(m.material, scene_.materials), where, "material out of range");
    for (const auto& uv : m.uv_sets)
      require(uv.size() == n, where, "texture coordinates do not fit the vertices");
    const Material& material = scene_.materials[static_cast<std::size_t>(m.material)];
    for (const TextureSlot* slot : {&material.base_color_map, &material.metallic_roughness_map,
                                    &material.normal_map, &material.occlusion_map, &material.emission_map})
      require(!finished_ || !*slot || inRange(slot->uv_set, m.uv_sets), where,
              "texture coordinates are missing");
    const auto influences = static_cast<std::size_t>(std::max(m.influences, 0));
    require(m.joints.size() == n * influences && m.weights.size() == n * influences, where,
            "joints do not fit the vertices");
    for (const MorphTarget& t : m.morph_targets)
      require(fitsOrNone(t.positions.size()) && fitsOrNone(t.normals.size()) && fitsOrNone(t.tangents.size()),
              where, "morph targets do not fit the vertices");
    for (const std::uint32_t index : m.indices) require(index < n, where, "index out of range");
    for (const glm::vec3& p : m.positions)
      require(!finished_ || (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)), where,
              "a position is not finite");
    if (m.transfer) {
      const bool texels = m.transfer->ofTexels();
      const std::size_t points = texels ? static_cast<std::size_t>(m.transfer->texel_width) *
                                              static_cast<std::size_t>(m.transfer->texel_height)
                                        : n;
      const auto size = points * static_cast<std::size_t>(m.transfer->order * m.transfer->order);
      require(m.transfer->direct.size() == size &&
                  (m.transfer->indirect.empty() || m.transfer->indirect.size() == 3 * size),
              where, texels ? "transfer does not fit the texels" : "transfer does not fit the vertices");
      require(!texels || inRange(m.transfer->uv_set, m.uv_sets), where,
              "the lightmap's coordinates are missing");
      const GlossyTransfer& glossy = m.transfer->glossy;
      require(glossy.visibility.size() == n * glossy.visibilityCount() &&
                  (glossy.indirect.empty() || glossy.indirect.size() == 3 * n * glossy.matrixCount()),
              where, "glossy transfer does not fit the vertices");
    }
  }

  void checkSkin(const Skin& s, const std::string& where) const {
    require(s.joints.size() == s.joint_from_mesh.size(), where, "joints and matrices do not agree");
    for (const int joint : s.joints) require(inRange(joint, scene_.nodes), where, "joint out of range");
  }

  void checkNode(int index, const std::string& where) const {
    const Node& node = scene_.nodes[static_cast<std::size_t>(index)];
    for (const int child : node.children)
      require(inRange(child, scene_.nodes) && scene_.nodes[static_cast<std::size_t>(child)].parent == index,
              where, "children and parents do not agree");
    require(node.skin == kNone || inRange(node.skin, scene_.skins), where, "skin out of range");
    require(node.camera == kNone || inRange(node.camera, scene_.cameras), where, "camera out of range");
    require(node.light == kNone || inRange(node.light, scene_.lights), where, "light out of range");
    for (const int index_of_mesh : node.meshes) {
      require(inRange(index_of_mesh, scene_.meshes), where, "mesh out of range");
      const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(index_of_mesh)];
      require(node.morph_weights.empty() || node.morph_weights.size() == mesh.morph_targets.size(), where,
              "morph weights do not fit the mesh");
      if (node.skin == kNone) continue;
      const std::size_t joints = scene_.skins[static_cast<std::size_t>(node.skin)].joints.size();
      for (const std::uint16_t joint : mesh.joints)
        require(joint < joints, where, "a vertex's joint is out of range");
    }
  }

  void checkChannel(const AnimationChannel& c, const std::string& where) const {
    require(inRange(c.node, scene_.nodes), where, "node out of range");
    const std::size_t values = c.interpolation == AnimationChannel::Interpolation::kCubicSpline ? 3 : 1;
    require(!c.times_s.empty() && c.components > 0 &&
                c.values.size() == c.times_s.size() * values * static_cast<std::size_t>(c.components),
            where, "keys and values do not agree");
  }

  /// Every node that can be reached from the roots is reached once, and something there has triangles.
  void checkTree() const {
    std::vector<bool> seen(scene_.nodes.size(), false);
    std::vector<int> open;
    for (const int root : scene_.roots) {
      require(inRange(root, scene_.nodes), "roots", "node out of range");
      open.push_back(root);
    }
    bool triangles = false;
    for (std::size_t at = 0; at < open.size(); ++at) {
      const auto index = static_cast<std::size_t>(open[at]);
      require(!seen[index], fmt::format("node {}", index), "is reached twice");
      seen[index] = true;
      const Node& node = scene_.nodes[index];
      triangles = triangles || !node.meshes.empty();
      open.insert(open.end(), node.children.begin(), node.children.end());
    }
    if (finished_ && !triangles) {
      std::string why;
      for (const std::string& line : scene_.warnings)
        if (line.find("triangles") != line.npos || line.find("primitives") != line.npos)
          why = " (" + line + ")";
      throw Error(place_, "there are no triangles to draw" + why);
    }
  }

  const Scene& scene_;
  const std::string& place_;
  const bool finished_;
};

}  // namespace

void checkScene(const Scene& scene, const std::string& place, SceneStage stage) {
  SceneCheck(scene, place, stage == SceneStage::kFinished);
}

}  // namespace gloam
