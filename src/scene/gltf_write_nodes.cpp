// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nodes, cameras, lights (KHR_lights_punctual), instances (EXT_mesh_gpu_instancing), skins and animations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <numbers>

#include "scene/gltf_write_parts.h"
#include "scene/transforms.h"

namespace gloam {
namespace {

using Json = nlohmann::json;
using Target = GlbBuilder::Target;

Json quaternion(const glm::quat& q) {
  return {tidy(q.x), tidy(q.y), tidy(q.z), tidy(q.w)};
}

void writeTrs(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale, Json& json) {
  if (translation != glm::vec3(0.0f)) json["translation"] = tidyArray(translation, 3);
  if (rotation != glm::quat(1, 0, 0, 0)) {
    const bool unit = isUnitLength(double(glm::length(rotation)));
    json["rotation"] = quaternion(unit ? rotation : glm::normalize(rotation));
  }
  if (scale != glm::vec3(1.0f)) json["scale"] = tidyArray(scale, 3);
}

/// False where the node has a matrix that no translation, rotation and scale make, which glTF forbids.
bool writeTransform(const Node& node, Json& json) {
  if (!node.matrix) {
    writeTrs(node.translation, node.rotation, node.scale, json);
    return true;
  }
  if (!decomposeTrs(*node.matrix)) return false;
  json["matrix"] = Json::array();
  for (int i = 0; i < 16; ++i) json["matrix"].push_back(tidy((*node.matrix)[i / 4][i % 4]));
  return true;
}

/// Puts a node between a sheared one and its parent: together they are the matrix. What refers to the node still finds it.
/// Returns the new node's index.
int splitSheared(const Scene& scene, int index, GlbBuilder& builder) {
  const Node& node = scene.nodes[std::size_t(index)];
  const RotatedScale parts = decomposeLinear(glm::mat3(*node.matrix));
  Json& nodes = builder.root["nodes"];
  writeTrs(glm::vec3(0.0f), parts.inner, glm::vec3(1.0f), nodes[std::size_t(index)]);
  Json outer = {{"children", {index}}};
  if (!node.name.empty()) outer["name"] = node.name + " (shear)";
  writeTrs(glm::vec3((*node.matrix)[3]), parts.outer, parts.scale, outer);
  const int outer_index = builder.add("nodes", std::move(outer));
  if (node.parent != kNone) {
    for (Json& child : builder.root["nodes"][std::size_t(node.parent)]["children"]) {
      if (child == index) child = outer_index;
    }
  }
  return outer_index;
}

Json instancing(const Node& node, const std::string& place, GlbBuilder& builder) {
  std::vector<float> translations, rotations, scales;
  for (std::size_t i = 0; i < node.instances.size(); ++i) {
    const std::optional<Trs> trs = decomposeTrs(node.instances[i]);
    if (!trs) throw Error(place, fmt::format("node '{}': instance {} is sheared or flattened", node.name, i));
    for (int c = 0; c < 3; ++c) translations.push_back(trs->translation[c]);
    rotations.insert(rotations.end(), {trs->rotation.x, trs->rotation.y, trs->rotation.z, trs->rotation.w});
    for (int c = 0; c < 3; ++c) scales.push_back(trs->scale[c]);
  }
  builder.use("EXT_mesh_gpu_instancing");
  return {{"attributes",
           {{"TRANSLATION", builder.addFloats(translations, 3, Target::kNone)},
            {"ROTATION", builder.addFloats(rotations, 4, Target::kNone)},
            {"SCALE", builder.addFloats(scales, 3, Target::kNone)}}}};
}

bool morphs(const Scene& scene, const Node& node) {
  return std::any_of(node.meshes.begin(), node.meshes.end(),
                     [&](int mesh) { return !scene.meshes[std::size_t(mesh)].morph_targets.empty(); });
}

const char* pathName(AnimationChannel::Path path) {
  constexpr const char* kNames[] = {"translation", "rotation", "scale", "weights"};
  return kNames[std::size_t(path)];
}

const char* interpolationName(AnimationChannel::Interpolation interpolation) {
  constexpr const char* kNames[] = {"STEP", "LINEAR", "CUBICSPLINE"};
  return kNames[std::size_t(interpolation)];
}

}  // namespace

void writeCameras(const Scene& scene, GlbBuilder& builder) {
  for (const Camera& camera : scene.cameras) {
    Json lens = {{"znear", tidy(camera.z_near)}};
    const bool bounded = std::isfinite(camera.z_far);
    if (camera.perspective) {
      lens["yfov"] = tidy(camera.vertical_fov_rad);
      if (camera.aspect > 0.0f) lens["aspectRatio"] = tidy(camera.aspect);
      if (bounded) lens["zfar"] = tidy(camera.z_far);
    } else {
      lens["ymag"] = tidy(camera.half_height);
      lens["xmag"] = tidy(camera.half_height * (camera.aspect > 0.0f ? camera.aspect : 1.0f));
      lens["zfar"] = tidy(bounded ? camera.z_far : 1e6f + camera.z_near);
    }
    const char* type = camera.perspective ? "perspective" : "orthographic";
    Json json = {{"type", type}, {type, std::move(lens)}};
    if (!camera.name.empty()) json["name"] = camera.name;
    builder.add("cameras", std::move(json));
  }
}

void writeLights(const Scene& scene, GlbBuilder& builder) {
  if (scene.lights.empty()) return;
  Json lights = Json::array();
  for (const Light& light : scene.lights) {
    const float intensity =
        powerOfTwoFrom(std::max({light.intensity.x, light.intensity.y, light.intensity.z}));
    const glm::vec3 color = intensity > 0.0f ? light.intensity / intensity : glm::vec3(1.0f);
    const char* type = light.type == Light::Type::kDirectional ? "directional"
                       : light.type == Light::Type::kSpot      ? "spot"
                                                               : "point";
    Json json = {
        {"type", type}, {"intensity", tidy(std::max(0.0f, intensity))}, {"color", tidyArray(color, 3)}};
    if (!light.name.empty()) json["name"] = light.name;
    if (light.range > 0.0f && light.type != Light::Type::kDirectional) json["range"] = tidy(light.range);
    if (light.type == Light::Type::kSpot) {
      const double outer = std::min(tidy(light.outer_cone_rad), std::numbers::pi / 2.0);
      json["spot"] = {{"outerConeAngle", outer},
                      {"innerConeAngle", std::min(tidy(light.inner_cone_rad), 0.9999 * outer)}};
    }
    lights.push_back(std::move(json));
  }
  builder.root["extensions"]["KHR_lights_punctual"] = {{"lights", std::move(lights)}};
  builder.use("KHR_lights_punctual");
}

std::vector<int> writeNodes(const Scene& scene, const MeshGroups& groups, const std::string& place,
                            GlbBuilder& builder) {
  std::vector<int> sheared;
  for (int index = 0; index < int(scene.nodes.size()); ++index) {
    const Node& node = scene.nodes[std::size_t(index)];
    Json json = Json::object();
    if (!node.name.empty()) json["name"] = node.name;
    if (!node.children.empty()) json["children"] = node.children;
    if (!writeTransform(node, json)) sheared.push_back(index);
    if (!node.meshes.empty()) {
      json["mesh"] = groups.of(node.meshes);
      if (node.skin != kNone) json["skin"] = node.skin;
      if (morphs(scene, node) && !node.morph_weights.empty()) {
        json["weights"] = tidyArray(node.morph_weights, int(node.morph_weights.size()));
      }
      if (!node.instances.empty()) {
        json["extensions"]["EXT_mesh_gpu_instancing"] = instancing(node, place, builder);
      }
    }
    if (node.camera != kNone) json["camera"] = node.camera;
    if (node.light != kNone) json["extensions"]["KHR_lights_punctual"] = {{"light", node.light}};
    builder.add("nodes", std::move(json));
  }
  std::vector<int> roots = scene.roots;
  for (const int index : sheared) {
    const int outer = splitSheared(scene, index, builder);
    std::replace(roots.begin(), roots.end(), index, outer);
  }
  return roots;
}

void writeSkins(const Scene& scene, GlbBuilder& builder) {
  for (const Skin& skin : scene.skins) {
    const std::span<const float> matrices(glm::value_ptr(skin.joint_from_mesh.front()),
                                          skin.joint_from_mesh.size() * 16);
    builder.add("skins", {{"joints", skin.joints},
                          {"inverseBindMatrices", builder.addFloats(matrices, 16, Target::kNone)}});
  }
}

void writeAnimations(const Scene& scene, GlbBuilder& builder) {
  std::map<std::vector<float>, int> times;  // channels share their keys
  for (const Animation& animation : scene.animations) {
    if (animation.channels.empty()) continue;
    Json samplers = Json::array(), channels = Json::array();
    for (const AnimationChannel& channel : animation.channels) {
      const auto [known, added] = times.try_emplace(channel.times_s, 0);
      if (added) known->second = builder.addFloats(channel.times_s, 1, Target::kNone, true);
      const bool weights = channel.path == AnimationChannel::Path::kWeights;
      samplers.push_back(
          {{"input", known->second},
           {"output", builder.addFloats(channel.values, weights ? 1 : channel.components, Target::kNone)},
           {"interpolation", interpolationName(channel.interpolation)}});
      channels.push_back({{"sampler", samplers.size() - 1},
                          {"target", {{"node", channel.node}, {"path", pathName(channel.path)}}}});
    }
    Json json = {{"samplers", std::move(samplers)}, {"channels", std::move(channels)}};
    if (!animation.name.empty()) json["name"] = animation.name;
    builder.add("animations", std::move(json));
  }
}

}  // namespace gloam
