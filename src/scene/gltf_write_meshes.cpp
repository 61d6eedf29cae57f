// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Meshes as primitives; those that stand on one node together are one glTF mesh.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <set>

#include "scene/gltf_transfer.h"
#include "scene/gltf_write_parts.h"

namespace gloam {
namespace {

using Json = nlohmann::json;
using Target = GlbBuilder::Target;

template <typename Vector>
std::span<const float> flat(const std::vector<Vector>& values) {
  return {values.empty() ? nullptr : glm::value_ptr(values.front()),
          values.size() * std::size_t(Vector::length())};
}

/// A vertex's influences in fours; what is missing has weight 0.
void writeSkinning(const Mesh& mesh, Json& attributes, GlbBuilder& builder) {
  const std::size_t n = std::size_t(mesh.influences), sets = (n + 3) / 4;
  for (std::size_t set = 0; set < sets; ++set) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      for (std::size_t k = 4 * set; k < 4 * set + 4; ++k) {
        const float weight = k < n ? mesh.weights[v * n + k] : 0.0f;
        weights.push_back(weight);
        joints.push_back(weight > 0.0f ? mesh.joints[v * n + k] : std::uint16_t(0));
      }
    }
    attributes[fmt::format("JOINTS_{}", set)] = builder.addShorts(joints, 4, Target::kVertices);
    attributes[fmt::format("WEIGHTS_{}", set)] = builder.addFloats(weights, 4, Target::kVertices);
  }
}

class MeshWriter {
 public:
  MeshWriter(const Scene& scene, const WriteOptions& options, GlbBuilder& builder)
      : scene_(scene), options_(options), builder_(builder), written_(scene.meshes.size()) {}

  Json primitive(int index, std::size_t targets) {
    const Mesh& mesh = scene_.meshes[std::size_t(index)];
    Json& known = written_[std::size_t(index)];
    if (known.is_null()) known = firstTime(mesh);
    Json primitive = known;
    if (targets > 0) primitive["targets"] = morphTargets(mesh, targets);
    return primitive;
  }

 private:
  // Without a normal map tangents carry nothing.
  bool keepsTangents(const Mesh& mesh) const {
    return !mesh.tangents.empty() && bool(scene_.materials[std::size_t(mesh.material)].normal_map);
  }

  Json firstTime(const Mesh& mesh) {
    Json attributes = {{"POSITION", builder_.addFloats(flat(mesh.positions), 3, Target::kVertices, true)}};
    if (!mesh.normals.empty())
      attributes["NORMAL"] = builder_.addFloats(flat(mesh.normals), 3, Target::kVertices);
    if (keepsTangents(mesh))
      attributes["TANGENT"] = builder_.addFloats(flat(mesh.tangents), 4, Target::kVertices);
    for (std::size_t set = 0; set < mesh.uv_sets.size(); ++set) {
      attributes[fmt::format("TEXCOORD_{}", set)] =
          builder_.addFloats(flat(mesh.uv_sets[set]), 2, Target::kVertices);
    }
    if (!mesh.colors.empty())
      attributes["COLOR_0"] = builder_.addFloats(flat(mesh.colors), 4, Target::kVertices);
    writeSkinning(mesh, attributes, builder_);
    Json primitive = {{"attributes", std::move(attributes)},
                      {"indices", builder_.addIndices(mesh.indices, mesh.vertexCount())},
                      {"material", mesh.material}};
    if (mesh.transfer) {
      primitive["extensions"][kTransferExtension] =
          transferJson(*mesh.transfer, mesh, options_.half_float, builder_);
      builder_.use(kTransferExtension);
    }
    return primitive;
  }

  /// All primitives of a mesh need the same number of targets: missing ones move nothing.
  Json morphTargets(const Mesh& mesh, std::size_t count) {
    const auto displacements = [&](const std::vector<glm::vec3>& values, bool bounds) {
      return values.empty() ? builder_.addZeros(mesh.vertexCount(), 3, bounds)
                            : builder_.addFloats(flat(values), 3, Target::kVertices, bounds);
    };
    bool normals = false, tangents = false;
    for (const MorphTarget& target : mesh.morph_targets) {
      normals = normals || !target.normals.empty();
      tangents = tangents || (!target.tangents.empty() && keepsTangents(mesh));
    }
    Json targets = Json::array();
    for (std::size_t t = 0; t < count; ++t) {
      const MorphTarget target = t < mesh.morph_targets.size() ? mesh.morph_targets[t] : MorphTarget{};
      Json json = {{"POSITION", displacements(target.positions, true)}};
      if (normals) json["NORMAL"] = displacements(target.normals, false);
      if (tangents) json["TANGENT"] = displacements(target.tangents, false);
      targets.push_back(std::move(json));
    }
    return targets;
  }

  const Scene& scene_;
  const WriteOptions& options_;
  GlbBuilder& builder_;
  std::vector<Json> written_;  // primitives without morph targets, null until written
};

}  // namespace

int MeshGroups::of(const std::vector<int>& meshes) const {
  return int(std::find(groups.begin(), groups.end(), meshes) - groups.begin());
}

MeshGroups groupMeshes(const Scene& scene) {
  std::set<std::vector<int>> lists;
  std::set<int> placed;
  for (const Node& node : scene.nodes) {
    if (node.meshes.empty()) continue;
    lists.insert(node.meshes);
    placed.insert(node.meshes.begin(), node.meshes.end());
  }
  for (int mesh = 0; mesh < int(scene.meshes.size()); ++mesh) {
    if (!placed.count(mesh)) lists.insert({mesh});
  }
  return {{lists.begin(),
           lists.end()}};  // ordered by their first mesh: a reader finds meshes in the order they had
}

void writeMeshes(const Scene& scene, const MeshGroups& groups, const WriteOptions& options,
                 GlbBuilder& builder) {
  MeshWriter writer(scene, options, builder);
  for (const std::vector<int>& group : groups.groups) {
    std::size_t targets = 0;
    for (const int index : group)
      targets = std::max(targets, scene.meshes[std::size_t(index)].morph_targets.size());
    Json mesh = {{"primitives", Json::array()}};
    const std::string& name = scene.meshes[std::size_t(group.front())].name;
    if (!name.empty()) mesh["name"] = name;
    for (const int index : group) mesh["primitives"].push_back(writer.primitive(index, targets));
    builder.add("meshes", std::move(mesh));
  }
}

}  // namespace gloam
