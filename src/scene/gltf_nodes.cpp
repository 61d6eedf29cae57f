// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nodes, the shown scene and skins (glTF 2.0 specification, sections 3.5, 3.7.3; EXT_mesh_gpu_instancing,
// KHR_node_visibility).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "image/limits.h"
#include "scene/gltf_neighbourhood.h"
#include "scene/gltf_parts.h"
#include "scene/gltf_volume.h"
#include "scene/transforms.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

std::string placeOf(std::size_t node) {
  return fmt::format("nodes[{}]", node);
}

glm::quat unitQuaternion(GltfReading& reading, double x, double y, double z, double w,
                         const std::string& where) {
  double length = std::sqrt(x * x + y * y + z * z + w * w);
  if (isUnitLength(length)) length = 1.0;
  if (length > 1e-12)
    return {static_cast<float>(w / length), static_cast<float>(x / length), static_cast<float>(y / length),
            static_cast<float>(z / length)};
  reading.document.warn(where + ": a quaternion of length 0 is taken as no rotation");
  return {1.0f, 0.0f, 0.0f, 0.0f};
}

/// No product of a few of these leaves a float's range.
void checkReach(GltfReading& reading, const glm::vec3& v, const std::string& where) {
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(v[c]) <= 1e12f)) reading.document.fail(where, fmt::format("{} lies beyond 1e12", v[c]));
}

void readTransform(GltfReading& reading, const gloam_tinygltf::Node& source, Node& node,
                   const std::string& where) {
  const auto vec3 = [](const std::vector<double>& v) {
    return glm::vec3(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  };
  if (!source.translation.empty()) node.translation = vec3(source.translation);
  if (!source.scale.empty()) node.scale = vec3(source.scale);
  if (!source.rotation.empty())
    node.rotation = unitQuaternion(reading, source.rotation[0], source.rotation[1], source.rotation[2],
                                   source.rotation[3], where + ".rotation");
  checkReach(reading, node.translation, where + ".translation");
  checkReach(reading, node.scale, where + ".scale");
  if (source.matrix.empty()) return;
  glm::mat4 matrix;
  for (int i = 0; i < 16; ++i)
    matrix[i / 4][i % 4] = static_cast<float>(source.matrix[static_cast<std::size_t>(i)]);
  for (int column = 0; column < 4; ++column)
    checkReach(reading, glm::vec3(matrix[column]), where + ".matrix");
  if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f) {
    reading.document.warn(where + ".matrix: its last row is taken as 0 0 0 1");
    for (int column = 0; column < 4; ++column) matrix[column].w = column == 3 ? 1.0f : 0.0f;
  }
  if (matrix != glm::mat4(1.0f)) node.matrix = matrix;
}

void readInstances(GltfReading& reading, const Json& instancing, Node& node, const std::string& where) {
  const Json& attributes = instancing["attributes"];
  std::vector<float> parts[3];
  constexpr const char* kNames[3] = {"TRANSLATION", "ROTATION", "SCALE"};
  constexpr std::size_t kComponents[3] = {3, 4, 3};
  std::size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    if (!attributes.contains(kNames[i])) continue;
    const std::string field = where + ".attributes." + kNames[i];
    parts[i] = reading.accessors.floats(attributes[kNames[i]], static_cast<int>(kComponents[i]), field);
    const std::size_t here = parts[i].size() / kComponents[i];
    if (count != 0 && here != count)
      reading.document.fail(field, fmt::format("{} instances, but {} in another attribute", here, count));
    count = here;
  }
  reading.document.budget.charge(count, sizeof(glm::mat4), where);
  node.instances.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Trs trs;
    if (!parts[0].empty()) trs.translation = glm::make_vec3(&parts[0][3 * i]);
    if (!parts[1].empty()) {
      const float* q = &parts[1][4 * i];
      trs.rotation = unitQuaternion(reading, q[0], q[1], q[2], q[3], where + ".attributes.ROTATION");
    }
    if (!parts[2].empty()) trs.scale = glm::make_vec3(&parts[2][3 * i]);
    checkReach(reading, trs.translation, where + ".attributes.TRANSLATION");
    checkReach(reading, trs.scale, where + ".attributes.SCALE");
    node.instances.push_back(composeTrs(trs));
  }
}

void readSkins(GltfReading& reading) {
  const auto& skins = reading.document.model.skins;
  for (std::size_t i = 0; i < skins.size(); ++i) {
    const std::string where = fmt::format("skins[{}]", i);
    Skin skin;
    skin.joints = skins[i].joints;
    if (skin.joints.empty()) reading.document.fail(where + ".joints", "at least one was expected");
    skin.joint_from_mesh.assign(skin.joints.size(), glm::mat4(1.0f));
    if (skins[i].inverseBindMatrices >= 0) {
      const std::string field = where + ".inverseBindMatrices";
      const std::vector<float> matrices = reading.accessors.floats(skins[i].inverseBindMatrices, 16, field);
      if (matrices.size() / 16 < skin.joints.size())
        reading.document.fail(
            field, fmt::format("{} matrices for {} joints", matrices.size() / 16, skin.joints.size()));
      for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        skin.joint_from_mesh[j] = glm::make_mat4(&matrices[16 * j]);
        for (int column = 0; column < 4; ++column) {
          checkReach(reading, glm::vec3(skin.joint_from_mesh[j][column]), field);
          skin.joint_from_mesh[j][column].w = column == 3 ? 1.0f : 0.0f;  // it has to be affine
        }
      }
    }
    reading.scene.skins.push_back(std::move(skin));
  }
}

/// A node's meshes, its skin, and joints that exist.
void hangMeshes(GltfReading& reading, const gloam_tinygltf::Node& source, Node& node,
                const std::string& where) {
  Scene& scene = reading.scene;
  if (source.mesh < 0) return;
  node.meshes = reading.meshes_of[static_cast<std::size_t>(source.mesh)];
  const auto& file_weights =
      source.weights.empty() ? reading.document.model.meshes[static_cast<std::size_t>(source.mesh)].weights
                             : source.weights;
  std::size_t targets = 0;
  bool skinned = false;
  for (const int index : node.meshes) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(index)];
    targets = std::max(targets, mesh.morph_targets.size());
    skinned = skinned || mesh.influences > 0;
    if (source.skin < 0 || mesh.influences == 0) continue;
    const std::size_t joints = scene.skins[static_cast<std::size_t>(source.skin)].joints.size();
    const auto highest = std::max_element(mesh.joints.begin(), mesh.joints.end());
    if (*highest >= joints)
      reading.document.fail(where + ".skin", fmt::format("mesh '{}' uses joint {}, but skins[{}] has {}",
                                                         oneLine(mesh.name), *highest, source.skin, joints));
  }
  for (const int index : node.meshes)
    scene.meshes[static_cast<std::size_t>(index)].morph_targets.resize(targets);
  node.morph_weights.assign(targets, 0.0f);
  for (std::size_t i = 0; i < std::min(targets, file_weights.size()); ++i)
    node.morph_weights[i] = static_cast<float>(file_weights[i]);
  if (source.skin >= 0 && skinned) node.skin = source.skin;
  if (source.skin >= 0 && !skinned && !node.meshes.empty())
    reading.document.warn(where + ".skin: its mesh has no joints; the skin is left out");
}

void linkChildren(GltfReading& reading) {
  auto& nodes = reading.scene.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) {
      Node& other = nodes[static_cast<std::size_t>(child)];
      if (other.parent == static_cast<int>(i))
        reading.document.fail(placeOf(i) + ".children", fmt::format("{} twice", child));
      if (other.parent != kNone)
        reading.document.fail(placeOf(i) + ".children",
                              fmt::format("node {} has the parent {} already", child, other.parent));
      other.parent = static_cast<int>(i);
    }
  // With one parent each, whatever cannot be reached from a node without parent goes round in a circle.
  constexpr int kDeepest = 1000;
  std::vector<int> depth(nodes.size(), 0), open;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent == kNone) open.push_back(static_cast<int>(i)), depth[i] = 1;
  for (std::size_t at = 0; at < open.size(); ++at)
    for (const int child : nodes[static_cast<std::size_t>(open[at])].children) {
      depth[static_cast<std::size_t>(child)] = depth[static_cast<std::size_t>(open[at])] + 1;
      if (depth[static_cast<std::size_t>(child)] > kDeepest)
        reading.document.fail(placeOf(static_cast<std::size_t>(child)),
                              fmt::format("more than {} levels deep", kDeepest));
      open.push_back(child);
    }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (depth[i] == 0) reading.document.fail(placeOf(i) + ".children", "the node is its own ancestor");
}

void chooseRoots(GltfReading& reading) {
  GltfDocument& document = reading.document;
  Scene& scene = reading.scene;
  const auto& scenes = document.model.scenes;
  if (scenes.empty()) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
      if (scene.nodes[i].parent == kNone) scene.roots.push_back(static_cast<int>(i));
    return;
  }
  const std::size_t shown = static_cast<std::size_t>(std::max(document.model.defaultScene, 0));
  if (scenes.size() > 1)
    document.warn(
        fmt::format("of {} scenes the {} is shown", scenes.size(), shown == 0 ? "first" : "default one"));
  for (const int root : scenes[shown].nodes) {
    Node& node = scene.nodes[static_cast<std::size_t>(root)];
    if (std::find(scene.roots.begin(), scene.roots.end(), root) != scene.roots.end()) continue;
    if (node.parent != kNone) {
      document.warn(
          fmt::format("scenes[{}].nodes: node {} is the child of node {}; it is shown where that is", shown,
                      root, node.parent));
      continue;
    }
    scene.roots.push_back(root);
  }
}

/// KHR_node_visibility: hidden nodes lose what they show, with all below them.
void hideNodes(GltfReading& reading) {
  auto& nodes = reading.scene.nodes;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Json* visibility =
        GltfDocument::extension(reading.document.json["nodes"][i], "KHR_node_visibility");
    if (visibility && !visibility->value("visible", true)) open.push_back(i);
  }
  for (std::size_t at = 0; at < open.size() && at < 4 * nodes.size(); ++at) {
    Node& node = nodes[open[at]];
    node.meshes.clear();
    node.volume = nullptr;
    node.light = kNone;
    for (const int child : node.children) open.push_back(static_cast<std::size_t>(child));
  }
}

// Who stands below two grids would be a part of both objects.
void refuseNestedNeighbourhoods(const GltfReading& reading) {
  const std::vector<Node>& nodes = reading.scene.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (int above = nodes[i].neighbourhood ? nodes[i].parent : kNone; above != kNone;
         above = nodes[std::size_t(above)].parent) {
      if (nodes[std::size_t(above)].neighbourhood)
        reading.document.fail(placeOf(i) + ".extensions." + kNeighbourhoodExtension,
                              fmt::format("node {} above it has one already", above));
    }
  }
}

}  // namespace

void readNodes(GltfReading& reading) {
  readSkins(reading);
  const auto& nodes = reading.document.model.nodes;
  reading.scene.nodes.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Json& json = reading.document.json["nodes"][i];
    Node& node = reading.scene.nodes[i];
    node.name = nodes[i].name;
    node.children = nodes[i].children;
    node.camera = nodes[i].camera;
    readTransform(reading, nodes[i], node, placeOf(i));
    hangMeshes(reading, nodes[i], node, placeOf(i));
    if (const Json* light = GltfDocument::extension(json, "KHR_lights_punctual"))
      node.light = reading.light_of[(*light)["light"].get<std::size_t>()];
    if (const Json* instancing = GltfDocument::extension(json, "EXT_mesh_gpu_instancing"))
      readInstances(reading, *instancing, node, placeOf(i) + ".extensions.EXT_mesh_gpu_instancing");
    if (const Json* neighbourhood = GltfDocument::extension(json, kNeighbourhoodExtension))
      node.neighbourhood = readNeighbourhood(reading.accessors, *neighbourhood,
                                             placeOf(i) + ".extensions." + kNeighbourhoodExtension);
    if (const Json* volume = GltfDocument::extension(json, kVolumeExtension))
      node.volume = readVolume(reading.accessors, *volume, placeOf(i) + ".extensions." + kVolumeExtension);
  }
  linkChildren(reading);
  refuseNestedNeighbourhoods(reading);
  chooseRoots(reading);
  hideNodes(reading);
}

}  // namespace gloam
